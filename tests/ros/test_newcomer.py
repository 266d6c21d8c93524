"""What a newcomer does first: `./run mission`. The checkout in a catkin workspace: see test_install_space."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from ros_world import Ros

pytestmark = pytest.mark.ros

ROOT = Path(__file__).resolve().parent.parent.parent
SCENARIO = ROOT / "scenarios" / "thesis" / "scenario_1.pur"
STAMP = ROOT / ".venv" / ".pursue_gen_stamp"
needs_setup = pytest.mark.skipif(not STAMP.is_file(), reason="./run setup has not been run in this checkout")


def run_mission(*words: object, **environment: str) -> "subprocess.CompletedProcess[str]":
    """`./run mission` as a person calls it."""
    return subprocess.run(
        [str(ROOT / "run"), "mission", *map(str, words)],
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=900,
        check=False,
    )


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the workspace is written: who comes second has less to build."""
    return tmp_path_factory.mktemp("newcomer") / "ws"


@needs_setup
def test_a_mission_with_another_python_first_on_path(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    foreign = tmp_path / "foreign"
    foreign.mkdir()
    for name in ("python", "python3", "cmake"):
        program = foreign / name
        program.write_text("#!/bin/bash\necho a foreign program >&2\nexit 1\n", encoding="utf-8")
        program.chmod(0o755)
    told = run_mission(
        SCENARIO,
        "-o",
        workspace,
        "use_sim_time:=true",
        PATH=f"{foreign}:{os.environ['PATH']}",
        PYTHONPATH=str(foreign),
        PYTHONHOME=str(foreign),
        CMAKE_PREFIX_PATH=str(foreign),
    )
    assert told.returncode == 0, told.stdout
    assert "The goal is reached" in told.stdout
    assert "foreign" not in told.stdout.replace(str(foreign), "")


@needs_setup
def test_a_mission_that_fails_fails_the_command(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    told = run_mission(SCENARIO, "-o", workspace, "mode:=trace", f"trace:={tmp_path}/none.yaml")
    assert told.returncode == 3, told.stdout
    assert "did not reach its goal" in told.stdout and "not started: cannot read the trace" in told.stdout
