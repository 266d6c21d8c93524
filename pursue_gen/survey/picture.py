"""A picture of a survey: the map with the paths of all ways, the places, and where robots stand."""

from __future__ import annotations

import math
from typing import Iterator, Mapping, Optional, Tuple

from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.layout import yaw_of
from pursue_gen.drawing.look import ACCENT, INK, PAPER, QUIET, AgentLook, agent_looks, svg, tag, text
from pursue_gen.drawing.map_svg import Paper, first_part
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.survey.make import Survey, SurveyedWay

_WIDTH = 900.0
_ROW = 20.0
_SMALLEST = 3.0  # pixels of a robot


def drawn(scenario: Scenario, survey: Survey, floor: Floor, radius: float) -> str:
    """The picture as an SVG document; `scenario` is the one that was surveyed, `radius` that of the robots (metres).

    A way that is missing in the scenario is dashed. Circles are as large as robots; a line in each shows its direction.
    """
    poses = {poi.name: poi.pose for poi in scenario.pois if poi.pose is not None}
    paper = Paper(poses, floor, _WIDTH, 30.0)
    looks = agent_looks([agent.name for agent in scenario.agents])
    body = [paper.floor(floor)]
    body += [part for way in survey.ways for part in _way(way, paper)]
    spots = list(_spots(scenario, survey, looks))
    size = max(_SMALLEST, radius * paper.scale)
    for name, look, pose, place in spots:
        body += _robot(paper, pose, size, look.colour)
        x, y = paper.point(pose.x, pose.y)
        right = place is None or pose.x >= place.x  # the name is on the side away from the place
        at, anchor = (x + size + 4, "start") if right else (x - size - 4, "end")
        body.append(text(at, y + 4, name, "pg-small pg-halo", anchor))
    circles = [paper.point(pose.x, pose.y) for _, _, pose, _ in spots]
    for name, pose in poses.items():
        body += _robot(paper, pose, size, ACCENT)
        x, y = paper.point(pose.x, pose.y)
        above = all(math.dist((x, y - size - 10), circle) > size + 10 for circle in circles)
        body.append(text(x, y - size - 5 if above else y + size + 16, scenario.shown(name), "pg-strong pg-halo"))
    note = f"circles: robots with a radius of {radius:g} m; dashed: ways that the scenario did not have"
    body.append(text(30, paper.height + 5, note, "pg-small", "start"))
    title, words = f"Survey of {scenario.name}", f"{len(poses)} places, {len(survey.ways)} ways"
    return svg(_WIDTH, paper.height + _ROW, title, words, body)


def _way(way: SurveyedWay, paper: Paper) -> Iterator[str]:
    """The path, and its length where it is half way."""
    if way.metres is None or len(way.line) < 2:
        return
    points = [paper.point(x, y) for x, y in way.line]
    line = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
    dash = "7 5" if way.given is None else None
    yield tag("polyline", points=line, fill="none", stroke=QUIET, stroke_width=2.5, stroke_dasharray=dash)
    x, y = first_part(points, 0.5)[-1]
    yield text(x, y - 5, f"{way.metres:.1f} m", "pg-small pg-halo")


def _spots(
    scenario: Scenario, survey: Survey, looks: Mapping[str, AgentLook]
) -> Iterator[Tuple[str, AgentLook, Pose, Optional[Pose]]]:
    """The spots of robots, given ones and new ones, with the poses of their places."""
    for poi in scenario.pois:
        given = {spot.robot.name: spot.pose for spot in poi.spots}
        for robot, pose in {**given, **survey.spots.get(poi.name, {})}.items():
            if robot in looks:
                yield scenario.shown(robot), looks[robot], pose, poi.pose


def _robot(paper: Paper, pose: Pose, size: float, colour: str) -> Iterator[str]:
    """A robot as a circle of its size (pixels), with a line in the direction in which it looks."""
    (x, y), yaw = paper.point(pose.x, pose.y), yaw_of(pose)
    yield tag("circle", cx=x, cy=y, r=size, fill=PAPER, fill_opacity=0.7, stroke=colour, stroke_width=2)
    ahead = {"x2": x + size * math.cos(yaw), "y2": y - size * math.sin(yaw)}
    yield tag("line", x1=x, y1=y, **ahead, stroke=INK, stroke_width=1.5)
