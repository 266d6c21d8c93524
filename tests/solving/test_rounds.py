"""Rounds of robots through places."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations, product
from typing import Dict, List, Sequence, Tuple

from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.solving.rounds import Robot, Round, Visit, cost, least_wait, rounds

NAMES = "abcdefgh"


def on_a_line(positions: Sequence[int], start: int, stay: float = 1.0) -> Robot:
    """A robot among places on a line."""
    times = {a: {b: float(abs(positions[j] - positions[k])) for k, b in enumerate(NAMES[: len(positions)])}
             for j, a in enumerate(NAMES[: len(positions)])}  # fmt: skip
    return Robot(NAMES[start], times, stay)


def test_neighbours_are_visited_by_the_robot_that_starts_near_them() -> None:
    positions = (0, 2, 4, 20, 22, 24)
    robots = [on_a_line(positions, 5), on_a_line(positions, 0)]
    visits = [Visit(name, frozenset((0, 1)), 10.0) for name in NAMES[:6]]
    found = rounds(robots, visits)
    assert found is not None
    assert [sorted(some) for some in found] == [[3, 4, 5], [0, 1, 2]]
    assert [cost(robot, visits, some).length for robot, some in zip(robots, found)] == [8, 8]


def test_each_place_goes_to_somebody_who_can_go_there() -> None:
    robots = [on_a_line((0, 5, 10), 0), on_a_line((0, 5, 10), 0)]
    visits = [Visit("a", frozenset((1,)), 50.0), Visit("b", frozenset((0,)), 50.0), Visit("c", frozenset((0, 1)), 50.0)]
    found = rounds(robots, visits)
    assert found is not None
    assert 0 in found[1] and 1 in found[0]
    assert rounds(robots, [*visits, Visit("a", frozenset(), 50.0)]) is None


def test_places_that_nobody_comes_to_have_no_rounds() -> None:
    alone = Robot("a", {"a": {"b": 3.0}}, 1.0)
    assert rounds([alone], [Visit("c", frozenset((0,)), 50.0)]) is None


def test_what_is_in_one_place_goes_to_another_robot_together() -> None:
    positions = (0, 3, 1, 1)
    robots = [on_a_line(positions, 0), on_a_line(positions, 1)]
    visits = [Visit(name, frozenset((0,) if name == "a" else (0, 1)), 10.0) for name in NAMES[:4]]
    found = rounds(robots, visits)
    assert found is not None
    assert parts_of(robots, visits, found) == best(robots, visits) == 0.1


@st.composite
def cases(draw: st.DrawFn) -> Tuple[List[Robot], List[Visit]]:
    """Up to three robots of one speed and up to four places on a line."""
    size, robots = draw(st.integers(1, 4)), draw(st.integers(1, 3))
    positions = draw(st.lists(st.integers(0, 20), min_size=size, max_size=size))
    starts = draw(st.lists(st.integers(0, size - 1), min_size=robots, max_size=robots))
    able = [draw(st.sets(st.integers(0, robots - 1), min_size=1)) for _ in range(size)]
    periods = [draw(st.sampled_from((10.0, 20.0))) for _ in range(size)]
    visits = [Visit(NAMES[k], frozenset(able[k]), periods[k]) for k in range(size)]
    return [on_a_line(positions, start) for start in starts], visits


def parts_of(robots: Sequence[Robot], visits: Sequence[Visit], some: Sequence[Round]) -> float:
    return max(cost(robot, visits, mine).part for robot, mine in zip(robots, some))


def best(robots: Sequence[Robot], visits: Sequence[Visit]) -> float:
    """The least part of a period that a visit waits, of all rounds."""
    least = float("inf")
    for owners in product(*(sorted(visit.robots) for visit in visits)):
        given: Dict[int, List[int]] = {k: [] for k in range(len(robots))}
        for k, owner in enumerate(owners):
            given[owner].append(k)
        worst = 0.0
        for robot, mine in given.items():
            worst = max(worst, min(cost(robots[robot], visits, order).part for order in permutations(mine)))
        least = min(least, worst)
    return least


@settings(deadline=None)
@given(cases())
def test_each_visit_is_in_one_round_of_a_robot_that_can_do_it_and_costs_are_those_of_real_rounds(
    case: Tuple[List[Robot], List[Visit]]
) -> None:
    robots, visits = case
    found = rounds(robots, visits)
    assert found is not None
    assert sorted(k for some in found for k in some) == list(range(len(visits)))
    assert all(robot in visits[k].robots for robot, some in enumerate(found) for k in some)
    assert best(robots, visits) - 1e-9 <= parts_of(robots, visits, found)


@settings(deadline=None)
@given(cases())
def test_no_rounds_make_all_wait_less_than_the_least(case: Tuple[List[Robot], List[Visit]]) -> None:
    robots, visits = case
    assert least_wait(robots, visits) <= best(robots, [replace(visit, period=1.0) for visit in visits]) + 1e-9


def test_the_least_wait_is_that_of_ways_through_what_is_near() -> None:
    robots = [on_a_line((0, 2, 4, 20, 22, 24), 0)] * 2
    visits = [Visit(name, frozenset((0, 1)), 10.0) for name in NAMES[:6]]
    assert least_wait(robots, visits) == (2 + 2 + 2 + 2) / 2 - 1
    assert least_wait(robots, visits[:1]) == 0
