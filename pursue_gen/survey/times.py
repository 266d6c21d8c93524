"""How long a robot takes for a path: the window of a `travel`, from its speed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import List, Mapping, Tuple

from pursue_gen.drawing.layout import yaw_of
from pursue_gen.language.scenario import Pose
from pursue_gen.survey.routes import Route

_EXACT = 0.97
"""What a path is at least, in proportion to its length: what is found may be a little longer than the shortest one."""

_SHARP = math.radians(30)
"""Bends from here on are taken to need a stop."""


@dataclass(frozen=True)
class Drive:
    """How robots drive. `speeds`: metres per second, by robot; only these get windows.

    `time_unit`: seconds per time unit, as `~time_unit` of the mission. `turning`: radians per second on the spot;
    `acceleration`: metres per second per second, when a robot starts and when it stops; `start`: seconds for planning
    in a movement. A movement may take `reserve` (a part, such as 0.25) longer than computed, and a robot has arrived
    `tolerance` metres before the pose at the earliest.
    """

    speeds: Mapping[str, float] = field(default_factory=dict)
    time_unit: float = 1.0
    turning: float = 0.5
    acceleration: float = 0.5
    start: float = 2.0
    reserve: float = 0.25
    tolerance: float = 0.4


def window(route: Route, ends: Tuple[Pose, Pose], speed: float, drive: Drive) -> Tuple[int, int]:
    """The window of a movement along a path, in whole time units: later than the first, at the second at the latest.

    `ends`: the poses at which it begins and ends. The first number is the time for the path at this speed, without any
    turn, to where the robot has arrived at the earliest. The second one is the time for the path, for all turns on the
    spot, from the direction of the first pose to that of the second one, for starting and stopping, also at each sharp
    bend, and for planning, with the reserve.
    """
    shortest = max(0.0, route.length * _EXACT - 2 * drive.tolerance)
    turns = turned(route, ends)
    stops = 1 + sum(turn >= _SHARP for turn in turns[1:-1])
    moving = route.length / speed + stops * speed / drive.acceleration
    longest = (moving + sum(turns) / drive.turning + drive.start) * (1 + drive.reserve)
    low = math.floor(shortest / speed / drive.time_unit)
    return low, max(low + 1, math.ceil(longest / drive.time_unit))


def turned(route: Route, ends: Tuple[Pose, Pose]) -> List[float]:
    """All turns (radians) of a robot that looks along its path, from the one at its beginning to the one at its end."""
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(route.bends, route.bends[1:]) if a != b]
    directions = [yaw_of(ends[0]), *headings, yaw_of(ends[1])]
    return [abs(math.remainder(b - a, 2 * math.pi)) for a, b in zip(directions, directions[1:])]
