"""How long places wait on a tour; places that come more often than others on one."""

from __future__ import annotations

from fractions import Fraction
from typing import List

from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from pursue_gen.proof.checker import verify
from pursue_gen.solving.gaps import gaps, part_of_period, repeated
from pursue_gen.solving.options import DEFAULT as OPTIONS
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.tours import tours_of, won_by_tours
from pursue_gen.solving.walkers import Patrol, patrol_of
from pursue_gen.synthesis.strategy import with_automata_of
from tests.patrols import game_of

LATE = Rules().reaction

NIGHT = """
poi "door"
poi "hall"
poi "room1"
poi "room2"
poi "room3"
connect door and hall distance 5
connect hall and room1 distance 12
connect hall and room2 distance 12
connect hall and room3 distance 12
agent "guard" controllable mobile 1 location door
objective: patrol door every 60 by guard
objective: patrol room1, room2, room3 every 180 by guard
"""
"""Once around all rooms takes some 90 time units, with the door after each of them some 120."""


def patrol(text: str) -> Patrol:
    found = patrol_of(*game_of(text), LATE)
    assert found is not None
    return found


def test_a_place_with_a_short_period_comes_after_each_of_those_with_a_long_one() -> None:
    network, objective = game_of(NIGHT)
    found = won_by_tours(network, objective, LATE, OPTIONS)
    assert found is not None
    stops = [stop for stop in found.strategy.tours[0].stops if stop != "hall"]
    assert stops[1:].count("door") == 3 and {"room1", "room2", "room3"} < set(stops)
    assert verify(with_automata_of(network, found.strategy), objective, found.strategy, LATE).ok


def test_places_that_are_only_passed_do_not_wait() -> None:
    some = patrol(NIGHT.replace("door every 60", "hall every 60"))
    walker, mine = some.walkers[0], (1, 2, 3, 0)
    assert gaps(walker, some, mine)[0].later < 30 < gaps(walker, some, mine)[1].later


def test_no_place_comes_twice_where_once_is_enough() -> None:
    some = patrol(NIGHT.replace("every 60", "every 180"))
    mine = (0, 1, 2, 3)
    assert repeated(some.walkers[0], some, mine, Fraction(9, 10)) == mine


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(st.integers(2, 9), min_size=4, max_size=4), st.integers(20, 90), st.integers(40, 200))
def test_what_tours_promise_is_proven(far: List[int], often: int, seldom: int) -> None:
    text = NIGHT.replace("every 60", f"every {often}").replace("every 180", f"every {seldom}")
    for k, place in enumerate(("door and hall distance 5", *(f"hall and room{n} distance 12" for n in (1, 2, 3)))):
        text = text.replace(place, f"{place.rsplit(' ', 1)[0]} {far[k]}")
    network, objective = game_of(text)
    assume(tours_of(network, objective, LATE) is not None)
    some = patrol(text)
    once = part_of_period(some.walkers[0], some, (0, 1, 2, 3)) < 1
    event(f"each place once: {once}")
    assert won_by_tours(network, objective, LATE, OPTIONS) is not None


def test_periods_that_a_round_keeps_are_kept_with_more_visits() -> None:
    ways = [("hall and r0", 3), ("hall and r1", 29), ("r0 and r2", 10)]
    ways += [("r1 and r3", 6), ("r3 and r4", 6), ("r0 and r5", 1)]
    lines = [f'poi "{name}"' for name in ("hall", *(f"r{k}" for k in range(6)))]
    lines += [f"connect {ends} distance {metres}" for ends, metres in ways]
    lines.append('agent "guard" controllable mobile 1 location r0')
    some = patrol("\n".join([*lines, *(f"objective: patrol r{k} every 209 by guard" for k in range(6))]))
    walker, mine = some.walkers[0], (5, 4, 3, 0, 1, 2)
    assert part_of_period(walker, some, mine) < 1
    assert part_of_period(walker, some, repeated(walker, some, mine, Fraction(9, 10))) < 1
