"""What is doubtful about the poses of a scenario: each is sound, but together they cannot be meant."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import Dict, Iterator, List, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, warning
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Connection, Pose, Scenario
from pursue_gen.language.times import written_time

_SAME = 0.1
"""Metres below which two poses are one: no robot is that small."""
_FACTOR = 8.0
"""How often as long as another way, for its distance, a way may be: more than detours and whole numbers explain."""
_SOME = 5  # places that a message lists


def check_poses(scenario: Scenario) -> Iterator[Diagnostic]:
    """Warnings about poses that no robot needs, that are used twice, that are missing, that contradict distances."""
    yield from _needless(scenario)
    yield from _shared(scenario)
    yield from _missing(scenario)
    yield from _distances(scenario)


def _needless(scenario: Scenario) -> Iterator[Diagnostic]:
    robots = {agent.name for agent in scenario.agents if agent.is_robot}
    for poi in scenario.pois:
        for spot in poi.spots:
            if spot.robot.name not in robots:
                message = f"{spot.robot.name} is not a robot: nothing is sent to its pose at {poi.name}"
                yield warning("PML122", message, spot.robot.span, "delete the pose, or name a controllable agent")


@dataclass(frozen=True)
class _Given:
    """A pose as the author gave it: of a place (`robot` empty), or of one robot there."""

    poi: str
    robot: str
    pose: Pose
    span: Span

    def __str__(self) -> str:
        return f"{self.robot} at {self.poi}" if self.robot else self.poi


def _shared(scenario: Scenario) -> Iterator[Diagnostic]:
    """Poses of two places, or of two robots at one place, that are nearly equal."""
    cells: Dict[Tuple[int, ...], List[_Given]] = {}
    for one in _given(scenario):
        cell = tuple(math.floor(number / _SAME) for number in (one.pose.x, one.pose.y, one.pose.z))
        around = product(*(range(number - 1, number + 2) for number in cell))
        candidates = (other for key in around for other in cells.get(key, ()))
        first = next((other for other in candidates if _collide(one, other)), None)
        if first is not None:
            hint = "robots there would stand in each other's way: give each place, and each robot there, its own pose"
            yield warning("PML123", f"{one} has the same pose as {first}", one.span, hint)
        cells.setdefault(cell, []).append(one)


def _given(scenario: Scenario) -> List[_Given]:
    """The poses that some robot may be sent to: a place's own only where a robot has none of its own."""
    present = robots_at(scenario)
    found = []
    for poi in scenario.pois:
        own = [_Given(poi.name, spot.robot.name, spot.pose, spot.robot.span) for spot in poi.spots]
        if poi.pose is not None and not {one.robot for one in own}.issuperset(present[poi.name] or {""}):
            found.append(_Given(poi.name, "", poi.pose, poi.span))
        found += own
    return found


def _collide(one: _Given, other: _Given) -> bool:
    """Are two robots sent there? A robot may have the same pose at two places, if it has them alone."""
    alone = bool(one.robot) and one.robot == other.robot
    return not alone and _metres(one.pose, other.pose) < _SAME


def _missing(scenario: Scenario) -> Iterator[Diagnostic]:
    missing = [poi for poi in scenario.pois if poi.pose is None]
    if missing and len(missing) < len(scenario.pois):
        names = ", ".join(poi.name for poi in missing[:_SOME]) + (", …" if len(missing) > _SOME else "")
        has = "has no pose" if len(missing) == 1 else "have no poses"
        message = f"{names} {has}, but other places do: robots would be sent to computed positions there"
        hint = "write a pose behind each place: //[x, y, z, qx, qy, qz, qw]"
        yield warning("PML124", message, missing[0].span, hint)


def _distances(scenario: Scenario) -> Iterator[Diagnostic]:
    """Ways whose distance, compared with the straight line between their poses, is of another unit than the others'.

    A way is compared with the one in the middle of all; of two, the second with the first.
    """
    poses: Dict[str, Optional[Pose]] = {poi.name: poi.pose for poi in scenario.pois}
    lines: List[Tuple[float, Connection]] = []
    for way in scenario.connections:
        a, b = poses.get(way.a), poses.get(way.b)
        if a is not None and b is not None and way.by is None and way.distance > 0 and _metres(a, b) >= _SAME:
            lines.append((_metres(a, b), way))
    if len(lines) < 2:
        return
    scales = sorted(lines, key=lambda line: line[0] / line[1].distance)
    middle = lines[0] if len(lines) == 2 else scales[len(scales) // 2]
    usual = middle[0] / middle[1].distance
    for metres, way in lines:
        scale = metres / way.distance
        if not 1 / _FACTOR < scale / usual < _FACTOR:
            message = f"{_line(metres, way)}, but {_line(*middle)}: these are not of one unit"
            hint = "correct the distance or the poses: all distances are of one unit, and poses are in metres"
            yield warning("PML125", message, way.span, hint)


def _line(metres: float, way: Connection) -> str:
    return f"{way.a} and {way.b} are {metres:.1f} m apart at distance {written_time(way.distance)}"


def _metres(a: Pose, b: Pose) -> float:
    return math.dist((a.x, a.y, a.z), (b.x, b.y, b.z))
