"""Robots that change places: whatever is found is a sequence of moves that they can make."""

from __future__ import annotations

from random import Random
from typing import Dict, List, Mapping, Tuple

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from pursue_gen.solving.crowds import LITTLE, crowded_routes
from pursue_gen.solving.floors import Floor, Move
from pursue_gen.solving.routes import _InTime, _OneByOne, routes

Ways = Dict[str, Dict[str, int]]


def connected(pairs: List[Tuple[str, str, int]]) -> Ways:
    ways: Ways = {}
    for a, b, takes in pairs:
        ways.setdefault(a, {})[b] = takes
        ways.setdefault(b, {})[a] = takes
    return ways


def corridor(robots: int) -> Tuple[Floor, Dict[str, str], Dict[str, str]]:
    numbers = range(1, robots + 2)
    pairs = [(f"hall{k}", f"hall{k + 1}", 50) for k in numbers[:-1]] + [(f"hall{k}", f"room{k}", 40) for k in numbers]
    ways = connected(pairs)
    names = {f"bot{k}": k for k in range(1, robots + 1)}
    at = {name: f"room{k}" for name, k in names.items()}
    return Floor({name: ways for name in names}, set(ways)), at, {n: f"room{robots + 1 - k}" for n, k in names.items()}


def legal(floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str], moves: List[Move]) -> None:
    """Each move is along a way of its robot, from where that is into a place that holds nobody else if it holds one."""
    here = dict(at)
    for move in moves:
        assert here[move.robot] == move.origin
        assert move.target in floor.ways[move.robot][move.origin]
        assert move.target not in floor.single or move.target not in here.values(), move
        here[move.robot] = move.target
    assert {name: here[name] for name in wanted} == wanted


@st.composite
def crowds(draw: st.DrawFn) -> Tuple[Floor, Dict[str, str], Dict[str, str]]:
    chosen = Random(draw(st.integers(0, 10**6)))
    places = [f"p{k}" for k in range(draw(st.integers(3, 10)))]
    pairs = [(place, chosen.choice(places[:k]), chosen.randint(1, 60)) for k, place in enumerate(places) if k]
    for _ in range(draw(st.integers(0, 4))):
        a, b = chosen.sample(places, 2)
        pairs.append((a, b, chosen.randint(1, 60)))
    ways = connected(pairs)
    if draw(st.booleans()):
        origin = chosen.choice([place for place in places if len(ways[place]) > 1] or places)
        ways[origin].pop(chosen.choice(list(ways[origin])))  # one way
    robots = [f"bot{k}" for k in range(draw(st.integers(1, min(6, len(places)))))]
    at = dict(zip(robots, chosen.sample(places, len(robots))))
    some = chosen.sample(robots, draw(st.integers(1, len(robots))))
    wanted = dict(zip(some, chosen.sample(places, len(some))))
    single = set(chosen.sample(places, draw(st.integers(1, len(places)))))
    return Floor({name: ways for name in robots}, single), at, wanted


@settings(max_examples=300, deadline=None)
@given(crowd=crowds())
def test_each_way_to_find_moves_finds_moves_that_can_be_made(
    crowd: Tuple[Floor, Dict[str, str], Dict[str, str]]
) -> None:
    floor, at, wanted = crowd
    one_by_one = _OneByOne(floor, at, wanted).found() if set(wanted) == set(at) else None
    crowded = crowded_routes(floor, at, wanted, LITTLE)
    sooner = None if crowded is None else _InTime(floor, at, wanted).sooner(crowded)
    for called, moves in (
        ("in time", _InTime(floor, at, wanted).found()), ("one by one", one_by_one),
        ("crowded", crowded), ("sooner", sooner),
    ):
        event(f"{called}: {moves is not None}")
        if moves is not None:
            legal(floor, at, wanted, moves)


@settings(max_examples=150, deadline=None)
@given(crowd=crowds())
def test_of_few_robots_all_moves_are_looked_at(crowd: Tuple[Floor, Dict[str, str], Dict[str, str]]) -> None:
    floor, at, wanted = crowd
    moves = routes(floor, at, wanted)
    event(f"found: {moves is not None}")
    if moves is not None:
        legal(floor, at, wanted, moves)
    elif len(at) <= 3:
        assert not can_be_reached(floor, at, wanted)


def can_be_reached(floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str]) -> bool:
    """Whether any moves bring the robots there."""
    found, waiting = {tuple(at.items())}, [dict(at)]
    while waiting:
        here = waiting.pop()
        if all(here[name] == place for name, place in wanted.items()):
            return True
        for name, place in here.items():
            for target in floor.ways[name][place]:
                there = {**here, name: target}
                if (target not in floor.single or target not in here.values()) and tuple(there.items()) not in found:
                    found.add(tuple(there.items()))
                    waiting.append(there)
    return False


@pytest.mark.parametrize("robots", [1, 2, 5, 12, 30])
def test_robots_pass_each_other_in_a_corridor_with_one_free_room(robots: int) -> None:
    crowd = corridor(robots)
    moves = routes(*crowd)
    assert moves is not None
    legal(*crowd, moves)


def test_who_has_nowhere_to_go_makes_way() -> None:
    ways = connected([("a", "b", 1), ("b", "c", 1), ("b", "bay", 1)])
    floor = Floor({"bot1": ways, "bot2": ways}, set(ways))
    at, wanted = {"bot1": "a", "bot2": "b"}, {"bot1": "c"}
    moves = routes(floor, at, wanted)
    assert moves is not None
    legal(floor, at, wanted, moves)


def test_places_that_hold_several_are_no_obstacle() -> None:
    ways = connected([("a", "b", 1), ("b", "c", 1)])
    floor = Floor({"bot1": ways, "bot2": ways}, {"a", "c"})
    at, wanted = {"bot1": "a", "bot2": "c"}, {"bot1": "c", "bot2": "a"}
    moves = routes(floor, at, wanted)
    assert moves is not None
    legal(floor, at, wanted, moves)


def test_two_robots_on_a_line_cannot_pass_each_other() -> None:
    ways = connected([("a", "b", 1), ("b", "c", 1)])
    floor = Floor({"bot1": ways, "bot2": ways}, set(ways))
    assert routes(floor, {"bot1": "a", "bot2": "c"}, {"bot1": "c", "bot2": "a"}) is None
