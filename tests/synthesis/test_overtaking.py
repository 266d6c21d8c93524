"""A command that is on its way, and another one decided meanwhile: a win does not depend on which comes first."""

from __future__ import annotations

from fractions import Fraction
from typing import List, Optional, Tuple

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from benchmarks.families import catch_by_one_distance
from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.overtaking import kept_apart, shortened
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective
from pursue_gen.zones.dbm import Dbm
from tests.oracle import ENGINES
from tests.synthesis.zones import Point, later, points, times, zones

WAITER = """\
poi "desk"
poi "room"
connect desk and room distance 4
event "call" location room
event "serve" location room duration 2
event "pay" location desk
agent "waiter" controllable mobile 1 location desk can_do serve, pay
agent "guest" location room can_do call
objective: if call then serve within {}
reach_objective: do pay after 20
"""

HALF = Fraction(1, 2)
GO, AGAIN = (0,), (1,)


def chase(again_by: str) -> Network:
    """The bot can win up to x = 2; it comes there later, and then it or its mate has to set x back."""
    come = Edge("start", "here", Guard((ClockBound("x", ">=", 3),)))
    win = Edge("here", "win", Guard((ClockBound("x", "<=", 2),)))
    again = (Edge("here", "here", resets=("x",)),) if again_by == "bot" else ()
    lift = (Edge("idle", "idle", resets=("x",)),) if again_by == "mate" else ()
    bot = Automaton("bot", tuple(map(Location, ("start", "here", "win"))), "start", (come, win, *again))
    return Network(("x",), (), (), (bot, Automaton("mate", (Location("idle"),), "idle", lift)))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("again_by", ["bot", "mate"])
def test_a_command_that_gains_is_not_overtaken_by_one_that_starts_over(engine: str, again_by: str) -> None:
    network, objective = chase(again_by), Objective(Kind.REACH, goal=(("bot", "win"),))
    verdict = solve(network, objective, HALF, ENGINES[engine])
    assert verdict.strategy is not None
    assert verify(network, objective, verdict.strategy, HALF).ok
    assert verdict.ranks is None or verify(network, objective, verdict.strategy, HALF, ranks=verdict.ranks).ok


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("distance", [30, 50])
def test_an_officer_who_is_late_does_not_turn_round_for_ever(engine: str, distance: int) -> None:
    scenario = parse(catch_by_one_distance(distance), "chase.pur", "chase")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    verdict = solve(network, objective, Fraction(1, 10), ENGINES[engine])
    assert verdict.strategy is not None
    assert prove(network, objective, verdict.strategy, Fraction(1, 10), verdict.ranks).blocks


@given(zones, zones, points, st.integers(1, 3))
def test_a_later_command_begins_where_no_earlier_one_is_on_its_way(
    first: Dbm, zone: Dbm, point: Point, late: int
) -> None:
    parts = zone.minus(first)
    assume(parts)
    second = parts[0]
    apart = kept_apart([(first, GO), (second, AGAIN)], [1, 2], late)

    def said(at: Point) -> Tuple[Optional[Tuple[int, ...]], ...]:
        return tuple(action for (part, action), _ in apart if part.contains(at))

    assert len(said(point)) == (first.contains(point) or second.contains(point))
    assert (said(point) == (GO,)) == first.contains(point)
    if not second.contains(point):
        return
    ways = [later(point, time) for time in times(point)]
    on = [at for at in ways if second.contains(at)]
    overtakes = first.up_within(late)
    if any(said(at) == (AGAIN,) and not overtakes.contains(at) for at in on):
        assert (said(point) == (None,)) == overtakes.contains(point), "wait for the rest of the zone"
    elif all(overtakes.contains(at) for at in on):
        assert said(point) == (AGAIN,), "there is nothing to wait for"


def test_ranks_say_which_command_must_not_be_overtaken() -> None:
    early, then = Dbm.of(2, [(1, 0, 5)]), Dbm.of(2, [(0, 1, -4)])
    assert early is not None and then is not None  # x <= 2 and x > 2
    pieces = [(early, GO), (then, AGAIN)]
    assert kept_apart(pieces, [2, 1], 1) == [(pieces[0], 2), (pieces[1], 1)]
    assert kept_apart(pieces, [1, 1], 1) == [(pieces[0], 1), (pieces[1], 1)]
    assert kept_apart([pieces[0], (then, GO)], [1, 2], 1) == [(pieces[0], 1), ((then, GO), 2)]
    assert [(action, rank) for (_, action), rank in kept_apart(pieces, [1, 2], 1)] == [(GO, 1), (AGAIN, 2), (None, 2)]


def between(low: int, high: int) -> Dbm:
    """low < x <= high."""
    zone = Dbm.of(2, [(0, 1, -2 * low), (1, 0, 2 * high + 1)])
    assert zone is not None
    return zone


def advice(apart: List[Tuple[Tuple[Dbm, Optional[Tuple[int, ...]]], int]], x: Fraction) -> Optional[Tuple[int, ...]]:
    """What is said at x, where all said is disjoint."""
    (action,) = [action for (zone, action), _ in apart if zone.contains((x,))]
    return action


@pytest.mark.parametrize("next_action", [AGAIN, (2,), None])
def test_a_zone_that_ends_in_flight_waits_for_what_comes_next(next_action: Optional[Tuple[int, ...]]) -> None:
    pieces = [(between(0, 2), GO), (between(2, 3), AGAIN), (between(3, 9), next_action)]
    apart = kept_apart(pieces, [1, 2, 2], 1)
    assert advice(apart, Fraction(5, 2)) is None, "all of it is met by the first command in flight"
    assert advice(apart, Fraction(1)) == GO and advice(apart, Fraction(5)) == next_action


def test_a_zone_that_ends_in_flight_stays_where_what_comes_next_leads_less_far() -> None:
    pieces = [(between(0, 2), GO), (between(2, 3), AGAIN), (between(3, 9), (2,))]
    assert advice(kept_apart(pieces, [1, 2, 3], 1), Fraction(5, 2)) == AGAIN
    alone = kept_apart(pieces[:2], [1, 2], 1)
    assert advice(alone, Fraction(5, 2)) == AGAIN, "nothing comes next"


@given(zones, zones, points, st.integers(1, 3))
def test_an_earlier_command_ends_where_a_later_one_could_overtake_it(
    first: Dbm, zone: Dbm, point: Point, late: int
) -> None:
    parts = zone.minus(first)
    assume(parts)
    second = parts[0]
    shorter = shortened([(first, GO), (second, AGAIN)], [1, 2], late)
    said = [action for part, action in shorter if part.contains(point)]
    assert len(said) == (first.contains(point) or second.contains(point))
    assert (said == [AGAIN]) == second.contains(point), "the later command stays as it is"
    if first.contains(point):
        met = any(second.contains(later(point, time)) for time in times(point) if time <= late)
        assert said == [None if met else GO]


@pytest.mark.parametrize("deadline", [11, 12, 14, 17])
def test_a_waiter_whom_a_guest_calls_for_ever_goes_to_the_desk_in_time(deadline: int) -> None:
    """Lingering in the zone of the way to the desk until the next call has to be answered would never end."""
    text = WAITER.format(deadline)
    scenario = parse(text, "waiter.pur", "waiter")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    verdict = solve(network, objective, Fraction(1, 10))
    assert verdict.strategy is not None
    proven = prove(
        network, objective, verdict.strategy, Fraction(1, 10), verdict.ranks, otherwise=verdict.cautious
    )
    assert verify(network, objective, proven, Fraction(1, 10)).ok
