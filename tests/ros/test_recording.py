"""A mission that is recorded by a launch argument, and what `pursue-gen replay` says of it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any, Callable, Dict

import pytest
from ros_world import Ros

from pursue_gen.language import load
from pursue_gen.tools.calibration.recordings import samples_in
from tests.waiting import PATIENCE

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "thesis" / "scenario_1.pur"
OPTIONS = "use_sim_time:=true speed:=2 delays:=early"
"""A word that is said early in its window may take a fifth of a second, and comes at a time that the model knows."""

LAUNCH = f"source devel/setup.bash; roslaunch scenario_1_bringup mission.launch {OPTIONS}"


def replayed(*words: Any) -> Dict[str, Any]:
    """What `pursue-gen replay` says, as JSON."""
    command = [sys.executable, "-m", "pursue_gen", "replay", "--json", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=2 * PATIENCE, check=False)
    assert done.returncode in (0, 1), done.stderr
    told: Dict[str, Any] = json.loads(done.stdout)
    assert (done.returncode == 0) is (told["kept"] and told["won"])
    return told


def test_a_recorded_mission_is_complete_and_kept_to_its_scenario(ros: Ros, built: Build, tmp_path: Path) -> None:
    workspace = built("thesis/scenario_1")
    with ros.master() as there:
        done = ros.run(f"{LAUNCH} record:=true", workspace, ROS_HOME=str(tmp_path), **there)
    assert "The goal is reached" in done.stdout, done.stdout
    folder = tmp_path / "pursue" / "scenario_1"
    assert [path.name for path in folder.glob("*.bag*")] == ["mission.bag"], "closed, and under its name"
    told = replayed(folder / "mission.bag")
    times, findings = samples_in([folder / "mission.bag"], load(str(SCENARIO)))
    whats = {str(sample.what) for sample in times.measured}
    assert whats == {"bot1 from c to b", "bot2 from c to a", "bot1_inb", "bot2_ina"} and findings == ()
    assert told["reaction"]["commands"] == 5 and told["left_most"] == []
    assert (told["kept"], told["won"]) == (True, True), told["verdict"]
    assert told["counts"]["states"] == told["counts"]["steps"] + 2, "from the state before the start on"
    assert told["unread"] == [] and told["steps"][0]["said_by"] == "controllerObj"
    info = ros.run(f"rosbag info {folder}/mission.bag", workspace)
    assert "/pursue/system_state" in info.stdout, "ROS's own tools read it"
    [journal] = folder.glob("journal*.jsonl")
    assert replayed(journal, "--workspace", workspace)["kept"]


@pytest.fixture(scope="module")
def theft(ros: Ros, built: Build, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a mission of catch the thief that was to be recorded in a file that is already there."""
    folder = tmp_path_factory.mktemp("theft")
    asked = folder / "my mission.bag"
    asked.write_text("something dear")
    launch = LAUNCH.replace("scenario_1", "catch_the_thief")
    with ros.master() as there:
        command = f"{launch} mode:=still record:='{asked}'"
        done = ros.run(command, built("thesis/catch_the_thief"), ROS_HOME=str(folder / "home"), **there)
    assert "The goal is reached" in done.stdout, done.stdout
    return folder


def test_a_given_path_is_kept_and_no_file_is_overwritten(theft: Path) -> None:
    assert (theft / "my mission.bag").read_text() == "something dear"
    assert replayed(theft / "my mission-2.bag")["kept"]


def test_the_robot_is_reported_what_wins_the_mission_at_once(theft: Path) -> None:
    told = replayed(theft / "my mission-2.bag")
    assert (told["kept"], told["won"]) == (True, True), told["verdict"]
