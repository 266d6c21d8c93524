"""The map: every place and connection is on it, and it can be read."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from typing import Dict, List

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.scenario import Pose
from pursue_gen.report.map_svg import draw

TEXT = """
poi "hall" poi "shop" poi "yard"
connect hall and shop distance 3
connect shop and yard distance 17
event "meet" location hall
agent "bot" controllable mobile 1 location hall can_do meet
agent "cat" mobile 1 location hall
reach_objective: do meet after 0
"""
SCENARIO = parse(TEXT, "house.pur", "house")
SVG = "{http://www.w3.org/2000/svg}"


def poses(*points: "tuple[float, float]") -> Dict[str, Pose]:
    return {poi.name: Pose(x, y, 0, 0, 0, 0, 1) for poi, (x, y) in zip(SCENARIO.pois, points)}


def texts(svg: str) -> List[str]:
    return [element.text or "" for element in ElementTree.fromstring(svg).iter(f"{SVG}text")]


def test_places_distances_and_agents_are_named() -> None:
    said = texts(draw(SCENARIO, poses((0, 0), (3, 0), (3, 2)), False))
    assert sorted(said) == sorted(["hall", "shop", "yard", "3", "17", "bot", "cat"])


def test_it_says_when_positions_are_computed() -> None:
    assert "positions computed from the distances" in texts(draw(SCENARIO, poses((0, 0), (3, 0), (3, 2)), True))


def test_north_is_up() -> None:
    circles = list(ElementTree.fromstring(draw(SCENARIO, poses((0, 0), (0, 5), (1, 1)), False)).iter(f"{SVG}circle"))
    south, north = circles[0], circles[1]
    assert float(north.attrib["cy"]) < float(south.attrib["cy"])


COORDINATE = st.floats(-1e4, 1e4)


@given(st.tuples(*[st.tuples(COORDINATE, COORDINATE)] * 3))
def test_every_place_is_on_the_paper(points: "tuple[tuple[float, float], ...]") -> None:
    root = ElementTree.fromstring(draw(SCENARIO, poses(*points), False))
    width, height = map(float, root.attrib["viewBox"].split()[2:])
    for circle in root.iter(f"{SVG}circle"):
        assert 0 <= float(circle.attrib["cx"]) <= width and 0 <= float(circle.attrib["cy"]) <= height
