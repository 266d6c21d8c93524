"""A plan for while somebody is late whom the goal needs: it relies on it for a time, and others do what they can."""

from __future__ import annotations

from typing import Any, Dict, List, Tuple

import pytest

from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import translate
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from
from tests.tools.replanning.plays import game_of

MEET = """
poi "hall"
poi "store"
poi "west"
connect hall and store distance 4
connect hall and west distance 4
event "inspect" location west duration 4
event "load" collaborative location hall duration 3
agent "bot1" controllable mobile 2 location store can_do load
agent "bot2" controllable mobile 2 location hall can_do inspect reacts_to load
reach_objective: do inspect and load{}
"""
"""bot1 comes to the hall within 9 time units; bot2 inspects, and is at the hall when they load."""

Request = Dict[str, Any]


def meet(rest: str) -> Scenario:
    scenario = read(MEET.format(rest), "meet.pur", "meet").scenario
    assert scenario is not None
    return scenario


def late(rest: str = "", clock: float = 12.0, **changed: Any) -> Request:
    """A request while bot1 is late on its way to the hall, and bot2 stands there; nothing was done."""
    scenario = meet(rest)
    network = played(translate(scenario), Rules())
    (edge,) = (edge for edge in network.automaton("bot1").edges if edge.target == "going_store_to_hall")
    return {
        "format": 1, "game": game_of(scenario), "values": {**dict(network.variables), **dict(edge.assign)},
        "locations": {**{a.name: a.initial for a in network.automata}, "bot1": "going_store_to_hall"},
        "clocks": dict.fromkeys(network.clocks, clock), "ahead": 1.0, "excused": [], "limit": 1200.0, **changed,
    }  # fmt: skip


def commands(answer: Request) -> List[Tuple[Dict[str, Any], str, str]]:
    """The states of the commands, the agents and what they do."""
    assert answer["won"], answer
    blocks = [entry for data in answer["strategies"].values() for entry in data["strategy"]]
    return [(block["state"], each["agent"], each["do"]) for block in blocks for each in block["commands"]]


def test_without_who_is_late_there_is_no_plan() -> None:
    for request in (late(excused=["bot1"]), late()):
        assert replan(request)["why"].endswith("cannot be guaranteed from here without relying on {bot1}")


@pytest.mark.parametrize("left", [20.0, 50.5, 170.0])
def test_what_can_be_done_before_it_comes_is_done_before(left: float) -> None:
    answer = replan(late(awaited={"bot1": left}))
    meanwhile = [(who, what) for state, who, what in commands(answer) if state.get("bot1") == "going_store_to_hall"]
    assert ("bot2", "bot2_hall2west") in meanwhile, "else it would stand idle until bot1 is there"
    assert {("bot2", "inspect"), ("bot2", "bot2_west2hall")} <= set(meanwhile)
    assert not [what for who, what in meanwhile if who == "bot1"], "it gets nothing before it is there"
    assert "takes" not in answer


def test_its_lateness_ends_with_the_time_for_which_it_is_awaited() -> None:
    """It may stay to 12 + 50.5 on its clock, and no longer; all others keep to their model."""
    request = read_request(late(awaited={"bot1": 50.5}))
    network = network_from(played(translate(meet("")), Rules()), request)
    bounds = {place.name: place.invariant for place in network.automaton("bot1").locations}
    (bound,) = bounds["going_store_to_hall"]
    assert (bound.clock, bound.op, bound.bound) == ("Cbot1", "<=", 63)
    assert bounds["going_hall_to_store"][0].bound == 9
    for place in network.automaton("bot2").locations:
        assert all(bound.bound == 9 for bound in place.invariant if place.name.startswith("going_"))


@pytest.mark.parametrize("left", [0.0, 0.5])
def test_who_counts_as_lost_before_the_plan_begins_is_not_relied_on(left: float) -> None:
    assert not replan(late(awaited={"bot1": left}))["won"]


def test_a_deadline_that_would_be_missed_then_is_not_promised() -> None:
    assert replan(late(" within 100", awaited={"bot1": 50.0}))["won"]
    assert replan(late(" within 100", awaited={"bot1": 90.0})) == {
        "format": 1, "won": False,
        "why": "'reach_objective: do inspect and load within 100' cannot be guaranteed from here",
    }  # fmt: skip
