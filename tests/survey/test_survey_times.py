"""Windows of movements from the speed of a robot: nothing earlier than it can be, and turns count."""

from __future__ import annotations

import math
from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.drawing.layout import yaw_of
from pursue_gen.language.scenario import Pose
from pursue_gen.survey.graph import graph_of
from pursue_gen.survey.grid import Point, grid_of
from pursue_gen.survey.routes import Drive, Route, Routes, turned, window
from tests.survey.maps import ground_of, three_rooms


def pose(yaw: float) -> Pose:
    return Pose(0, 0, 0, 0, 0, math.sin(yaw / 2), math.cos(yaw / 2))


EAST, NORTH, WEST = pose(0), pose(math.pi / 2), pose(math.pi)
STRAIGHT = Route(((0.0, 0.0), (10.0, 0.0)), 10.0)
CORNER = Route(((0.0, 0.0), (10.0, 0.0), (10.0, 10.0)), 20.0)


@pytest.mark.parametrize(
    ("route", "ends", "quarters"),
    [
        (STRAIGHT, (EAST, EAST), 0),
        (STRAIGHT, (NORTH, EAST), 1),
        (STRAIGHT, (WEST, WEST), 4),
        (CORNER, (EAST, NORTH), 1),
        (CORNER.reversed(), (EAST, NORTH), 3),
        (Route(((0.0, 0.0), (0.0, 0.0)), 0.0), (EAST, WEST), 2),
    ],
)
def test_all_turns_of_a_path_count_those_at_its_ends_too(route: Route, ends: object, quarters: int) -> None:
    assert sum(turned(route, ends)) == pytest.approx(quarters * math.pi / 2)  # type: ignore[arg-type]


def test_the_window_reaches_from_the_speed_alone_to_the_turns_the_start_and_the_reserve() -> None:
    numbers = {"turning": math.pi / 4, "acceleration": 0.25, "start": 3.0, "reserve": 0.5, "tolerance": 0.35}
    high = math.ceil((20 / 0.5 + 2 * 0.5 / 0.25 + 2 + 3) * 1.5)  # it starts twice, and turns once
    assert window(CORNER, (EAST, NORTH), 0.5, Drive(**numbers)) == (math.floor((20 * 0.97 - 0.7) / 0.5), high)
    assert window(CORNER, (EAST, NORTH), 0.5, Drive(time_unit=10.0, **numbers)) == (3, math.ceil(high / 10))
    assert window(Route(((0.0, 0.0), (0.1, 0.0)), 0.1), (EAST, EAST), 0.5, Drive()) == (0, 4)


@given(st.floats(0, 1000), st.floats(0.05, 5), st.floats(0.1, 60), st.floats(0, 1))
def test_a_window_is_never_empty_and_holds_the_time_for_the_path(
    length: float, speed: float, unit: float, reserve: float
) -> None:
    route = Route(((0.0, 0.0), (length, 0.0)), length)
    low, high = window(route, (EAST, NORTH), speed, Drive(time_unit=unit, reserve=reserve))
    assert 0 <= low < high
    assert low * unit <= length / speed <= high * unit


# Robots that drive ----------------------------------------------------------------------------------------------------

ROOMS = grid_of(ground_of(three_rooms(resolution=0.1), 0.1), 0.3)
SHARP = math.pi / 6  # radians from which on a robot stops to turn


def driven(
    route: Route, ends: Tuple[Pose, Pose], speed: float, turning: float, acceleration: float, delay: float
) -> float:
    """Seconds of a robot that plans, turns to its path, drives, stops at sharp bends to turn, and turns at the end."""
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(route.bends, route.bends[1:])]
    sizes = [math.dist(a, b) for a, b in zip(route.bends, route.bends[1:])]
    turns = [math.remainder(b - a, 2 * math.pi) for a, b in zip(headings, headings[1:])]
    first = math.remainder(headings[0] - yaw_of(ends[0]), 2 * math.pi)
    last = math.remainder(yaw_of(ends[1]) - headings[-1], 2 * math.pi)
    legs = [sizes[0]]
    stops = [first, last]
    for turn, size in zip(turns, sizes[1:]):
        if abs(turn) < SHARP:
            legs[-1] += size
        else:
            legs.append(size)
            stops.append(turn)
    ramp = speed**2 / acceleration  # metres to start and to stop
    drives = (leg / speed + speed / acceleration if leg > ramp else 2 * math.sqrt(leg / acceleration) for leg in legs)
    return delay + sum(drives) + sum(abs(turn) for turn in stops) / turning


POINTS = st.tuples(st.floats(0.5, 11.5), st.floats(0.5, 5.5)).filter(lambda point: ROOMS.is_free(ROOMS.cell(*point)))
ANGLES = st.floats(-math.pi, math.pi)


@given(POINTS, POINTS, ANGLES, ANGLES, st.floats(0.2, 1.0), st.floats(0.9, 1.0), st.floats(1.0, 2.0), st.floats(0, 2))
def test_a_robot_that_is_a_little_slower_and_stops_to_turn_keeps_the_window(
    a: Point, b: Point, yaw: float, last: float, speed: float, slower: float, quicker: float, delay: float
) -> None:
    route = Routes(graph_of(ROOMS), [a]).route(a, b)
    assert route is not None
    if route.length < 1:
        return
    ends = pose(yaw), pose(last)
    low, high = window(route, ends, speed, Drive())
    seconds = driven(route, ends, speed * slower, Drive().turning * quicker, Drive().acceleration, delay)
    assert low < seconds <= high
