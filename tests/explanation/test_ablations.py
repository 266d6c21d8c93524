"""Scenarios without one of their parts, and without all that only this part needs."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Set

import pytest

from pursue_gen.diagnostics import Severity
from pursue_gen.explanation.ablations import without_agent, without_each
from pursue_gen.language import load, parse
from pursue_gen.language.checks import check
from pursue_gen.language.scenario import Choice, Ref, RuleBody, Scenario
from pursue_gen.solving.periods import with_period
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.tga import scenario_objective, translate

SCENARIOS = sorted((Path(__file__).parents[2] / "scenarios").glob("*/*.pur"))

MUSEUM = """
poi "door"
poi "hall"
connect door and hall distance 2
event "greet" collaborative
event "mop" location hall
event "ring"
event "serve" location hall
rule "day": (greet before mop) before (ring or serve)
rule "mopping": ring or mop
state "wet": initially false, true_if mop
state "loud": initially false, true_if ring, mop false_if serve
stateDependency: serve only_if wet is_true
stateDependency: ring only_if loud is_false
agent "bot1" controllable mobile 1 location door can_do serve, greet
agent "bot2" controllable mobile 1 location door can_do mop
agent "guest" mobile 1 location hall can_do ring reacts_to greet
agent "child" mobile 1 location hall reacts_to greet
objective: avoid ring
reach_objective: do serve after 5
"""


def museum() -> Scenario:
    return parse(MUSEUM, "museum.pur")


def in_text(body: RuleBody) -> str:
    if isinstance(body, Ref):
        return body.name
    word = "or" if isinstance(body, Choice) else "before"
    return f"({in_text(body.first)} {word} {in_text(body.second)})"


def without(name: str, scenario: Scenario) -> Scenario:
    found = without_agent(scenario, name)
    assert found is not None
    return found


def test_with_an_agent_go_the_events_that_only_it_can_do() -> None:
    lesser = without("bot2", museum())
    assert [agent.name for agent in lesser.agents] == ["bot1", "guest", "child"]
    assert [event.name for event in lesser.events] == ["greet", "ring", "serve"]
    assert {rule.name: in_text(rule.body) for rule in lesser.rules} == {"day": "(greet before (ring or serve))"}
    assert [state.name for state in lesser.states] == ["loud"]
    assert [(need.event.name, need.state.name) for need in lesser.dependencies] == [("ring", "loud")]


def test_an_event_that_needs_two_agents_goes_with_the_last_that_reacts() -> None:
    assert "greet" in {event.name for event in without("child", museum()).events}
    lonely = parse(MUSEUM.replace("avoid ring", "avoid mop").replace("ring, mop", "mop"), "museum.pur")
    nobody = without("child", without("guest", lonely))
    assert {event.name for event in nobody.events} == {"mop", "serve"}
    assert {rule.name: in_text(rule.body) for rule in nobody.rules} == {"day": "(mop before serve)"}
    assert all(ref.name != "greet" for agent in nobody.agents for ref in (*agent.can_do, *agent.reacts_to))


def test_what_an_objective_names_stays() -> None:
    assert without_agent(museum(), "guest") is None  # only the guest can ring
    assert without_agent(museum(), "bot1") is None  # only bot1 can serve
    apart = parse(MUSEUM.replace("avoid ring", "bot2 never_with child"), "museum.pur")
    assert without_agent(apart, "child") is None and without_agent(apart, "bot2") is None


def test_somebody_to_command_stays() -> None:
    alone = without("bot2", museum())
    goal = parse(MUSEUM.replace("can_do ring", "can_do ring, serve"), "museum.pur")
    assert without_agent(alone, "bot1") is None
    assert without_agent(without("bot2", goal), "bot1") is None


def test_every_part_is_named_once() -> None:
    names = [part.name for part, _ in without_each(museum())]
    assert names == [
        "bot2",
        "child",
        "rule day",
        "rule mopping",
        "stateDependency serve only_if wet is_true",
        "stateDependency ring only_if loud is_false",
        "objective avoid ring",
        "reach_objective do serve after 5",
    ]


def test_what_conditions_name_stays_and_they_can_be_left_out() -> None:
    text = MUSEUM.replace('"serve" location hall', '"serve" location hall only_if not child at hall and loud is_false')
    names = {part.name: lesser for part, lesser in without_each(parse(text, "museum.pur"))}
    assert "child" not in names, "the condition names it"
    free = names["only_if not child at hall and loud is_false on serve"]
    assert [event.only_if for event in free.events] == [None] * 4


def test_one_of_two_objectives_stays() -> None:
    parts = {part.name: (part, lesser) for part, lesser in without_each(museum())}
    safety, lesser = parts["objective avoid ring"]
    assert not lesser.safety and len(lesser.reach) == 1
    reach, other = parts["reach_objective do serve after 5"]
    assert not other.reach and len(other.safety) == 1
    assert reach.left_out(lesser) is None and safety.left_out(other) is None


@pytest.mark.parametrize("file", SCENARIOS, ids=lambda file: file.stem)
def test_each_lesser_scenario_is_a_game(file: Path) -> None:
    for part, lesser in without_each(with_period(load(file), 30)):
        compile_game(translate(lesser), scenario_objective(lesser))
        errors = [finding.message for finding in check(lesser) if finding.severity is Severity.ERROR]
        assert errors == [], part.name
        assert undeclared(lesser) == set(), part.name


def undeclared(scenario: Scenario) -> Set[str]:
    """Events and states that are used and not declared."""
    known: Dict[str, Set[str]] = {
        "events": {event.name for event in scenario.events},
        "states": {state.name for state in scenario.states},
    }
    used = {ref.name for agent in scenario.agents for ref in (*agent.can_do, *agent.reacts_to)}
    used |= {ref.name for state in scenario.states for ref in (*state.true_if, *state.false_if)}
    used |= {need.event.name for need in scenario.dependencies}
    states = {need.state.name for need in scenario.dependencies}
    for rule in scenario.rules:
        used |= set(in_text(rule.body).replace("(", " ").replace(")", " ").split()) - {"or", "before"}
    return (used - known["events"]) | (states - known["states"])
