"""Agents of whom it is not known at first where they start: what that means, who wins, and what missions do."""

from __future__ import annotations

from itertools import product
from typing import Dict, List, Tuple

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Severity
from pursue_gen.explanation.changes import findings
from pursue_gen.language import check, parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import DEFAULT, Rules, played
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.vocabulary.words import words_of
from pursue_gen.workspace import Options
from tests.plays import Play
from tests.tga.networks import scenario
from tests.tga.test_breaking_off import solved
from tests.tga.test_unknown_states import won
from tests.whole_stories import stories

HALL = """
poi "hall"
poi "desk"
poi "store"
connect hall and desk distance 3
connect hall and store distance 4
event "fetch" location store duration 3
event "call"
agent "bot" controllable mobile 1 location hall can_do fetch
agent "gerda" mobile 2 location desk or store can_do call
assume: gerda stays 10 to 90 at each place
objective: if gerda at desk then bot at desk within 16
objective: avoid bot at store and gerda at store
reach_objective: do fetch
"""
PLACES = ("desk", "store")


def at(place: str, text: str = HALL) -> str:
    """The scenario in which it is known that she starts there."""
    return text.replace("desk or store", place)


def test_it_is_won_wherever_she_starts() -> None:
    assert solved(HALL) is not None
    hasty = HALL.replace("within 16", "within 5")
    assert solved(at("store", hasty)) is not None
    assert solved(at("desk", hasty)) is None and solved(hasty) is None


@given(stories(small=True))
@settings(max_examples=12)
def test_what_is_won_is_won_wherever_somebody_starts(drawn: Tuple[str, Scenario]) -> None:
    text, story = drawn
    (guest,) = (agent for agent in story.agents if agent.name == "guest")
    assume(guest.is_somewhere)
    for ref in guest.starts:
        known = parse(text.replace(f"location {guest.starts_text}", f"location {ref.name}"), "story.pur", "story")
        assume(all(finding.severity is not Severity.ERROR for finding in check(known)))
        if not won(known):
            assert not won(story), text


def test_it_is_said_at_the_start_by_nobody_who_is_controlled() -> None:
    network = played(translate(scenario(HALL)), DEFAULT)
    gerda = network.automaton("gerda")
    says = [edge for edge in gerda.edges if edge.source == gerda.initial]
    assert sorted(edge.target for edge in says) == sorted(PLACES)
    assert not any(edge.controllable for edge in says) and gerda.longest[gerda.initial] == 0.5
    assert dict(network.variables)["Pgerda"] == 0
    words = words_of(scenario(HALL), network)
    assert words.sentence("gerda", says[0]) == f"gerda starts at {says[0].target}"


@pytest.mark.parametrize("place", PLACES)
def test_a_condition_comes_to_hold_when_it_is_said(place: str) -> None:
    story = Play(scenario(HALL))
    assert story.position.locations["obj"] == "idle"
    assert story.take("gerda", f"gerda_starts_at_{place}", 0.25)
    assert story.position.locations["obj"] == ("atRisk" if place == "desk" else "idle")


def test_what_holds_wherever_she_starts_is_due_from_the_start() -> None:
    text = HALL.replace("if gerda at desk then", "if not gerda at hall then")
    obj = translate(scenario(text)).automaton("obj")
    assert obj.initial == "atRisk"


_ATOMS = ("gerda at hall", "gerda at desk", "gerda at store", "gerda on_way", "bot at hall", "ben at desk")
_CONDITIONS = st.recursive(
    st.sampled_from(_ATOMS),
    lambda part: st.one_of(
        part.map(lambda one: f"not ({one})"), *(st.tuples(part, part).map(f" {word} ".join) for word in ("and", "or"))
    ).map(lambda text: f"({text})"),
    max_leaves=4,
)


@given(_CONDITIONS, st.sampled_from(("desk or store", "hall or desk")), st.sampled_from(("desk", "hall or desk")))
@settings(max_examples=25)
def test_once_it_is_said_all_is_as_if_it_had_been_known(condition: str, hers: str, his: str) -> None:
    """What is due, and what is broken, when both have been placed, in either order."""
    text = HALL.replace("desk or store", hers).replace("gerda at desk then bot at desk", f"{condition} then fetch")
    text = text.replace("reach_", f'agent "ben" mobile 2 location {his}\nreach_', 1)
    text = text.replace("objective: avoid bot at store and gerda at store", f"objective: avoid not ({condition})", 1)
    for order in (("gerda", "ben"), ("ben", "gerda")):
        for places in product(hers.split(" or "), his.split(" or ")):
            where = dict(zip(("gerda", "ben"), places))
            assert _after(text, order, where, {"gerda": hers, "ben": his}) == _known(text, where, hers, his)


def _story(text: str) -> Play:
    try:
        story = parse(text, "x.pur", "x")
        assume(all(f.severity is not Severity.ERROR or f.code in ("PML234", "PML252") for f in check(story)))
    except PursueError:
        assume(False)
    return Play(story)


def _what_is_so(story: Play) -> Tuple[str, bool]:
    """Where the answer is due, and whether the other objective can be lost now."""
    lost = [edge for edge in story.model.automaton("obj2").edges if edge.target == "lose"]
    return story.position.locations["obj"], any(edge.allowed(story.position.values) for edge in lost)


def _after(text: str, order: Tuple[str, ...], where: Dict[str, str], starts: Dict[str, str]) -> Tuple[str, bool]:
    story = _story(text)
    for name in order:
        if " or " in starts[name]:
            assert story.take(name, f"{name}_starts_at_{where[name]}", 0.125)
    return _what_is_so(story)


def _known(text: str, where: Dict[str, str], hers: str, his: str) -> Tuple[str, bool]:
    text = text.replace(f"mobile 2 location {hers} can_do", f"mobile 2 location {where['gerda']} can_do")
    text = text.replace(f'"ben" mobile 2 location {his}', f'"ben" mobile 2 location {where["ben"]}')
    return _what_is_so(_story(text))


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (("desk or store", "desk or desk"), "PML441", "gerda starts at desk or desk"),
        (("mobile 1 location hall", "mobile 1 location hall or desk"), "PML441", "bot is controlled"),
        (("objective: avoid", "objective: patrol desk every 900 by gerda\nobjective: avoid"), "PML441", "on patrol"),
        (("location desk or store", "location hall or store"), "PML174", "both start in hall"),
        (('poi "store"', 'poi "store" except gerda'), "PML149", "gerda starts in store"),
        (("gerda stays 10 to 90 at each place", "gerda never at store"), "PML252", "may start in store"),
        (("desk or store", "desk or nowhere"), "PML110", "nowhere"),
    ],
)
def test_what_cannot_be_meant(change: Tuple[str, str], code: str, said: str) -> None:
    text = HALL.replace("objective: avoid bot at store and gerda at store", "objective: bot never_with gerda at hall")
    text = text.replace(*change) if change[0] in text else HALL.replace(*change)
    found: List[str] = [each.message for each in check(parse(text, "x.pur", "x")) if each.code == code]
    assert any(said in message for message in found), found


def test_a_lost_one_says_where_she_might_start() -> None:
    lost = scenario(HALL.replace("within 16", "within 5"))
    changes = findings(lost, Rules(), Budget(Limits(states=20_000))).changes
    assert "gerda starting at store (location store)" in [change.sentence for change in changes]


def test_missions_begin_with_any_of_them() -> None:
    found = solved(HALL)
    assert found is not None
    stage, begun = stage_of(scenario(HALL), found, Options(reaction=found.reaction)), set()
    for seed in range(1, 9):
        mission = SimulatedMission(stage, Settings("random", until=400.0), seed, None)
        outcome = mission.run()
        assert (outcome.end, outcome.problems) == (GOAL, ())
        begun.update(state.event for state in mission.recorder.states if "_starts_at_" in state.event)
    assert begun == {f"gerda_starts_at_{place}" for place in PLACES}


def test_uppaal_reads_it_back() -> None:
    story = scenario(HALL)
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


def test_it_may_be_any_of_a_group() -> None:
    text = HALL.replace("event", 'group "rooms": desk, store\nevent', 1).replace("desk or store", "any of rooms")
    (gerda,) = (agent for agent in parse(text, "x.pur", "x").agents if agent.name == "gerda")
    assert [ref.name for ref in gerda.starts] == ["desk", "store"]
