"""Objectives: automata that watch, and the objective that goes with them."""

from __future__ import annotations

from itertools import product
from typing import Mapping

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import ClockBound, Edge, Guard, Location, Sync
from tests.tga.networks import BOTH, REACH, SAFETY, scenario

BASE = """
poi "a"
poi "b"
poi "c"
connect b and a distance 2
connect b and c distance 1
event "call"
event "cook" duration 3
agent "chef" controllable mobile 1 location a can_do cook
agent "guest" mobile 1 location c can_do call
"""


def test_reach_waits_for_the_time_then_for_the_end_of_the_event() -> None:
    text = BASE + "reach_objective: do cook after 7"
    automaton = translate(scenario(text)).automaton("reachObj")
    assert automaton.locations == (Location("initial_location"), Location("unlocked", named=False), Location("win"))
    assert automaton.edges == (
        Edge("initial_location", "unlocked", Guard((ClockBound("Creach", ">", 7),))),
        Edge("unlocked", "win", sync=Sync("cookDONE", False)),
    )
    assert scenario_objective(scenario(text)) == REACH


def test_what_counts_from_the_same_time_is_unlocked_in_one_step() -> None:
    goals = ("do cook", "do call after 7", "do cook and call", "do cook after 7 within 30", "do cook after 8")
    network = translate(scenario(BASE + "\n".join(f"reach_objective: {goal}" for goal in goals)))
    first = [network.automaton(f"reachObj{number}").edges[0] for number in ("", 2, 3, 4, 5)]
    one, other = (f"{name}_going_initial_location2unlocked" for name in ("reachObj", "reachObj2"))
    sends, hears = [Sync(one, True), Sync(other, True)], [Sync(one, False), Sync(other, False)]
    assert [edge.sync for edge in first] == [*sends, *hears, None]
    after = [bound.bound for edge in first for bound in edge.guard.clocks]
    assert after == [0, 7, 8]
    assert network.channels[-2:] == (one, other)


def test_respond_gives_a_deadline() -> None:
    text = BASE + "objective: if call then cook within 9"
    automaton = translate(scenario(text)).automaton("obj")
    assert automaton.locations[2] == Location("atRisk", (ClockBound("Cobj", "<=", 9),))
    assert automaton.edges == (
        Edge("idle", "atRisk", sync=Sync("call", False), resets=("Cobj",)),
        Edge("atRisk", "idle", sync=Sync("cookDONE", False)),
        Edge("atRisk", "lose"),
    )
    assert scenario_objective(scenario(text)) == SAFETY


@pytest.mark.parametrize(("event", "channel"), [("call", "call"), ("cook", "cookDONE")])
def test_avoid_loses_when_the_event_has_happened(event: str, channel: str) -> None:
    automaton = translate(scenario(BASE + f"objective: avoid {event}")).automaton("obj")
    assert automaton.edges == (Edge("idle", "lose", sync=Sync(channel, False)),)


def test_both_objectives_make_reach_while_safe() -> None:
    assert scenario_objective(scenario(BASE + "objective: avoid call\nreach_objective: do cook")) == BOTH


def test_no_objective_is_an_error() -> None:
    with pytest.raises(PursueError) as raised:
        scenario_objective(scenario(BASE))
    assert [d.code for d in raised.value.diagnostics] == ["TGA012"]


def holds(guard: Guard, values: Mapping[str, int]) -> bool:
    return all(any(values[test.variable] == test.value for test in clause) for clause in guard.integers)


def test_never_with_loses_exactly_where_both_share_a_poi_or_a_connection() -> None:
    automaton = translate(scenario(BASE + "objective: chef never_with guest")).automaton("obj")
    places = {1: "a", -11: "a", 2: "b", -22: "b", 3: "c", -33: "c", -12: "ab", -21: "ab", -23: "bc", -32: "bc"}
    for (chef, here), (guest, there) in product(places.items(), repeat=2):
        values = {"Pchef": chef, "Pguest": guest}
        assert any(holds(edge.guard, values) for edge in automaton.edges) == (here == there)
    for edge in automaton.edges:
        assert (edge.source, edge.target, edge.sync, edge.controllable) == ("idle", "lose", None, False)
        assert not edge.guard.clocks
