"""The map: every place and connection is on it, and it can be read."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from typing import Dict, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.look import QUIET
from pursue_gen.drawing.map_svg import draw
from pursue_gen.language import parse
from pursue_gen.language.scenario import Pose, Scenario

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
    assert {"hall", "shop", "yard", "3", "17", "bot", "cat"} <= set(said)


def test_what_happens_where_and_who_can_do_what_is_reported() -> None:
    said = texts(draw(SCENARIO, poses((0, 0), (3, 0), (3, 2)), False))
    assert "⚙ meet" in said
    assert any("bot: a robot" in words and "can do meet" in words for words in said)
    assert any("cat: not controlled" in words for words in said)


def test_ways_and_events_that_are_not_always_open_are_marked() -> None:
    limited = TEXT.replace("distance 17", "distance 17 only_if no agent at hall").replace(
        '"meet" location hall', '"meet" location hall only_if cat on_way'
    )
    svg = draw(parse(limited, "house.pur", "house"), poses((0, 0), (3, 0), (3, 2)), False)
    assert {"17 ?", "3"} <= set(texts(svg)) and svg.count('stroke-dasharray="7 5"') == 1
    assert "Between shop and yard only while no agent is at hall" in texts(svg)
    assert "meet only while cat is on its way" in texts(svg)


def test_a_floor_plan_lies_under_everything_where_its_yaml_says() -> None:
    floor = Floor("data:image/png;base64,", 100, 50, 0.1, -2.0, -1.0, 0.0)
    picture = ElementTree.fromstring(draw(SCENARIO, poses((-2, -1), (8, -1), (8, 4)), False, floor))
    group = next(picture.iter(f"{SVG}image"))
    box = next(group_of for group_of in picture.iter(f"{SVG}g"))
    left, bottom = (float(n) for n in re.findall(r"translate\(([-\d.]+) ([-\d.]+)\)", box.attrib["transform"])[0])
    first, second, third = (
        (float(c.attrib["cx"]), float(c.attrib["cy"]))
        for c in picture.iter(f"{SVG}circle")
        if c.get("class") == "pg-poi"
    )
    assert (left, bottom) == pytest.approx(first, abs=0.02)
    assert float(group.attrib["width"]) == pytest.approx(second[0] - first[0], abs=0.02)
    assert float(group.attrib["height"]) == pytest.approx(second[1] - third[1], abs=0.02)


def test_ways_are_drawn_along_their_paths_on_a_floor_plan() -> None:
    paths = {("hall", "shop"): ((0.0, 0.0), (0.0, 3.0), (4.0, 3.0), (4.0, 0.0))}
    floor = Floor("data:image/png;base64,", 60, 60, 0.1, -1.0, -1.0, 0.0, paths)
    picture = ElementTree.fromstring(draw(SCENARIO, poses((0, 0), (4, 0), (4, 4)), False, floor))
    (line,) = picture.iter(f"{SVG}polyline")
    points = [tuple(map(float, point.split(","))) for point in line.attrib["points"].split()]
    one = points[1][1] - points[0][1]  # 3 m, upwards
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(points, points[1:])]
    assert one < 0 and steps == [pytest.approx(step, abs=0.02) for step in ((0, one), (-4 / 3 * one, 0), (0, -one))]
    (length,) = (words for words in picture.iter(f"{SVG}text") if words.text == "3")
    middle = (points[1][0] + points[2][0]) / 2, points[1][1] + 5
    assert (float(length.attrib["x"]), float(length.attrib["y"])) == pytest.approx(middle, abs=0.02), "half way on it"
    assert sum(one.get("class") == "pg-way" for one in picture.iter(f"{SVG}line")) == 1, "of the other none is known"


def test_spots_beside_a_place_get_the_marks_of_their_robots() -> None:
    where = poses((0, 0), (3, 0), (3, 2))
    plain = draw(SCENARIO, where, False)
    assert draw(SCENARIO, where, False, spots={"bot": where}) == plain
    moved = {**where, "hall": replace(where["hall"], y=1.0)}
    circles = [drawn.count("<circle") for drawn in (plain, draw(SCENARIO, where, False, spots={"bot": moved}))]
    assert circles[1] == circles[0] + 1


def test_two_runs_draw_the_same() -> None:
    where = poses((0, 0), (3, 0), (3, 2))
    assert draw(SCENARIO, where, True) == draw(SCENARIO, where, True)


def test_it_says_when_positions_are_computed() -> None:
    assert "positions computed from the distances" in texts(draw(SCENARIO, poses((0, 0), (3, 0), (3, 2)), True))


def arrows(scenario: Scenario) -> List[List[List[float]]]:
    """The corners of each arrow, its tip first; agents' marks are polygons too, of other colours."""
    picture = ElementTree.fromstring(draw(scenario, poses((0, 0), (9, 0), (3, 2)), False))
    heads = [one for one in picture.iter(f"{SVG}polygon") if one.attrib["fill"] == QUIET]
    return [[[float(x) for x in corner.split(",")] for corner in one.attrib["points"].split()] for one in heads]


def test_a_way_that_goes_one_way_is_an_arrow_to_its_second_place() -> None:
    way, *others = SCENARIO.connections
    ((tip, *back),) = arrows(replace(SCENARIO, connections=(replace(way, one_way=True), *others)))
    ((other, *behind),) = arrows(replace(SCENARIO, connections=(replace(way, a=way.b, b=way.a, one_way=True), *others)))
    assert all(x < tip[0] for x, _ in back) and all(x > other[0] for x, _ in behind)
    assert tip[0] > other[0] and arrows(SCENARIO) == []


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


def test_nothing_covers_anything_where_much_happens_and_many_start() -> None:
    events = "".join(f'event "e{k}" location hall duration 2 ' for k in range(9))
    doing = ", ".join(f"e{k}" for k in range(9))
    agents = "".join(f'agent "bot{k}" controllable location hall can_do {doing} ' for k in range(9))
    many = parse(f'poi "hall" {events} {agents} reach_objective: do e1 after 0', "many.pur", "many")
    picture = ElementTree.fromstring(draw(many, {"hall": Pose(0, 0, 0, 0, 0, 0, 1)}, True))
    shift = sum(float(g.attrib["transform"].split()[1][:-1]) for g in picture.iter(f"{SVG}g"))
    rows = sorted(float(words.attrib["y"]) for words in picture.iter(f"{SVG}text"))
    assert rows[0] + shift > 12 and all(low - high > 11 for high, low in zip(rows, rows[1:]))


def test_labels_at_the_rim_have_room() -> None:
    text = TEXT.replace('poi "shop"', 'poi "shop" label "the shop of the porters"').replace(
        'event "meet"', 'event "meet" label "meet whoever comes by"'
    )
    scenario = parse(text.replace('agent "bot"', 'agent "bot" label "Porter 1 of the hall"'), "house.pur", "house")
    picture = ElementTree.fromstring(draw(scenario, poses((0, 0), (3, 0), (9, 4)), False))
    width = float(picture.get("width", 0))
    words = [words for words in picture.iter(f"{SVG}text") if words.get("text-anchor") == "middle"]
    assert {"the shop of the porters", "⚙ meet whoever comes by", "Porter 1 of the hall"} <= {w.text for w in words}
    for one in words:
        half = 3.5 * len(one.text or "")
        assert half < float(one.get("x", 0)) < width - half, one.text
