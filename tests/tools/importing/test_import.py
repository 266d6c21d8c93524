"""`pursue-gen import`: places, ways, robots and lifts of a building are those of its file; the scenario is sound."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.checks import check, checked
from pursue_gen.tools.importing.building import read_building
from pursue_gen.tools.importing.plan import floor_plan
from pursue_gen.tools.importing.scenario_text import scenario_text
from tests.cli.test_commands import pursue

# A corridor of 20 m, 100 pixels a metre, with a bend without a name, a room behind a door, and a dead end.
OFFICE = """\
name: office
levels:
  L1:
    elevation: 0
    measurements:
      - [0, 4, {distance: [3, 20]}]
    vertices:
      - [0, 1000, 0, dock, {spawn_robot_name: [1, bot 1], spawn_robot_type: [1, Tiny], is_charger: [4, true]}]
      - [500, 1000, 0, ""]
      - [1000, 1000, 0, ""]
      - [1000, 400, 0, pantry, {pickup_dispenser: [1, coke]}]
      - [2000, 1000, 0, lounge, {dropoff_ingestor: [1, ingest]}]
      - [1000, 1500, 0, ""]
      - [900, 700, 0, ""]
      - [1100, 700, 0, ""]
    lanes:
      - [0, 1, {bidirectional: [4, true], graph_idx: [2, 0]}]
      - [1, 2, {bidirectional: [4, true], graph_idx: [2, 0]}]
      - [2, 3, {bidirectional: [4, true], graph_idx: [2, 0]}]
      - [2, 4, {bidirectional: [4, false], graph_idx: [2, 0]}]
      - [4, 2, {bidirectional: [4, false], graph_idx: [2, 0]}]
      - [2, 5, {bidirectional: [4, true], graph_idx: [2, 0]}]
    doors:
      - [6, 7, {name: [1, pantry_door]}]
"""


def imported(tmp_path: Path, text: str, *options: str) -> str:
    """The scenario that the command writes for a building."""
    (tmp_path / "office.building.yaml").write_text(text)
    target = tmp_path / "made.pur"
    made = pursue("import", tmp_path / "office.building.yaml", "-o", target, *options)
    assert made.status == 0, made.err
    assert made.out.strip() == str(target)
    return target.read_text()


def test_a_building_becomes_a_scenario(tmp_path: Path) -> None:
    text = imported(tmp_path, OFFICE)
    scenario = parse(text, "made.pur")
    assert not check(scenario)
    assert [poi.name for poi in scenario.pois] == ["dock", "v2", "pantry", "lounge"]
    assert 'agent "bot_1" label "bot 1" controllable speed 0.5 location dock' in text
    assert "can_do pick_up_at_pantry, drop_off_at_lounge" in text.replace("\n    ", " ")
    assert "objective: patrol pantry, lounge by any robot" in text


def test_the_scenario_is_won(tmp_path: Path) -> None:
    imported(tmp_path, OFFICE)
    solved = pursue("solve", tmp_path / "made.pur")
    assert solved.status == 0 and "by any robot" in solved.err


def test_bends_are_no_places_and_ways_are_as_long_as_their_lanes(tmp_path: Path) -> None:
    text = imported(tmp_path, OFFICE)
    assert "connect dock and v2 distance 10\n" in text
    assert "connect v2 and pantry distance 6 through pantry_door\n" in text
    assert re.search(r'door "pantry_door" opens within 10 s +//\[[-0-9., ]+\]\n', text)
    assert "connect lounge and v2 distance 10\n" in text  # a lane in each direction


def test_poses_are_in_metres_with_y_upwards(tmp_path: Path) -> None:
    text = imported(tmp_path, OFFICE)
    assert "//[10.00, -4.00, 0.00, 0, 0, 0, 1]" in text


def test_speeds_and_robots_are_chosen(tmp_path: Path) -> None:
    second = OFFICE.replace("lounge, {", "lounge, {spawn_robot_name: [1, bot2], ")
    text = imported(tmp_path, second, "--speed", "0.7", "--speed", "bot2=0.4")
    assert 'agent "bot2" controllable speed 0.4 location lounge' in text and "speed 0.7 location dock" in text
    assert "bot_1" not in imported(tmp_path, second, "--robots", "bot2", "--force")


def test_a_graph_is_for_its_robots_and_lanes_of_others_are_left_out(tmp_path: Path) -> None:
    lanes = """\
      - [4, 3, {bidirectional: [4, true], graph_idx: [2, 1]}]
      - [3, 5, {bidirectional: [4, true], graph_idx: [2, 7]}]
    doors:"""
    second = OFFICE.replace("lounge, {", "lounge, {spawn_robot_name: [1, bot2], ").replace("    doors:", lanes)
    text = imported(tmp_path, second, "--robots", "bot 1")
    assert "11.7" not in text and " for " not in text
    text = imported(tmp_path, second, "--force")
    assert "connect pantry and lounge distance 11.7 for bot2" in text.replace("lounge and pantry", "pantry and lounge")


TOWER = """\
name: tower
coordinate_system: reference_image
levels:
  L1:
    elevation: 0
    fiducials: [[0, 0, a], [1000, 0, b]]
    measurements: [[0, 1, {distance: [3, 10]}]]
    vertices:
      - [0, 0, 0, lobby, {spawn_robot_name: [1, bot]}]
      - [1000, 0, 0, "", {lift_cabin: [1, Lift1]}]
    lanes: [[0, 1, {bidirectional: [4, true]}]]
  L2:
    elevation: 5
    fiducials: [[0, 100, a], [500, 100, b]]
    vertices:
      - [500, 100, 0, "", {lift_cabin: [1, Lift1]}]
      - [500, 350, 0, lobby, {spawn_robot_name: [1, bot2]}]
    lanes: [[0, 1, {bidirectional: [4, true]}]]
"""


def test_levels_are_joined_by_lifts_and_lie_above_each_other(tmp_path: Path) -> None:
    text = imported(tmp_path, TOWER)
    assert 'poi "Lift1_L2" //[10.00, -2.80, 5.00, 0, 0, 0, 1]' in text, "2.8 m before the middle of the cabin"
    assert "// Levels and their elevations, for maps of them (docs/survey.md): L1 0, L2 5.\n" in text
    assert "connect Lift1_L2 and lobby_L2 distance 2.2\n" in text  # half as many pixels a metre as on the first level
    lift = 'lift "Lift1" at Lift1_L1, Lift1_L2 comes within 40 s takes 10 s to 20 s //[10.00, 0.00, 0.00, 0, 0, 0, 1]\n'
    called = "{adapter: rmf, name: Lift1, floors: {Lift1_L1: L1, Lift1_L2: L2}}"
    assert f"// For door_settings: Lift1: {called}\n{lift}" in text
    assert "connect Lift1_L1 and Lift1_L2 distance 5.6 by Lift1\n" in text
    assert not check(parse(text, "made.pur")) and "at_most" not in text, "it holds one robot in any case"


def test_a_cabin_that_is_elsewhere_on_another_level_has_a_pose_there(tmp_path: Path) -> None:
    apart = TOWER.replace("fiducials: [[0, 100, a], [500, 100, b]]", "measurements: [[0, 1, {distance: [3, 5]}]]")
    text = imported(tmp_path, apart)
    assert re.search(r"//\[10\.00, 0\.00, 0\.00, 0, 0, 0, 1\] Lift1_L2 \[[-\d., ]+\]\n", text)
    assert not check(parse(text, "made.pur"))


def test_longitude_and_latitude_become_metres(tmp_path: Path) -> None:
    campus = """\
coordinate_system: wgs84
levels:
  L1:
    vertices: [[103.0, 60.0, 0, a, {spawn_robot_name: [1, bot]}], [103.001, 60.0, 0, b], [103.0, 60.001, 0, c]]
    lanes: [[0, 1, {bidirectional: [4, true]}], [0, 2, {bidirectional: [4, true]}]]
"""
    text = imported(tmp_path, campus)
    assert "connect a and b distance 55.6\n" in text and "connect a and c distance 111.2\n" in text


@pytest.mark.parametrize(
    "wrong, code, place, what",
    [
        (OFFICE.replace("[500, 1000, 0, \"\"]", "[x, 1000, 0, \"\"]"), "IMP001", ":9:10:", "a number is expected"),
        (OFFICE.replace("[2, 5, ", "[2, 8, "), "IMP001", ":22:9:", "vertices that the level does not have (it has 8)"),
        (OFFICE.replace("[1, 2, {", "[1, {"), "IMP001", ":18:", ""),
        (OFFICE.replace("    lanes:\n", "    lanes: 3\n    more:\n"), "IMP001", ":16:12:", "a list is expected"),
        (OFFICE.replace("name: office\n", "name: [\n"), "IMP001", ":3:5:", "not YAML"),
        (OFFICE.replace("    measurements:\n", "    others:\n"), "IMP002", ":4:", "how long a pixel is"),
        (OFFICE.replace("    lanes:\n", "    more:\n"), "IMP003", ":4:", "no lanes"),
        (OFFICE.replace("spawn_robot_name", "other_name"), "IMP004", ":4:", "no robot stands on a lane"),
        (OFFICE.replace("lounge, {", "lounge, {spawn_robot_name: [1, bot 1], "), "IMP004", ":12:9:", "called 'bot 1'"),
        (OFFICE.replace("[3, 20]", "[3, 1.0e+12]"), "IMP002", ":17:9:", "km long"),
        ("", "IMP001", ":1:1:", "no level"),
        ("- 1\n", "IMP001", ":1:1:", "a mapping is expected"),
    ],
)
def test_what_is_wrong_has_a_place(tmp_path: Path, wrong: str, code: str, place: str, what: str) -> None:
    (tmp_path / "office.building.yaml").write_text(wrong)
    made = pursue("import", tmp_path / "office.building.yaml", "-o", tmp_path / "made.pur")
    assert made.status == 2 and not (tmp_path / "made.pur").exists()
    assert f"office.building.yaml{place}" in made.err and code in made.err and what in made.err


@pytest.mark.parametrize(
    "options", [["--robots", "bot3"], ["--robots", ","], ["--speed", "fast"], ["--speed", "bot9=1"]]
)
def test_wrong_options_are_usage_errors(tmp_path: Path, options: List[str]) -> None:
    (tmp_path / "office.building.yaml").write_text(OFFICE)
    target = tmp_path / "made.pur"
    made = pursue("import", tmp_path / "office.building.yaml", "-o", target, *options)
    assert made.status == 2 and "CLI004" in made.err and not target.exists()


def test_what_a_building_calls_something_never_becomes_a_statement(tmp_path: Path) -> None:
    evil = r'"x\nobjective: y\\"'
    text = OFFICE.replace("name: office", f"name: {evil}").replace("Tiny", evil).replace("pantry_door", evil)
    made = parse(imported(tmp_path, text.replace("lounge,", f"{evil},").replace("bot 1", evil)), "made.pur")
    assert len(made.objectives) == len(parse(imported(tmp_path, OFFICE, "--force"), "made.pur").objectives)


def test_a_file_that_is_there_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "office.building.yaml").write_text(OFFICE)
    (tmp_path / "made.pur").write_text("mine")
    made = pursue("import", tmp_path / "office.building.yaml", "-o", tmp_path / "made.pur")
    assert made.status == 2 and "--force" in made.err and (tmp_path / "made.pur").read_text() == "mine"


NAMES = st.sampled_from(["", "", "", "lab", "Room 1", "exit", "lift", "patrol", "café", "1st", "going_up", "lab"])
POINTS = st.tuples(st.integers(0, 40), st.integers(0, 40), NAMES)


@settings(max_examples=60, deadline=None)
@given(st.lists(POINTS, min_size=2, max_size=9), st.data())
def test_any_lanes_become_a_sound_scenario_with_the_same_distances(
    tmp_path_factory: pytest.TempPathFactory, points: List[Tuple[int, int, str]], data: st.DataObject
) -> None:
    ends = st.integers(0, len(points) - 1)
    lanes = data.draw(st.lists(st.tuples(ends, ends, st.booleans(), st.integers(0, 1)), min_size=1, max_size=14))
    lanes = [lane for lane in lanes if lane[0] != lane[1]] or [(0, 1, True, 0)]
    robot = lanes[0][0]
    vertices: List[List[object]] = [[x * 10, y * 10, 0, name, {}] for x, y, name in points]
    vertices[robot][4] = {"spawn_robot_name": [1, "bot"]}
    vertices += [[0, 900, 0, "", {}], [100, 900, 0, "", {}]]
    level = {
        "vertices": vertices,
        "lanes": [[a, b, {"bidirectional": [4, both], "graph_idx": [2, graph]}] for a, b, both, graph in lanes],
        "measurements": [[len(points), len(points) + 1, {"distance": [3, 10.0]}]],
    }
    file = tmp_path_factory.mktemp("building") / "b.building.yaml"
    file.write_text(yaml.safe_dump({"levels": {"L1": level}}))
    building = read_building(file)
    plan = floor_plan(building)
    text = scenario_text(building, plan, plan.robots, {"bot": 0.5}, "made.pur")
    scenario = checked(text, "made.pur")
    graphs = {graph for a, b, _, graph in lanes if robot in (a, b)}
    # From the robot's place every place with a name is as far away as on the lanes themselves.
    nodes = {stop.node[1]: poi.name for stop, poi in zip(plan.stops, scenario.pois)}
    whole: Dict[int, List[Tuple[int, float]]] = {}
    for a, b, both, graph in lanes:
        if graph in graphs:
            metres = math.dist(points[a][:2], points[b][:2])
            whole.setdefault(a, []).append((b, metres))
            whole.setdefault(b, []).extend([(a, metres)] if both else [])
    short: Dict[str, List[Tuple[str, float]]] = {}
    for track in plan.tracks:
        start, end = nodes[track.start[1]], nodes[track.end[1]]
        short.setdefault(start, []).extend([(end, track.metres)] if track.there & graphs else [])
        short.setdefault(end, []).extend([(start, track.metres)] if track.back & graphs else [])
    far, near = distances(whole, robot), distances(short, nodes[robot])
    for k in range(len(points)):
        if points[k][2]:
            assert far.get(k, math.inf) == pytest.approx(near.get(nodes.get(k, ""), math.inf))


def distances(ways: Mapping[Any, List[Tuple[Any, float]]], start: Any) -> Dict[Any, float]:
    """The length of the shortest path to each node (Bellman and Ford)."""
    found = {start: 0.0}
    changed = True
    while changed:
        changed = False
        for node in list(found):
            for other, metres in ways.get(node, ()):
                if found[node] + metres < found.get(other, math.inf) - 1e-9:
                    found[other], changed = found[node] + metres, True
    return found



def test_with_traffic_places_and_ways_hold_one_robot(tmp_path: Path) -> None:
    second = OFFICE.replace("lounge, {", "lounge, {spawn_robot_name: [1, bot2], ")
    lines = "objective: every place holds 1 robot\nobjective: every way holds 1 robot\n"
    assert lines in imported(tmp_path, second, "--traffic")
    assert "holds" not in imported(tmp_path, second, "--force")
    assert "holds" not in imported(tmp_path, second, "--force", "--traffic", "--robots", "bot2"), "nobody to meet"


def test_robots_keep_to_what_lanes_allow(tmp_path: Path) -> None:
    slow = OFFICE.replace("[0, 1, {", "[0, 1, {speed_limit: [3, 0.25], ")
    slow = slow.replace("[2, 3, {", "[2, 3, {speed_limit: [3, 2], ")
    text = imported(tmp_path, slow)
    # five metres at 0.25 m/s, and five at 0.5.
    assert "travel bot_1 from dock to v2 takes 30 s\ntravel bot_1 from v2 to dock takes 30 s\n" in text
    assert text.count("travel") == 2 and not check(parse(text, "made.pur"))
    assert "travel" not in imported(tmp_path, slow, "--force", "--speed", "0.2")


def test_of_a_mutex_group_one_robot_has_one_lane_or_vertex(tmp_path: Path) -> None:
    second = OFFICE.replace("lounge, {", "lounge, {spawn_robot_name: [1, bot2], ")
    second = second.replace("[2, 3, {", "[2, 3, {mutex: [1, door], ")
    second = second.replace("pantry, {", "pantry, {mutex: [1, door], ")
    text = imported(tmp_path, second)
    for room in ("place pantry", "way v2 to pantry"):
        assert f"objective: {room} holds 1 robot // mutex door" in re.sub(" +", " ", text)
    both = "objective: avoid any robot at pantry and any robot between v2 and pantry\n"
    assert both in text and not check(parse(text, "made.pur"))
    traffic = imported(tmp_path, second, "--force", "--traffic")
    assert both in traffic and "mutex" not in traffic
    assert "mutex" not in imported(tmp_path, second, "--force", "--robots", "bot2"), "nobody to meet"
