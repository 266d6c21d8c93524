"""Places and spots against a map of map_server: outside, in an obstacle, unknown, free."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import List

import pytest

from pursue_gen.drawing.ground import Ground, read_ground
from pursue_gen.language import parse
from pursue_gen.workspace.map_check import check_spots
from tests.authoring.commands import pursue

WALL, UNKNOWN, FREE = 0, 205, 254
ROWS = [
    [WALL, WALL, WALL, WALL],
    [WALL, FREE, FREE, UNKNOWN],
    [WALL, FREE, FREE, UNKNOWN],
]
YAML = "image: floor.pgm\nresolution: 1.0\norigin: [10, 20, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def floor_of(folder: Path, yaml: str = YAML, rows: List[List[int]] = ROWS) -> Ground:
    pixels = bytes(grey for row in rows for grey in row)
    (folder / "floor.pgm").write_bytes(b"P5 %d %d 255\n" % (len(rows[0]), len(rows)) + pixels)
    (folder / "map.yaml").write_text(yaml)
    return read_ground(folder / "map.yaml")


def told(floor: Ground, behind: str, robots: int = 1, distance: float = 1.0) -> List[str]:
    text = f'poi "a" {behind}\nevent "work"\n'
    text += "".join(f'agent "bot{k}" controllable mobile 1 location a can_do work\n' for k in range(1, robots + 1))
    found = check_spots(parse(text + "reach_objective: do work\n", "test.pur"), floor, distance)
    assert all(finding.code == "WSP008" and finding.span is not None and finding.hint for finding in found)
    return [finding.message for finding in found]


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
    floor = floor_of(tmp_path)
    pose = "//[11.5, 21.5, 0, 0, 0, 0, 1]"  # beside it on the left is the wall, on the right there is room
    (left,) = told(floor, pose, robots=3)
    assert left == "the spot of bot2 at a (11.5, 22.5) is in an obstacle of the map"
    assert told(floor, pose, robots=2, distance=0.4) == []
    (own,) = told(floor, f"{pose} bot2 [9, 9, 0, 0, 0, 0, 1]", robots=2)
    assert own == "the spot of bot2 at a (9, 9) is off the map"


def test_the_pose_of_a_place_to_which_no_robot_is_sent_does_not_count(tmp_path: Path) -> None:
    free = "[11.5, 21.5, 0, 0, 0, 0, 1]"
    assert told(floor_of(tmp_path), f"//[0, 0, 0, 0, 0, 0, 1] bot1 {free}") == []
    assert told(floor_of(tmp_path), "//[0, 0, 0, 0, 0, 0, 1]", robots=0) != []


def test_a_place_without_a_pose_is_left_out(tmp_path: Path) -> None:
    assert told(floor_of(tmp_path), "", robots=2) == []


def test_check_reports_them_with_the_other_findings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    floor_of(tmp_path)
    text = 'poi "a" //[11.5, 21.5, 0, 0, 0, 0, 2]\nevent "work"\n'
    text += "".join(f'agent "{bot}" controllable mobile 1 location a can_do work\n' for bot in ("bot1", "bot2"))
    Path("two.pur").write_text(text + "reach_objective: do work\n")
    Path("bad.pur").write_text("poi\n")
    done = pursue("check", "two.pur", "--map", "map.yaml")
    assert (done.status, re.findall("warning ([A-Z0-9]+)", done.out)) == (0, ["PML120", "WSP008"])
    assert "two.pur:1:5: warning WSP008: the spot of bot2 at a (11.5, 22.3)" in done.out
    assert "write a pose for it behind that of a: bot2 [12.5, 21.5, 0, 0, 0, 0, 1]" in done.out
    assert "0 errors, 2 warnings" in done.err
    assert "WSP008" not in pursue("check", "two.pur", "--map", "map.yaml", "--spot-distance", "0.4").out
    both = pursue("check", "bad.pur", "two.pur", "--map", "map.yaml", "--json")
    assert both.status == 3 and [f["code"] for f in json.loads(both.out)][-2:] == ["PML120", "WSP008"]
    missing = pursue("check", "two.pur", "--map", "none.yaml")
    assert missing.status == 2 and "none.yaml" in missing.err
