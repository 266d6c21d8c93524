"""Windows of movements from the speed of a robot: nothing earlier than it can be, and turns count."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.scenario import Pose
from pursue_gen.survey.routes import Route
from pursue_gen.survey.times import Drive, turned, window


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
    assert turned(route, ends) == pytest.approx(quarters * math.pi / 2)  # type: ignore[arg-type]


def test_the_window_reaches_from_the_speed_alone_to_the_turns_the_start_and_the_reserve() -> None:
    drive = Drive(turning=math.pi / 4, start=3, reserve=0.5, tolerance=0.35)
    assert window(CORNER, (EAST, NORTH), 0.5, drive) == (math.floor((20 * 0.97 - 0.7) / 0.5), (40 + 2 + 3) * 3 // 2 + 1)
    slow = Drive(time_unit=10.0, turning=math.pi / 4, start=3, reserve=0.5, tolerance=0.35)
    assert window(CORNER, (EAST, NORTH), 0.5, slow) == (3, 7)
    assert window(Route(((0.0, 0.0), (0.1, 0.0)), 0.1), (EAST, EAST), 0.5, Drive()) == (0, 3)


@given(st.floats(0, 1000), st.floats(0.05, 5), st.floats(0.1, 60), st.floats(0, 1))
def test_a_window_is_never_empty_and_holds_the_time_for_the_path(
    length: float, speed: float, unit: float, reserve: float
) -> None:
    route = Route(((0.0, 0.0), (length, 0.0)), length)
    low, high = window(route, (EAST, NORTH), speed, Drive(time_unit=unit, reserve=reserve))
    assert 0 <= low < high
    assert low * unit <= length / speed <= high * unit
