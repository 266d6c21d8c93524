"""A node whose launch was for another roscore does nothing: its parameters are lost, and nobody told it what to do. One
that is interrupted knows whether its own master is gone, and the worst of what it has to report counts."""

from __future__ import annotations

import socket
import subprocess
import sys

import pytest

from tests.waiting import PATIENCE

pytest.importorskip("rospy", reason="ROS is not installed")

import rosgraph

from pursue_runtime.nodes.node import ERROR, OK, STALE, WARN, master_is_gone, worse

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


def test_a_master_is_gone_where_its_port_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"http://127.0.0.1:{server.getsockname()[1]}/"
        monkeypatch.setattr(rosgraph, "get_master_uri", lambda: address)
        assert not master_is_gone()
    assert master_is_gone()
    monkeypatch.setattr(rosgraph, "get_master_uri", lambda: "http://127.0.0.1:none/")
    assert not master_is_gone(), "that is not known"


def test_an_error_is_worse_than_old_news_and_these_than_a_warning() -> None:
    levels = [OK, WARN, STALE, ERROR]
    for number, level in enumerate(levels):
        assert [worse(level, other) for other in levels] == [levels[max(number, k)] for k in range(4)]
