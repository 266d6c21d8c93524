"""Places and spots against a map of map_server: outside, in an obstacle, unknown, free."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import List, Tuple

import pytest

from pursue_gen.drawing.ground import Ground, read_ground
from pursue_gen.language import parse
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import check_spots
from pursue_gen.workspace.robot_size import RobotSize, Sizes, sizes_of
from tests.tools.authoring.commands import pursue

WALL, UNKNOWN, FREE = 0, 205, 254
ROWS = [
    [WALL, WALL, WALL, WALL],
    [WALL, FREE, FREE, UNKNOWN],
    [WALL, FREE, FREE, UNKNOWN],
]
CELL = [[WALL, WALL, WALL], [WALL, FREE, WALL], [WALL, WALL, WALL]]
YAML = "image: floor.pgm\nresolution: 1.0\norigin: [10, 20, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def floor_of(folder: Path, yaml: str = YAML, rows: List[List[int]] = ROWS) -> Ground:
    pixels = bytes(grey for row in rows for grey in row)
    (folder / "floor.pgm").write_bytes(b"P5 %d %d 255\n" % (len(rows[0]), len(rows)) + pixels)
    (folder / "map.yaml").write_text(yaml)
    return read_ground(folder / "map.yaml")


def told(floor: Ground, behind: str, robots: int = 1, distance: float = 1.0) -> List[str]:
    text = f'poi "a" {behind}\nevent "work"\n'
    text += "".join(f'agent "bot{k}" controllable mobile 1 location a can_do work\n' for k in range(1, robots + 1))
    found = check_spots(parse(text + "reach_objective: do work\n", "test.pur"), (Level(floor),), distance)
    assert all(finding.span is not None and finding.hint for finding in found)
    return [finding.message for finding in found if finding.code == "WSP008"]


@pytest.mark.parametrize(
    ("x", "y", "what"),
    [
        (11.5, 20.5, ""),
        (12.9, 21.9, ""),
        (11.5, 22.1, "is in an obstacle of the map"),
        (10.5, 20.5, "is in an obstacle of the map"),
        (13.5, 21.5, "is unknown to the map"),
        (9.9, 20.5, "is off the map"),
        (14.1, 20.5, "is off the map"),
        (11.5, 23.1, "is off the map"),
        (11.5, 19.9, "is off the map"),
    ],
)
def test_a_pose_is_looked_up_where_map_server_has_it(tmp_path: Path, x: float, y: float, what: str) -> None:
    expected = [f"the pose of a ({x:g}, {y:g}) {what}"] if what else []
    assert told(floor_of(tmp_path), f"//[{x}, {y}, 0, 0, 0, 0, 1]") == expected


def test_the_settings_of_the_map_count(tmp_path: Path) -> None:
    pose = "//[11.5, 20.5, 0, 0, 0, 0, 1]"
    assert "obstacle" in told(floor_of(tmp_path, YAML.replace("negate: 0", "negate: 1")), pose)[0]
    grey = [[100, 100], [100, 100]]  # darkness 0.61
    assert "unknown" in told(floor_of(tmp_path, rows=grey), "//[10.5, 20.5, 0, 0, 0, 0, 1]")[0]
    lower = YAML.replace("0.65", "0.5")
    assert "obstacle" in told(floor_of(tmp_path, lower, grey), "//[10.5, 20.5, 0, 0, 0, 0, 1]")[0]
    turned = floor_of(tmp_path, YAML.replace("20, 0]", f"20, {math.pi / 2!r}]"))
    assert told(turned, "//[9.5, 21.5, 0, 0, 0, 0, 1]") == [] and "off the map" in told(turned, pose)[0]


def test_the_spots_of_robots_are_checked_too(tmp_path: Path) -> None:
    pose = "//[11.5, 21.5, 0, 0, 0, 0, 1]"  # beside it on the left is the wall, on the right there is room
    assert told(floor_of(tmp_path), pose, robots=3) == []
    (own,) = told(floor_of(tmp_path), f"{pose} bot2 [9, 9, 0, 0, 0, 0, 1]", robots=2)
    assert own == "the spot of bot2 at a (9, 9) is off the map"
    left = told(floor_of(tmp_path, rows=CELL), pose, robots=2)
    assert left == ["the spot of bot2 at a (11.5, 22.5) is in an obstacle of the map"]
    assert told(floor_of(tmp_path, rows=CELL), pose, robots=2, distance=0.4) == []


def test_the_pose_of_a_place_to_which_no_robot_is_sent_does_not_count(tmp_path: Path) -> None:
    free = "[11.5, 21.5, 0, 0, 0, 0, 1]"
    assert told(floor_of(tmp_path), f"//[0, 0, 0, 0, 0, 0, 1] bot1 {free}") == []
    assert told(floor_of(tmp_path), "//[0, 0, 0, 0, 0, 0, 1]", robots=0) != []


def test_a_place_without_a_pose_is_left_out(tmp_path: Path) -> None:
    assert told(floor_of(tmp_path), "", robots=2) == []


ROOM = [[WALL] * 80, *[[WALL] + [FREE] * 78 + [WALL] for _ in range(48)], [WALL] * 80]
"""8 m by 5 m, in cells of 0.1 m; the walls are 0.1 m thick."""
ROOM_YAML = YAML.replace("1.0\n", "0.1\n").replace("[10, 20, 0]", "[0, 0, 0]")


def found_in(floor: Ground, poses: str, robot: RobotSize, robots: int = 2) -> List[Tuple[str, str, str]]:
    """Codes, messages and hints of places with these comments, for robots that may be at all of them."""
    names = "abc"[: len(poses.splitlines())]
    text = "".join(f'poi "{name}" //{pose}\n' for name, pose in zip(names, poses.splitlines()))
    text += "".join(f"connect {a} and {b} distance 3\n" for a, b in zip(names, names[1:])) + 'event "work"\n'
    text += "".join(f'agent "bot{k}" controllable mobile 1 location a can_do work\n' for k in range(1, robots + 1))
    findings = check_spots(parse(text + "reach_objective: do work\n", "test.pur"), (Level(floor),), 0.8, Sizes(robot))
    return [(finding.code, finding.message, finding.hint) for finding in findings]


def test_a_robot_needs_room_to_stop_within_its_tolerance_and_to_turn(tmp_path: Path) -> None:
    floor = floor_of(tmp_path, ROOM_YAML, ROOM)
    too_near, tight = "is nearer than 0.2 m, the robots' radius", "is 0.30 m from an obstacle: to stop"
    for x, told in ((0.25, too_near), (0.35, tight), (0.45, "")):
        found = found_in(floor, f"[{x}, 2.55, 0, 0, 0, 0, 1]", RobotSize(0.2, 0.1), 1)
        assert len(found) == bool(told)
        for code, message, hint in found:
            assert code == "MAP003" and told in message
            assert "there is room at 0.45, 2.55, " in hint and "--robot" in hint


def test_no_part_of_a_robot_is_in_what_is_inflated_where_there_is_such_a_point_near_it(tmp_path: Path) -> None:
    floor = floor_of(tmp_path, ROOM_YAML, ROOM)
    pose = "[0.55, 2.55, 0, 0, 0, 0, 1]"
    ((code, message, hint),) = found_in(floor, pose, RobotSize(0.2, 0.1, 0.4), 1)
    assert code == "MAP003" and "0.50 m from an obstacle: a robot that stops there reaches into" in message
    assert "more than 0.7 m, its radius of 0.2 m, its goal tolerance of 0.1 m and its inflation radius of" in message
    assert hint == "there is room at 0.85, 2.55, 0.30 m from there"
    assert found_in(floor, pose, RobotSize(0.2, 0.1, 0.15), 1) == []
    assert found_in(floor, pose, RobotSize(0.2, 0.1, 3.0), 1) == [], "nowhere in the room is there such a point"


def test_two_robots_do_not_stand_in_each_other(tmp_path: Path) -> None:
    floor = floor_of(tmp_path, ROOM_YAML, ROOM)
    poses = "[2, 2, 0, 0, 0, 0, 1] bot2 [2.2, 2, 0, 0, 0, 0, 1]\n[5, 2, 0, 0, 0, 0, 1] bot1 [2, 2.3, 0, 0, 0, 0, 1]"
    found = found_in(floor, poses, RobotSize(0.17, 0.1))
    assert [code for code, _, _ in found] == ["MAP005", "MAP005"]
    assert found[0][1].startswith("the spot of bot2 at a (2.2, 2) is 0.20 m from the pose of a: two robots with")
    assert found[1][1].startswith("the spot of bot1 at b (2, 2.3) is 0.36 m from the spot of bot2 at a: ")
    for _, message, hint in found:
        x, y = map(float, re.search(r"room at ([\d.]+), ([\d.]+), ", hint).groups())  # type: ignore[union-attr]
        assert min(math.dist((x, y), one) for one in ((2, 2), (5, 2))) >= 0.54 - 1e-9 and "need 0.54 m" in message
    assert found_in(floor, poses, RobotSize(0.17, 0.1), 1) == [], "one robot is at one of them at a time"


def test_what_is_proposed_is_apart_from_what_is_proposed_for_others(tmp_path: Path) -> None:
    floor, size = floor_of(tmp_path, ROOM_YAML, ROOM), RobotSize(0.2, 0.1)
    poses = "[0.05, 2.55, 0, 0, 0, 0, 1]\n[0.05, 2.65, 0, 0, 0, 0, 1]\n[0.15, 2.6, 0, 0, 0, 0, 1]"
    found = found_in(floor, poses, size)
    there = [re.search(r"room at ([\d.]+), ([\d.]+), ", hint) for _, _, hint in found]
    points = sorted({tuple(map(float, one.groups())) for one in there if one})
    assert len(points) == 3
    for k, point in enumerate(points):
        assert all(math.dist(point, other) >= size.apart - 1e-6 for other in points[:k])
    mended = "\n".join(f"[{x}, {y}, 0, 0, 0, 0, 1]" for x, y in points)
    assert found_in(floor, mended, size, 1) == []


def test_each_spot_is_measured_against_the_robots_that_are_sent_there(tmp_path: Path) -> None:
    floor = floor_of(tmp_path, ROOM_YAML, ROOM)
    text = 'poi "a" //[2, 2, 0, 0, 0, 0, 1] small [%s, 2, 0, 0, 0, 0, 1]\nevent "work"\n'
    text += 'agent "large" controllable radius 0.5 location a can_do work\n'
    text += 'agent "small" controllable radius 0.1 tolerance 0.05 location a\nreach_objective: do work\n'

    def found(x: float) -> List[Tuple[str, str]]:
        made = parse(text % x, "test.pur")
        return [(one.code, one.message) for one in check_spots(made, (Level(floor),), 0.8, sizes_of(made))]

    assert found(0.35) == [], "the large robot has no room there, the small one has"
    ((code, message),) = found(1.3)
    assert code == "MAP005" and "radius of 0.1 m and of 0.5 m and a goal tolerance of 0.05 m and of 0.1 m" in message
    assert message.endswith("need 0.75 m") and found(1.24) == []


def test_a_spot_before_its_place_is_in_the_way_of_those_who_come(tmp_path: Path) -> None:
    floor = floor_of(tmp_path, ROOM_YAML, ROOM)
    text = 'poi "a" //[2, 2, 0, 0, 0, 0, 1] bot2 [2.9, %s, 0, 0, 0, 0, 1]\npoi "b" //[6, 2, 0, 0, 0, 0, 1]\n'
    text += 'connect a and b distance 4\nevent "work"\n'
    text += "".join(f'agent "bot{k}" controllable mobile 1 location a can_do work\n' for k in (1, 2))
    ways = {("a", "b"): [(2.0, 2.0), (6.0, 2.0)]}
    for y, told in ((2.3, True), (2.5, False)):
        made = parse(text % y + "reach_objective: do work\n", "test.pur")
        found = check_spots(made, (Level(floor, ways=ways),), 0.8, Sizes(RobotSize(0.2, 0.1)))
        assert [one.code for one in found if one.code == "MAP006"] == ["MAP006"] * told
        assert all("is 0.30 m from the way from a to b" in one.message and "need 0.4 m" in one.message for one in found)


def test_check_reports_them_with_the_other_findings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    floor_of(tmp_path, rows=CELL)
    text = 'poi "a" //[11.5, 21.5, 0, 0, 0, 0, 2]\nevent "work"\n'
    text += "".join(f'agent "{bot}" controllable mobile 1 location a can_do work\n' for bot in ("bot1", "bot2"))
    Path("two.pur").write_text(text + "reach_objective: do work\n")
    Path("bad.pur").write_text("poi\n")
    done = pursue("check", "two.pur", "--map", "map.yaml")
    assert (done.status, re.findall("warning ([A-Z0-9]+)", done.out)) == (0, ["PML120", "WSP008"])
    assert "two.pur:1:5: warning WSP008: the spot of bot2 at a (11.5, 22.3)" in done.out
    assert "move it: near it, beside all others, there is no room for a robot that needs 0.4 m" in done.out
    assert "0 errors, 2 warnings" in done.err
    assert "WSP008" not in pursue("check", "two.pur", "--map", "map.yaml", "--spot-distance", "0.4").out
    both = pursue("check", "bad.pur", "two.pur", "--map", "map.yaml", "--json")
    assert both.status == 3 and [f["code"] for f in json.loads(both.out)][-2:] == ["PML120", "WSP008"]
    missing = pursue("check", "two.pur", "--map", "none.yaml")
    assert missing.status == 2 and "none.yaml" in missing.err
