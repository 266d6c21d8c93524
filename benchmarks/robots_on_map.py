"""How a robot drives on a map: along walls and through doors, as fast as it is. Without ROS; for `benchmarks.from_map`.

The path is looked for on the map's cells, by this module alone: nothing is shared with what `pursue-gen survey` does.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass
from random import Random
from typing import Dict, FrozenSet, Iterator, List, Mapping, NamedTuple, Sequence, Tuple

from pursue_gen.drawing.ground import Ground

Cell = Tuple[int, int]
Point = Tuple[float, float]
Pose = Tuple[float, float, float]
"""x, y and yaw on the map (metres, radians)."""

DEVIATION = 0.07
"""Of the logarithms of a robot's times, from drive to drive and from action to action."""

WAITS, WAIT = 0.05, (1.0, 4.0)
"""The share of drives on which somebody is in the way, and for how many seconds."""

AHEAD = 0.5
"""Metres of the path that say in which direction a robot sets out, or comes."""


@dataclass(frozen=True)
class Nature:
    """What a robot is like: `speed` (m/s), `acceleration` (m/s²), `turning` (rad/s), `planning` (seconds before it
    sets out), and the seconds that its actions take."""

    speed: float
    acceleration: float
    turning: float
    planning: float
    acts: Mapping[str, float]


class Moment(NamedTuple):
    """Where a robot is so many seconds after it got its goal."""

    after: float
    at: Pose


def nature(random: Random, actions: Sequence[str]) -> Nature:
    """Some robot: no number of it is in any scenario."""
    speed, acceleration = random.uniform(0.25, 0.5), random.uniform(0.15, 0.6)
    turning, planning = random.uniform(0.35, 1.2), random.uniform(0.3, 1.5)
    acts = {name: round(random.uniform(2.5, 6.0), 1) for name in actions}
    return Nature(round(speed, 2), round(acceleration, 2), round(turning, 2), round(planning, 1), acts)


def varied(seconds: float, random: Random) -> float:
    """A time of this drive, of one that usually takes so long."""
    return seconds * random.lognormvariate(0.0, DEVIATION)


class Floor:
    """The cells of a map on which the centre of a robot of this radius (metres) may be."""

    def __init__(self, ground: Ground, radius: float) -> None:
        pixels = ground.free_pixels()
        assert pixels is not None and ground.settings.yaw == 0.0, "a map along the axes whose greys are known"
        self._place, reach = ground.settings, radius / ground.settings.resolution
        width, height = ground.width, ground.height
        free = {(x, y) for x in range(width) for y in range(height) if pixels[(height - 1 - y) * width + x]}
        near = range(-math.floor(reach), math.floor(reach) + 1)
        disc = [(dx, dy) for dx in near for dy in near if math.hypot(dx, dy) <= reach]
        self._free: FrozenSet[Cell] = frozenset(
            (x, y) for x, y in free if all((x + dx, y + dy) in free for dx, dy in disc)
        )

    def path(self, a: Point, b: Point) -> List[Point]:
        """The points of a shortest path on the cells and their eight neighbours (metres). Raises ValueError where there
        is none."""
        start, goal = self._cell(a), self._cell(b)
        open_: List[Tuple[float, float, Cell, Cell]] = [(0.0, 0.0, start, start)]
        whence: Dict[Cell, Cell] = {}
        while open_:
            _, metres, cell, before = heapq.heappop(open_)
            if cell in whence:
                continue
            whence[cell] = before
            if cell == goal:
                break
            for step, there in self._neighbours(cell):
                left = math.hypot(goal[0] - there[0], goal[1] - there[1])
                heapq.heappush(open_, (metres + step + left, metres + step, there, cell))
        if goal not in whence:
            raise ValueError(f"no way from {a} to {b}")
        cells = [goal]
        while cells[-1] != start:
            cells.append(whence[cells[-1]])
        return [a, *(self._point(cell) for cell in cells[-2:0:-1]), b]

    def _cell(self, point: Point) -> Cell:
        x, y = ((here - origin) / self._place.resolution for here, origin in zip(point, (self._place.x, self._place.y)))
        near = (math.floor(x), math.floor(y))
        return min(self._free, key=lambda cell: (cell[0] - near[0]) ** 2 + (cell[1] - near[1]) ** 2)

    def _point(self, cell: Cell) -> Point:
        size = self._place.resolution
        return self._place.x + (cell[0] + 0.5) * size, self._place.y + (cell[1] + 0.5) * size

    def _neighbours(self, cell: Cell) -> Iterator[Tuple[float, Cell]]:
        """With the distance to each; no corner of an obstacle is cut."""
        x, y = cell
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                through = {(x + dx, y), (x, y + dy), (x + dx, y + dy)} - {cell}
                if through and through <= self._free:
                    yield math.hypot(dx, dy), (x + dx, y + dy)


def drive(floor: Floor, start: Pose, goal: Pose, robot: Nature, random: Random) -> List[Moment]:
    """A drive of this robot: it plans, turns into the path, drives, somebody may be in its way, and it turns again."""
    path = floor.path(start[:2], goal[:2])
    metres = [0.0]
    for a, b in zip(path, path[1:]):
        metres.append(metres[-1] + math.dist(a, b))
    length, pace = metres[-1], varied(1.0, random)
    out = _direction(path, metres, start[2])
    back = _direction(path[::-1], [length - each for each in metres[::-1]], goal[2] + math.pi) + math.pi
    found = [Moment(0.0, start), Moment(varied(robot.planning, random), start)]

    def then(seconds: float, at: Pose) -> None:
        found.append(Moment(found[-1].after + seconds, at))

    then(pace * _angle(start[2], out) / robot.turning, (*start[:2], out))
    waits_at = random.uniform(0.2, 0.8) * length if random.random() < WAITS else math.inf
    passed = 0.0
    for (a, b), reached in zip(zip(path, path[1:]), metres[1:]):
        seconds = _seconds_until(reached, length, robot) * pace
        then(seconds - passed, (*b, math.atan2(b[1] - a[1], b[0] - a[0])))
        passed = seconds
        if reached >= waits_at:
            then(random.uniform(*WAIT), found[-1].at)
            waits_at = math.inf
    then(pace * _angle(back, goal[2]) / robot.turning, goal)
    return found


def pose_after(seconds: float, moments: Sequence[Moment]) -> Pose:
    """Where the robot is then."""
    for before, after in zip(moments, moments[1:]):
        if seconds < after.after:
            share = (seconds - before.after) / (after.after - before.after)
            turn = math.remainder(after.at[2] - before.at[2], math.tau)
            (x, y, yaw), (u, v, _) = before.at, after.at
            return x + share * (u - x), y + share * (v - y), yaw + share * turn
    return moments[-1].at


def _direction(path: Sequence[Point], metres: Sequence[float], none: float) -> float:
    """In which direction a path begins; `none` where it is too short for one."""
    for (x, y), reached in zip(path, metres):
        if reached >= min(AHEAD, max(metres)) > 0.0:
            return math.atan2(y - path[0][1], x - path[0][0])
    return none


def _angle(a: float, b: float) -> float:
    return abs(math.remainder(b - a, math.tau))


def _seconds_until(metres: float, length: float, robot: Nature) -> float:
    """When so much of a path of this length is behind a robot that speeds up, drives and slows down."""
    top = min(robot.speed, math.sqrt(length * robot.acceleration))
    ramp = top * top / (2 * robot.acceleration)
    if metres <= ramp:
        return math.sqrt(2 * metres / robot.acceleration)
    if metres <= length - ramp:
        return top / robot.acceleration + (metres - ramp) / top
    whole = 2 * top / robot.acceleration + (length - 2 * ramp) / top
    return whole - math.sqrt(2 * max(0.0, length - metres) / robot.acceleration)
