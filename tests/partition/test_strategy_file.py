"""Strategy files: any YAML reader finds the states, commands and zones in them, word for word."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from typing import List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.families import deliver_by_robots
from pursue_gen.language import parse
from pursue_gen.partition import SubStrategy, partition
from pursue_gen.partition.strategy_data import cover_data, render, render_cover, strategy_data, zone_text
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.plan_text import read_constraint
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy, Zone
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Edge, Sync
from tests.partition.games import AGENTS, QUICK, game, random_strategies, zones
from tests.runtime.texts import read
from tests.two_stages import LOADED, solved_in_stages

TENTH = Fraction(1, 10)

STATE = DiscreteState(
    (("bot1", "c"), ("bot2", "c"), ("rule1", "rule1_initial_location"), ("reachObj", "unlocked")),
    (("Prule1", 0), ("Pbot1", 3), ("Pbot2", 3)),
)
ZONE = (
    Constraint(None, "Cbot1", Fraction(-1), True),
    Constraint("Cbot1", None, Fraction(5), False),
    Constraint("Cbot1", "Cbot2", Fraction(3), False),
)
MOVE = Move("bot1", Edge("c", "going_c_to_b", sync=Sync("bot1_c2b", True)))

FILE = """\
# Strategy of controller_bot1 in scenario_1, written by pursue-gen 0.1.0.
# In a state below, the command is due as soon as one of its zones (clocks in time units) holds.
format: 1
controller: controller_bot1
commands_agents: [bot1]
reaction: 0.1
strategy:
- state: {bot1: c, bot2: c, rule1: rule1_initial_location, reachObj: unlocked}
  commands:
  - do: bot1_c2b
    agent: bot1
    from: c
    to: going_c_to_b
    when:
    - 1 < Cbot1 && Cbot1 <= 5 && Cbot1 - Cbot2 <= 3
"""


def read_zone(text: str) -> Zone:
    """The zone in a text of the file."""
    if text == "always":
        return ()
    zone: Zone = ()
    for part in text.split(" && "):
        constraints = read_constraint(part.replace(" ", ""))
        assert constraints
        zone += constraints
    return zone


def visible(state: DiscreteState) -> "dict[str, str]":
    """What a file says of a state."""
    names = {f"P{name}" for name, _ in state.locations}
    values = {name: str(value) for name, value in state.values if name not in names}
    return {**dict(state.locations), **values}


def as_text(state: "dict[str, object]") -> "dict[str, str]":
    """A state as the nodes compare it."""
    return {name: str(value) for name, value in state.items()}


def once(zones: Tuple[Zone, ...]) -> List[Zone]:
    """The zones, each once."""
    return list(dict.fromkeys(zones))


def test_the_file_is_for_people() -> None:
    sub = SubStrategy("controller_bot1", ("bot1",), ((STATE, (Command((ZONE,), (MOVE,)),)),))
    assert render(sub, "scenario_1", "0.1.0", TENTH) == FILE


@QUICK
@given(random_strategies(), st.sampled_from(("distributed", "centralized", "general")))
def test_everything_is_found_again(strategy: Strategy, shape: str) -> None:
    for sub in partition(strategy, game(), AGENTS, shape):
        data = read(render(sub, "game", "0.1.0", TENTH))
        assert (data["format"], data["controller"], data["reaction"]) == (1, sub.controller, 0.1)
        assert data["commands_agents"] == list(sub.agents)
        assert len(data["strategy"]) == len(sub.blocks)
        for entry, (state, commands) in zip(data["strategy"], sub.blocks):
            assert as_text(entry["state"]) == visible(state)
            assert len(entry["commands"]) == len(commands)
            for found, command in zip(entry["commands"], commands):
                first = command.moves[0]
                assert (found["agent"], found["from"], found["to"]) == (
                    first.automaton,
                    first.edge.source,
                    first.edge.target,
                )
                assert found["do"] == event_word(first.automaton, first.edge)
                assert [read_zone(text) for text in found["when"]] == once(command.zones)


@QUICK
@given(random_strategies(), st.sampled_from((Fraction(0), TENTH, Fraction(1, 3), Fraction(1, 1000))))
def test_files_hold_the_very_data_that_is_sent_when_plans_change(strategy: Strategy, reaction: Fraction) -> None:
    for sub in partition(strategy, game(), AGENTS):
        data = strategy_data(sub, reaction)
        assert read(render(sub, "game", "0.1.0", reaction)) == data == json.loads(json.dumps(data))
    cover = cover_data(strategy)
    assert read(render_cover(strategy, "game", "0.1.0")) == cover == json.loads(json.dumps(cover))


@QUICK
@given(random_strategies())
def test_the_cover_has_every_zone_of_every_state(strategy: Strategy) -> None:
    data = read(render_cover(strategy, "game", "0.1.0"))
    assert data["format"] == 3
    assert len(data["cover"]) == len(strategy.blocks)
    for entry, block in zip(data["cover"], strategy.blocks):
        assert as_text(entry["state"]) == visible(block.state)
        assert [read_zone(text) for text in entry.get("wait", ())] == once(block.wait)
        sub = SubStrategy("all", (), ((block.state, block.commands),))
        assert entry.get("commands", []) == strategy_data(sub, TENTH)["strategy"][0]["commands"]


def test_nothing_to_do_is_an_empty_list() -> None:
    assert read(render(SubStrategy("controller_bot3", ("bot3",), ()), "s", "1", TENTH))["strategy"] == []
    assert read(render_cover(Strategy(()), "s", "1"))["cover"] == []
    silent = read(render_cover(Strategy((Block(STATE, (), ()),)), "s", "1"))
    assert silent["cover"] == [{"state": silent["cover"][0]["state"]}]


@pytest.mark.parametrize("name", ["on", "y", "No", "null", "true", "12", "1e3", "0x1", "12:30", "_", "a-b", "a: b"])
def test_names_that_yaml_would_misread(name: str) -> None:
    edge = replace(MOVE.edge, source=name)
    state = replace(STATE, locations=((name, name), *STATE.locations[1:]))
    sub = SubStrategy(name, (name,), ((state, (Command(((),), (Move(name, edge),)),)),))
    data = read(render(sub, "s", "1", TENTH))
    assert data["controller"] == name
    assert data["commands_agents"] == [name]
    (entry,) = data["strategy"]
    assert entry["state"][name] == name
    assert entry["commands"][0]["from"] == name


def test_values_that_no_location_tells_are_in_the_state() -> None:
    state = replace(STATE, values=(*STATE.values, ("Sopen", 1)))
    sub = SubStrategy("controller_bot1", ("bot1",), ((state, (Command(((),), (MOVE,)),)),))
    (entry,) = read(render(sub, "s", "1", TENTH))["strategy"]
    assert entry["state"]["Sopen"] == 1
    assert not any(name.startswith("P") for name in entry["state"])
    assert entry["commands"][0]["when"] == ["always"]


@pytest.mark.parametrize(
    ("zone", "text"),
    [
        ((), "always"),
        ((Constraint("C", None, Fraction(4, 3), True),), "C < 4/3"),
        ((Constraint(None, "C", Fraction(-11, 10), False),), "1.1 <= C"),
        ((Constraint("C", "D", Fraction(-2), True),), "C - D < -2"),
        ((Constraint("C", "D", Fraction(0), False),), "C <= D"),
        ((Constraint("C", None, Fraction(3), False), Constraint(None, "C", Fraction(-3), False)), "C == 3"),
        ((Constraint("C", "D", Fraction(0), False), Constraint("D", "C", Fraction(0), False)), "C == D"),
    ],
)
def test_zones_read_like_arithmetic(zone: Zone, text: str) -> None:
    assert zone_text(zone) == text


@QUICK
@given(zones(("Ca", "Cb", "Cc")))
def test_zones_keep_their_meaning(zone: Zone) -> None:
    assert read_zone(zone_text(zone)) == zone


@pytest.mark.parametrize(
    ("automaton", "edge", "word"),
    [
        ("bot1", Edge("a", "going_a_to_c", sync=Sync("bot1_a2c", True)), "bot1_a2c"),
        ("bot1", Edge("going_a_to_c", "c"), "bot1_going_a_to_c2c"),
        ("bot1", Edge("doing_e_in_a", "a", sync=Sync("eDONE", True)), "eDONE"),
        ("reachObj", Edge("initial_location", "unlocked"), "reachObj_going_initial_location2unlocked"),
    ],
)
def test_words_of_events(automaton: str, edge: Edge, word: str) -> None:
    assert event_word(automaton, edge) == word


def test_blocks_of_each_stage_name_what_matters_in_it() -> None:
    scenario, won = solved_in_stages()
    subs = {sub.controller: sub for sub in partition(won.strategy, won.network, scenario.agents)}
    robot = [entry["state"] for entry in strategy_data(subs["controller_bot"], won.reaction)["strategy"]]
    every = [entry["state"] for entry in cover_data(won.strategy)["cover"]]
    for states in (robot, every):
        assert {tuple(state) for state in states} == {
            ("bot", "reachObj", "order"), ("bot", "visitor", "reachObj", "order")
        }  # fmt: skip
        assert all(("visitor" in state) is (state["order"] == LOADED) for state in states)


def test_the_position_of_an_agent_that_is_not_named_itself_stays_in_the_state() -> None:
    block = Block(DiscreteState((("bot", "hub"),), (("Pbot", 2), ("Pvisitor", 3))), ((),), ())
    assert cover_data(Strategy((block,)))["cover"][0]["state"] == {"bot": "hub", "Pvisitor": 3}


@pytest.mark.parametrize("robots", [1, 3])
def test_files_of_a_strategy_in_stages_say_what_a_state_does_not_name(robots: int) -> None:
    scenario = parse(deliver_by_robots(robots), "delivery.pur", "delivery")
    won = solve_scenario(scenario, Rules())
    sub, *_ = partition(won.strategy, won.network, scenario.agents)
    for text in (render(sub, "delivery", "0.1.0", won.reaction), render_cover(won.strategy, "delivery", "0.1.0")):
        comments = [line for line in text.splitlines() if line.startswith("#")]
        assert any("Whoever a state does not name may be anywhere" in line for line in comments) is (robots == 3)
        assert any("one after the other" in line for line in comments) is (robots == 3 and "cover:" in text)
