"""A way that is blocked is a fact that the plan takes into account: nobody is sent along it."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from
from pursue_runtime.locations import movement
from tests.oracle import ENGINES
from tests.tools.replanning.plays import asked, beginning, game_of, solved, walk

RING = """
poi "a"
poi "b"
poi "c"
poi "d"
connect a and b distance 3
connect b and c distance 3
connect c and d distance 4
connect d and a distance 4
event "fetch" location c duration 3
agent "bot1" controllable mobile 3 location a can_do fetch
agent "bot2" controllable mobile 3 location a can_do fetch
reach_objective: do fetch after 0
"""
"""Two ways lead from a to c: the one by b is shorter."""

WAYS = [("a", "b"), ("b", "c"), ("c", "d"), ("a", "d")]

Request = Dict[str, Any]


def ring() -> Scenario:
    scenario = read(RING, "ring.pur", "ring").scenario
    assert scenario is not None
    return scenario


def start(**changed: Any) -> Request:
    """A request from the beginning of the ring's mission."""
    scenario = ring()
    network = played(translate(scenario), Rules())
    return {
        "format": 1, "game": game_of(scenario), "locations": {a.name: a.initial for a in network.automata},
        "values": dict(network.variables), "clocks": dict.fromkeys(network.clocks, 0.0), "ahead": 1.0, "excused": [],
        **changed,
    }


def under_way(agent: str, a: str, b: str, clock: float, **changed: Any) -> Request:
    """The same with an agent that is on its way."""
    request = start(ahead=0.0)
    automaton = played(translate(ring()), Rules()).automaton(agent)
    (edge,) = (edge for edge in automaton.edges if edge.target == movement(a, b))
    locations, values = {**request["locations"], agent: edge.target}, {**request["values"], **dict(edge.assign)}
    clocks = {**dict.fromkeys(request["clocks"], 50.0), f"C{agent}": clock}
    return {**request, "locations": locations, "values": values, "clocks": clocks, **changed}


def commanded(answer: Request) -> Iterator[Tuple[str, str]]:
    """Agents and the locations to which the plan sends them."""
    assert answer["won"], answer
    for data in answer["strategies"].values():
        for entry in data["strategy"]:
            for command in entry["commands"]:
                yield command["agent"], command["to"]


def movements(ways: List[Tuple[str, str]]) -> List[str]:
    return [movement(x, y) for a, b in ways for x, y in ((a, b), (b, a))]


def test_a_plan_takes_the_other_way_where_one_is_blocked() -> None:
    usual = {to for _, to in commanded(replan(start()))}
    assert {"going_a_to_b", "going_b_to_c"} <= usual
    for way in (["b", "a"], ["b", "c"]):
        other = {to for _, to in commanded(replan(start(blocked=[way])))}
        assert {"going_a_to_d", "going_d_to_c"} <= other and not other & set(movements([(way[0], way[1])]))


def test_where_every_way_is_blocked_there_is_no_plan_and_the_ways_are_named() -> None:
    assert replan(start(blocked=[["a", "b"], ["d", "c"]])) == {
        "format": 1, "won": False,
        "why": "'reach_objective: do fetch after 0' cannot be guaranteed from here"
        " without the way between {a} and {b} and without the way between {c} and {d}",
    }


@pytest.mark.parametrize("way", [["b", "c", "bot1"], ["c", "b", "bot1"]])
def test_a_way_that_one_robot_cannot_take_is_open_to_the_other(way: List[str]) -> None:
    for excused, ways in (("bot2", {"going_a_to_d", "going_d_to_c"}), ("bot1", {"going_a_to_b", "going_b_to_c"})):
        sent = set(commanded(replan(start(blocked=[way], excused=[excused]))))
        assert ways <= {to for _, to in sent}
        assert not sent & {("bot1", to) for to in movements([("b", "c")])}


def test_where_the_only_robot_cannot_take_a_way_it_is_named() -> None:
    request = start(blocked=[["a", "b", "bot1"], ["a", "d", "bot1"]], excused=["bot2"])
    without = [f"without the way between {{a}} and {{{place}}} for {{bot1}}" for place in "bd"]
    assert replan(request)["why"].endswith(" and ".join(without))


def test_another_robot_goes_round_where_one_has_failed() -> None:
    request = under_way("bot1", "b", "c", 5.0, excused=["bot1"], blocked=[["b", "c"]])
    sent = set(commanded(replan(request)))
    assert {("bot2", "going_a_to_d"), ("bot2", "going_d_to_c")} <= sent
    assert not {to for _, to in sent} & {"going_b_to_c", "going_c_to_b"}


def test_a_robot_that_turns_round_takes_the_other_way() -> None:
    """bot1 could not go on from b to c, and begins to go back to b."""
    request = under_way("bot1", "c", "b", 0.0, excused=["bot2"], blocked=[["b", "c"]], turning=["bot1"])
    answer = replan(request)
    assert answer["turning"] == ["bot1"]
    assert {("bot1", f"going_{way}") for way in ("b_to_a", "a_to_d", "d_to_c")} <= set(commanded(answer))


def test_who_returns_may_be_back_at_once_but_not_too_late() -> None:
    request = under_way("bot1", "c", "b", 0.0, ahead=0.5, turning=["bot1"])
    bot1 = network_from(played(translate(ring()), Rules()), read_request(request)).automaton("bot1")
    (place,) = (location for location in bot1.locations if location.name == "going_c_to_b")
    (end,) = (edge for edge in bot1.edges if edge.source == "going_c_to_b")
    assert place.invariant and not [bound for bound in end.guard.clocks if bound.op in (">", ">=")]
    assert not end.controllable


def test_who_turns_round_sets_out_when_the_plan_begins() -> None:
    request = under_way("bot1", "c", "b", 0.0, ahead=50.0, turning=["bot1"])
    network = network_from(played(translate(ring()), Rules()), read_request(request))
    upper = {bound.left: bound.bound for bound in network.start if bound.right is None}
    assert upper["Cbot1"] == 0 and network.automaton("bot1").locations != ()
    assert replan(request)["won"]


def test_who_is_on_a_way_when_it_is_blocked_may_still_arrive() -> None:
    assert replan(under_way("bot1", "b", "c", 5.0, excused=["bot2"], blocked=[["b", "c"]]))["won"]


def test_who_is_not_commanded_moves_as_it_likes() -> None:
    """Only commands are taken away: the thief still takes the way."""
    scenario, won = solved("thesis/catch_the_thief")
    way = scenario.connections[0]
    network = network_from(won.network, read_request(beginning("thesis/catch_the_thief", blocked=[[way.a, way.b]])))
    (thief,) = (agent.name for agent in scenario.agents if not agent.controllable)
    for agent in scenario.agents:
        targets = {edge.target for edge in network.automaton(agent.name).edges}
        assert bool(targets & set(movements([(way.a, way.b)]))) is (agent.name == thief)


@given(
    st.lists(st.tuples(st.sampled_from(WAYS), st.sampled_from(["", "bot1", "bot2"])), unique=True, max_size=3),
    st.sampled_from(["bot1", "bot2", ""]), st.sampled_from(["excused", "turning", ""]),
)
def test_no_plan_uses_a_blocked_way_and_both_engines_agree(
    blocked: List[Tuple[Tuple[str, str], str]], mover: str, how: str
) -> None:
    request = start() if not mover else under_way(mover, "b", "c", 5.0, **({how: [mover]} if how else {}))
    request["blocked"] = [[*way, alone] if alone else list(way) for way, alone in blocked]
    answer = replan(request)
    if answer["won"]:
        for way, alone in blocked:
            assert not {to for who, to in commanded(answer) if alone in ("", who)} & set(movements([way]))
    scenario, network = ring(), network_from(played(translate(ring()), Rules()), read_request(request))
    assert solve(network, scenario_objective(scenario), Rules().reaction, engine=ENGINES["python"]).won is answer["won"]


@pytest.mark.parametrize("name", ["thesis/scenario_3", "thesis/catch_the_thief"])
def test_in_the_middle_of_plays_no_plan_uses_a_blocked_way(name: str) -> None:
    scenario, _ = solved(name)
    plans = 0
    for state, clocks in list(walk(name, 2, 20))[::4]:
        for way in scenario.connections:
            answer = replan(asked(name, state, clocks, blocked=[[way.a, way.b]]))
            if answer["won"]:
                plans += 1
                assert not {to for _, to in commanded(answer)} & set(movements([(way.a, way.b)]))
    assert plans
