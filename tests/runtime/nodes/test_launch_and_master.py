"""A node whose launch was for another roscore does nothing: its parameters are lost, and nobody told it what to do."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.waiting import PATIENCE

pytest.importorskip("rospy", reason="ROS is not installed")

PROGRAM = """
import sys
import rospy
from pursue_runtime.nodes.node import Ending

def get_param(name, default=None):
    assert name == "/run_id"
    return sys.argv[1] or default

rospy.get_param, rospy.logfatal = get_param, print
Ending()
print("begins")
"""
MINE, OTHER = "79520a94-e607-11f1-81c8-3acae0bbc432", "1f6f86da-e604-11f1-a6c6-02fc00000001"


def begun(run_id: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """A node with these arguments, at a master with this /run_id."""
    command = [sys.executable, "-c", PROGRAM, run_id, *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)


def log(run_id: str) -> str:
    """What roslaunch adds to a node's command line."""
    return f"__log:=/home/ros/.ros/log/{run_id}/base-UI-6.log"


@pytest.mark.parametrize("run_id, arguments", [
    (MINE, ["__name:=UI", log(MINE)]),
    (MINE, ["--web", "__name:=UI"]),  # with rosrun
    ("", ["__name:=UI", log(MINE)]),  # a master that has no /run_id
])  # fmt: skip
def test_a_node_begins_where_its_parameters_are(run_id: str, arguments: "list[str]") -> None:
    done = begun(run_id, *arguments)
    assert (done.returncode, done.stdout) == (0, "begins\n"), done.stderr


def test_a_node_that_is_started_again_for_another_roscore_does_nothing() -> None:
    done = begun(OTHER, "__name:=UI", log(MINE))
    assert done.returncode == 1
    assert "start roslaunch again" in done.stdout and "begins" not in done.stdout
