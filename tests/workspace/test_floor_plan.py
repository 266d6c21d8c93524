"""`ws --map`: the floor plan is in the package of the UI, which shows it under the map of its page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing import floor_picture as desk
from pursue_runtime.data import DataError, read_data
from pursue_runtime.poses import read_poses
from pursue_runtime.ui.floor import read_floor
from tests.tools.authoring.commands import pursue

SCENARIO = """poi "a" //[1.0, 1.0, 0, 0, 0, 0, 1]
poi "b" //[9.0, 9.0, 0, 0, 0, 0, 1]
connect a and b distance 2
event "greet" location b
agent "bot" controllable mobile 1 location a can_do greet
reach_objective: do greet
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scenario and a map of two by three metres, in the working folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "visit.pur").write_text(SCENARIO)
    (tmp_path / "floor.pgm").write_bytes(b"P5 4 6 255\n" + bytes([254] * 24))
    (tmp_path / "map.yaml").write_text("image: floor.pgm\nresolution: 0.5\norigin: [-1, 0.25, 0.1]\nnegate: 0\n")
    return tmp_path


def test_the_page_finds_the_plan_that_ws_has_put_there(folder: Path) -> None:
    done = pursue("ws", "visit.pur", "--map", "map.yaml", "-o", "out")
    assert done.status == 0, done.err
    assert "the pose of b (9, 9) is off the map" in done.out + done.err, "places are checked as by check --map"
    found, given = read_floor(str(folder / "out/src/UI/config")), desk.read_floor(folder / "map.yaml")
    assert found is not None and found.picture == given.picture
    assert found.scene() == {"width": 4, "height": 6, "resolution": 0.5, "x": -1.0, "y": 0.25, "yaw": 0.1, "paths": ()}
    assert "map" in (folder / "out/src/UI/CMakeLists.txt").read_text(), "it is installed"
    assert pursue("ws", "visit.pur", "-o", "bare").status == 0
    assert read_floor(str(folder / "bare/src/UI/config")) is None
    out, bare = ((folder / name / "src/UI/config/mission.yaml").read_bytes() for name in ("out", "bare"))
    assert out == bare, "the building is no part of the mission"


def test_the_page_finds_the_paths_of_ways_that_the_map_has(folder: Path) -> None:
    greys = bytes(0 if column == 40 and row > 10 else 254 for row in range(40) for column in range(80))
    (folder / "floor.pgm").write_bytes(b"P5 80 40 255\n" + greys)
    (folder / "map.yaml").write_text("image: floor.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n")
    (folder / "visit.pur").write_text(SCENARIO.replace("[9.0, 9.0", "[7.0, 1.0"))
    done = pursue("ws", "visit.pur", "--map", "map.yaml", "-o", "out")
    found = read_floor(str(folder / "out/src/UI/config"))
    assert done.status == 0 and found is not None
    ((a, b, line),) = found.paths
    assert (a, b, line[0], line[-1]) == ("a", "b", (1.0, 1.0), (7.0, 1.0))
    assert max(y for _, y in line) > 3.2, "around the wall"
    poses = read_poses(read_data(str(folder / "out/src/controller_bot/config/poses.yaml")))
    assert list(poses.spare["bot"]) == ["a", "b"] and poses.spare["bot"]["a"] != poses.places["a"]
    assert pursue("ws", "visit.pur", "-o", "bare").status == 0
    bare = (folder / "bare/src/controller_bot/config/poses.yaml").read_text()
    assert "format: 1\n" in bare and "spare" not in bare


def test_without_a_map_file_nothing_is_written(folder: Path) -> None:
    done = pursue("ws", "visit.pur", "--map", "none.yaml", "-o", "out")
    assert done.status == 2 and "none.yaml" in done.err and not (folder / "out").exists()


@pytest.mark.parametrize("change", [
    {"width": 0}, {"height": "tall"}, {"resolution": -1}, {"resolution": float("inf")}, {"origin": [1, 2]},
    {"origin": 7}, {"paths": [["a", "b"]]}, {"paths": [["a", "b", [[0, 0]]]]}, {"paths": [["a", "b", [[0, "x"]]]]},
    {"paths": [["a", "b", [[0, 0], [1, float("nan")]]]]}, {"paths": 3},
    {"origin": [float("nan"), 0, 0]}, {"width": None},
])
def test_a_plan_that_somebody_has_spoilt_is_refused(tmp_path: Path, change: Any) -> None:
    (tmp_path / "map").mkdir()
    data = {"format": 1, "width": 4, "height": 6, "resolution": 0.5, "origin": [0, 0, 0], **change}
    (tmp_path / "map/floor.yaml").write_text(yaml.safe_dump(data))
    (tmp_path / "map/floor.png").write_bytes(b"\x89PNG\r\n\x1a\n...")
    with pytest.raises(DataError, match=r"floor\.yaml"):
        read_floor(str(tmp_path / "config"))


@pytest.mark.parametrize("picture", [None, b"", b"GIF89a"])
def test_a_plan_without_its_picture_is_refused(tmp_path: Path, picture: Any) -> None:
    (tmp_path / "map").mkdir()
    (tmp_path / "map/floor.yaml").write_text("format: 1\nwidth: 4\nheight: 6\nresolution: 0.5\norigin: [0, 0, 0]\n")
    if picture is not None:
        (tmp_path / "map/floor.png").write_bytes(picture)
    with pytest.raises(DataError, match=r"floor\.(yaml|png)"):
        read_floor(str(tmp_path / "config"))


def test_a_map_that_map_server_would_not_take_is_refused(folder: Path) -> None:
    (folder / "floor.pgm").write_bytes(b"P5 4 6 255\n")
    with pytest.raises(PursueError, match="ends after 0 of 24 pixels"):
        desk.read_floor(folder / "map.yaml")
