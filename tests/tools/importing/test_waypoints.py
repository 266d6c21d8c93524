"""`pursue-gen import` of lists of places: names and poses in the shapes that people have are places of a scenario."""

from __future__ import annotations

import math
from pathlib import Path
from typing import List, Sequence, Tuple

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.tools.importing.waypoints import neighbours, read_waypoints, waypoints_text, yawed
from tests.cli.test_commands import pursue
from tests.test_pages import ROOT

LEFT = "orientation: {x: 0.0, y: 0.0, z: 0.7071, w: 0.7071}"
MARKERS = """\
markers:
  -
    header: {frame_id: "map"}
    ns: "waypoints"
    id: 0
    type: 0
    pose:
      position: {x: 1.0, y: 2.0, z: 0.0}
      orientation: {x: 0.0, y: 0.0, z: 0.7071, w: 0.7071}
    scale: {x: 1.0, y: 0.1, z: 0.1}
    points: []
    text: ''
  -
    ns: "names"
    id: 1
    type: 9
    pose: {position: {x: 1.0, y: 2.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}
    points: []
    text: "a"
  -
    ns: "route"
    id: 2
    type: 4
    pose: {position: {x: 7.0, y: 7.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}
    points: [{x: 1.0, y: 2.0, z: 0.0}, {x: 3.0, y: 4.0, z: 0.0}]
    text: ''
---
markers: []
---
"""

SHAPES = {
    "lists.yaml": "a: [1, 2, 1.5708]\n",
    "no_yaw.yaml": "a: [1, 2]\n",
    "seven.yaml": "a: [1, 2, 0, 0, 0, 0.7071, 0.7071]\n",
    "fields.yaml": "a: {x: 1, y: 2, theta: 1.5708}\n",
    "poses.yaml": f"- name: a\n  pose:\n    position: {{x: 1, y: 2, z: 0}}\n    {LEFT}\n",
    "below.yaml": f"frame_id: map\nwaypoints:\n  - name: a\n    position: {{x: 1, y: 2, z: 0}}\n    {LEFT}\n",
    "stamped.yaml": f"a:\n  header: {{seq: 1}}\n  pose:\n    pose:\n      position: {{x: 1, y: 2}}\n      {LEFT}\n",
    "nav2.yaml": "waypoints:\n  a:\n    pose: [1, 2, 0]\n    orientation: [0.7071, 0, 0, 0.7071]\n",
    "goal.yaml": f"a:\n  target_pose:\n    pose:\n      position: {{x: 1, y: 2, z: 0}}\n      {LEFT}\n",
    "markers.yaml": MARKERS,
    "titled.csv": "name,x,y,yaw\na,1,2,1.5708\n",
    "degrees.csv": "label;pos_x;pos_y;yaw_deg\na;1;2;90\n",
    "quaternion.csv": "x,y,z,qx,qy,qz,qw,name\n1,2,0,0,0,0.7071,0.7071,a\n",
    "plain.csv": "# place, x, y, yaw\na,1,2,1.5708\n",
    "tabs.csv": "a\t1\t2\t1.5708\n",
    "echo.csv": "%time,name,pose.position.x,pose.position.y,pose.orientation.z,pose.orientation.w\n"
    "1,a,1,2,0.7071,0.7071\n",
}


@pytest.mark.parametrize("name", SHAPES)
def test_each_shape_is_read(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(SHAPES[name])
    (place,) = read_waypoints(tmp_path / name)
    turned = yawed(0 if name == "no_yaw.yaml" else math.pi / 2)
    assert (place.name, place.x, place.y, place.z) == ("a", 1, 2, 0)
    assert place.orientation == pytest.approx(turned, abs=1e-4)


PLACES = 'desk: [1.0, 1.0]\nhall: [6.0, 2.5, 0]\n"Room 4": [11.0, 5.0, 1.5708]\n'


def imported(tmp_path: Path, *options: str) -> str:
    (tmp_path / "places.yaml").write_text(PLACES)
    made = pursue("import", tmp_path / "places.yaml", "-o", tmp_path / "made.pur", "--force", *options)
    assert made.status == 0, made.err
    return (tmp_path / "made.pur").read_text()


def test_neighbours_are_connected_where_that_is_wanted(tmp_path: Path) -> None:
    text = imported(tmp_path, "--connect", "--robots", "bot1, desk", "--speed", "bot1=0.4", "--traffic")
    scenario = parse(text, "made.pur")
    assert [(each.a, each.b, float(each.distance)) for each in scenario.connections] == [
        ("desk", "hall", 5.2), ("hall", "Room_4", 5.6)
    ]  # fmt: skip
    assert 'poi "Room_4" label "Room 4" //[11.000, 5.000, 0.000, 0, 0, 0.70710' in text
    assert 'agent "bot1" controllable speed 0.4 location desk\n' in text
    assert 'agent "desk1" label "desk" controllable speed 0.5 location hall\n' in text
    assert "every way holds 1 robot" in text and "patrol desk, hall, Room_4 by any robot" in text
    assert not check(scenario)


def test_ways_are_measured_on_the_map(tmp_path: Path) -> None:
    pytest.importorskip("scipy")
    assert "connect" not in imported(tmp_path)
    copy = tmp_path / "surveyed.pur"
    surveyed = pursue("survey", ROOT / "docs/survey/three_rooms.yaml", tmp_path / "made.pur", "--ways", "-o", copy)
    assert surveyed.status == 0, surveyed.err
    assert "connect desk and hall distance 7.7" in copy.read_text()
    assert pursue("solve", copy).status == 0


@pytest.mark.parametrize(
    ("name", "text", "place", "what"),
    [
        ("x.yaml", "a: [1, 2, north]\n", ":1:11:", "a number is expected"),
        ("x.yaml", "a: [1, 2]\nb: [1, 2, 3, 4, 5]\n", ":2:4:", "a pose of 5 numbers"),
        ("x.yaml", "a: [1, 2, 0, 0, 0, 0, 0]\n", ":1:4:", "length 1"),
        ("x.yaml", "a: {position: {x: 1}}\n", ":1:4:", "a position of x, y and z"),
        ("x.yaml", "a: {pose: {x: 1}}\n", ":1:4:", "position and orientation are expected"),
        ("x.yaml", "a: [.nan, 0]\n", ":1:", ""),
        ("x.yaml", "a: [1.0e+9, 0]\n", ":1:4:", "1,000 km"),
        ("x.yaml", "a: 3\n", ":1:1:", "no place with a pose"),
        ("x.yaml", "", ":1:1:", "no place with a pose"),
        ("x.yaml", "a: [1, 2\n", ":", "not YAML"),
        ("x.yaml", "".join(f"p{k}: [{k}, 0]\n" for k in range(501)), ":1:1:", "501 places"),
        ("x.csv", "name,x,y\na,1,2\nb,1,two\n", ":3:1:", "not 'two'"),
        ("x.csv", "a,1\n", ":1:1:", "a pose of 1 numbers"),
        ("x.csv", "\n", ":1:1:", "no place with a pose"),
    ],
)
def test_what_is_wrong_has_a_place(tmp_path: Path, name: str, text: str, place: str, what: str) -> None:
    (tmp_path / name).write_text(text)
    made = pursue("import", tmp_path / name, "-o", tmp_path / "made.pur", "--connect")
    assert made.status == 2 and not (tmp_path / "made.pur").exists()
    assert f"{name}{place}" in made.err and "IMP005" in made.err and what in made.err


def test_more_robots_than_places_and_ways_of_buildings_are_usage_errors(tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text("a: [1, 2]\n")
    (tmp_path / "y.yaml").write_text("levels: {}\n")
    for options in (("x.yaml", "--robots", "r1,r2"), ("x.yaml", "--speed", "r9=1"), ("y.yaml", "--connect")):
        made = pursue("import", tmp_path / options[0], "-o", tmp_path / "made.pur", *options[1:])
        assert made.status == 2 and "CLI004" in made.err


_POINT = st.tuples(st.integers(-50, 50), st.integers(-50, 50), st.just(0))
_POINTS = st.lists(_POINT, min_size=1, max_size=12, unique=True)


@given(_POINTS)
def test_neighbours_lead_everywhere(points: List[Tuple[int, int, int]]) -> None:
    pairs, found = list(neighbours(points)), {0}
    for _ in points:
        found |= {b for a, b in pairs if a in found} | {a for a, b in pairs if b in found}
    assert found == set(range(len(points)))


@settings(deadline=None)
@given(st.lists(st.text(max_size=12), min_size=2, max_size=6, unique=True), _POINTS)
def test_whatever_places_are_called_the_scenario_is_sound(
    tmp_path_factory: pytest.TempPathFactory, names: Sequence[str], points: List[Tuple[int, int, int]]
) -> None:
    file = tmp_path_factory.mktemp("places") / "places.yaml"
    file.write_text(yaml.safe_dump([{"name": n, "x": p[0], "y": p[1]} for n, p in zip(names, points)]))
    places = read_waypoints(file)
    scenario = parse(waypoints_text("p.yaml", places, {"bot": 0.5}, "p.pur", True, False), "p.pur")
    assert len(scenario.pois) == len(places) and not [each for each in check(scenario) if len(places) > 1]
