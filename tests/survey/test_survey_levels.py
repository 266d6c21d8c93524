"""pursue-gen survey and check of a building with several levels, each with its own map."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import check, load, parse
from pursue_gen.language.scenario import Pose
from pursue_gen.workspace.levels import Level, check_levels, on_level, read_levels
from tests.survey.maps import Box, drawn, ground_of
from tests.tools.authoring.commands import Outcome, pursue

CELL = 0.1
LEVELS = "levels:\n  low: {map: low/map.yaml, elevation: 0}\n  high: {map: high/map.yaml, elevation: 4}\n"
TEXT = """// two floors, one above the other
unit second
poi "desk"  //[1.0, 1.0, 0, 0, 0, 0, 1]
poi "hall0" //[1.0, 5.0, 0, 0, 0, 0, 1]
poi "hall1" //[1.0, 5.0, 4, 0, 0, 0, 1]
poi "room"  //[1.0, 1.0, 4, 0, 0, 0, 1]
lift "lift1" at hall0, hall1 comes within 20 s takes 5 s //[1.0, 8.5, 0, 0, 0, 0, 1]
connect desk and hall0 distance 9 m
connect hall0 and hall1 distance 2 m by lift1
connect hall1 and room distance 9 m
event "bring" location room duration 3 s
agent "bot1" controllable speed 0.5 location desk can_do bring
agent "bot2" controllable speed 0.5 location hall0 can_do bring
reach_objective: do bring
"""


def saved(folder: Path, walls: Any = ()) -> None:
    """A floor of 5 m x 10 m with walls in it."""
    greys = drawn((5.0, 10.0), walls, resolution=CELL)
    folder.mkdir(exist_ok=True)
    (folder / "map.pgm").write_bytes(b"P5\n%d %d\n255\n" % greys.shape[::-1] + greys[::-1].tobytes())
    (folder / "map.yaml").write_text(f"image: map.pgm\nresolution: {CELL}\norigin: [0, 0, 0]\n")


WALL: Box = (0.0, 2.9, 4.0, 3.1)
"""A wall between the two places of a floor, which leaves a door at its right end."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    saved(tmp_path / "low")
    saved(tmp_path / "high", [WALL])
    Path("levels.yaml").write_text(LEVELS)
    return tmp_path


def surveyed(*options: object, text: str = TEXT, status: int = 0) -> Outcome:
    Path("two.pur").write_text(text)
    done = pursue("survey", "levels.yaml", "two.pur", "--force", *options)
    assert done.status == status, done.err
    return done


def test_each_level_is_measured_on_its_own_map() -> None:
    done = surveyed("--json", "--radius", "0.2")
    ways = {(way["a"], way["b"]): way for way in json.loads(done.out)["ways"]}
    assert ways["desk", "hall0"]["metres"] == pytest.approx(4.0, abs=0.01)
    assert ways["hall1", "room"]["metres"] > 7, "around the wall"
    assert ways["hall0", "hall1"]["metres"] is None and ways["hall0", "hall1"]["kept"] == "it goes by lift"
    assert set(ways) == {("desk", "hall0"), ("hall1", "room"), ("hall0", "hall1")}, "none is missing"
    copy = Path("two_surveyed.pur").read_text()
    assert "distance 4 m // survey: 4.00 m on map.yaml (low)" in copy and "distance 2 m by lift1\n" in copy
    assert check(load("two_surveyed.pur")) == ()


def test_spots_are_those_of_their_level_whatever_stands_above_or_below() -> None:
    done = surveyed("--json", "--radius", "0.2")
    spots = json.loads(done.out)["spots"]
    assert {place: spot["bot2"][2] for place, spot in spots.items()} == {"desk": 0, "hall0": 0, "hall1": 4, "room": 4}
    assert "MAP005" not in done.out, "places above each other are not near each other"


def test_a_surveyed_copy_gives_a_workspace_with_all_poses_on_their_levels() -> None:
    surveyed("--radius", "0.2")
    checked = pursue("check", "two_surveyed.pur", "--map", "levels.yaml", "--robot", "0.2")
    assert checked.status == 0 and checked.out == ""
    made = pursue("ws", "two.pur", "-o", "out", "--map", "levels.yaml", "--robot", "0.2")
    assert made.status == 0, made.err
    poses = Path("out/src/controller_bot2/config/poses.yaml").read_text()
    spots = re.findall(r"^  (\w+): \[([-\d.]+), ([-\d.]+), ([\d.]+),", poses, re.MULTILINE)
    assert {(place, z) for place, _, _, z in spots} >= {("hall0", "0.0"), ("hall1", "4.0"), ("room", "4.0")}
    assert "spare:" in poses
    assert not Path("out/src/UI/config/map").exists(), "no one picture is the floor of all"


def test_a_picture_is_drawn_of_each_level() -> None:
    surveyed("--picture", "plan.svg", "--dry-run")
    assert ">desk<" in Path("plan_low.svg").read_text() and ">room<" not in Path("plan_low.svg").read_text()
    assert ">room<" in Path("plan_high.svg").read_text() and not Path("plan.svg").exists()


def test_findings_are_those_of_the_level_on_which_a_place_is() -> None:
    done = surveyed(text=TEXT.replace('"room"  //[1.0, 1.0, 4', '"room"  //[1.0, 3.0, 4'))
    assert "two.pur:6:5: warning WSP008: the pose of room (1, 3) is in an obstacle" in done.err
    assert "desk" not in re.findall(r"warning .*", done.err)[0]
    assert re.search(r"hall1 - room +-  9 stays: room is not on free ground", done.out)


@pytest.mark.parametrize(
    ("levels", "told"),
    [
        ("levels: {}\n", "1:1: error MAP010: expected levels: and nothing else"),
        ("levels: [low, high]\n", "1:1: error MAP010: expected levels: and nothing else"),
        (LEVELS + "more: 1\n", "1:1: error MAP010: expected levels: and nothing else"),
        (LEVELS.replace("high:", "low:"), "3:3: error MAP010: level low stands twice"),
        (LEVELS.replace("elevation: 4", "elevation: 0.5"), "3:9: error MAP010: levels low and high are at"),
        (LEVELS.replace(", elevation: 4", ""), "3:9: error MAP010: level high has to have a map and an elevation"),
        (LEVELS.replace("elevation: 4", "elevation: up"), "3:9: error MAP010: the elevation of level high is"),
        (LEVELS.replace("map: high/map.yaml", "map: 7"), "3:9: error MAP010: the map of level high is no file"),
        (LEVELS.replace("high:", "floor 1:"), "3:12: error MAP010: level 'floor 1' has to be called by letters"),
        (LEVELS.replace("high/map.yaml", "none.yaml"), "error CLI001: cannot read none.yaml"),
        (LEVELS.replace("}", "", 1), "MAP010"),
    ],
)
def test_a_file_of_levels_that_is_wrong_is_told_with_its_place(levels: str, told: str) -> None:
    Path("levels.yaml").write_text(levels)
    done = surveyed(status=2)
    assert told in done.err and not Path("two_surveyed.pur").exists()
    Path("two.pur").write_text(TEXT)
    assert told in pursue("check", "two.pur", "--map", "levels.yaml").err


def test_a_place_on_no_level_and_a_level_without_a_place_are_told() -> None:
    text = TEXT.replace('"room"  //[1.0, 1.0, 4', '"room"  //[1.0, 1.0, 8')
    done = surveyed(text=text, status=2)
    assert "two.pur:6:5: error MAP010: room is at the height 8, where no level is" in done.err
    assert "the levels are low at 0 and high at 4" in done.err and not Path("two_surveyed.pur").exists()
    Path("levels.yaml").write_text(LEVELS + "  roof: {map: low/map.yaml, elevation: 8}\n")
    done = surveyed()
    assert "warning MAP010: no place is on level roof, which is at the height 8" in done.err


def test_one_map_for_several_floors_is_looked_at_for_all_and_that_is_told(folder: Path) -> None:
    Path("two.pur").write_text(TEXT)
    done = pursue("survey", "low/map.yaml", "two.pur", "--dry-run")
    assert done.status == 0 and "two.pur:5:5: warning MAP010: hall1 is on another floor than desk" in done.err


def test_a_building_of_open_rmf_is_no_map_and_a_map_without_obstacles_is_told() -> None:
    Path("campus.building.yaml").write_text("levels:\n  L1: {elevation: 0, lanes: []}\nname: campus\n")
    Path("two.pur").write_text(TEXT)
    done = pursue("survey", "campus.building.yaml", "two.pur")
    assert done.status == 2 and "this is a building of Open-RMF, and no map" in done.err
    Path("low/map.pgm").write_bytes(b"P5\n50 100\n255\n" + b"\xfe" * 5000)
    done = surveyed("--dry-run")
    assert "warning MAP011: map.yaml (low) has no obstacle: each path on it is a straight line" in done.err
    assert done.err.count("MAP011") == 1


def test_levels_share_out_all_poses() -> None:
    scenario = parse(TEXT, "two.pur")
    levels = read_levels(Path("levels.yaml"))
    assert [(level.name, level.elevation, level.file.name) for level in levels] == [
        ("low", 0.0, "map.yaml"), ("high", 4.0, "map.yaml"),
    ]  # fmt: skip
    parts = [[poi.name for poi in on_level(scenario, level).pois if poi.pose is not None] for level in levels]
    assert parts == [["desk", "hall0"], ["hall1", "room"]]
    whole = Level(ground_of(drawn((5.0, 10.0), [], resolution=CELL), CELL))
    assert on_level(scenario, whole) == scenario and not whole.has(None)
    assert levels[1].has(Pose(0, 0, 4.5, 0, 0, 0, 1)) and not levels[1].has(Pose(0, 0, 4.6, 0, 0, 0, 1))
    with pytest.raises(PursueError):
        list(check_levels(scenario, levels[:1]))
