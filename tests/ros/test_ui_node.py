"""The UI as a program: help, wrong options, missing nodes, an end; on a roscore of its own, where there is ROS."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
from pathlib import Path
from typing import Callable, Dict, Iterator

import pytest
from ros_world import Ros, end

from tests.runtime.models import model_data, mover
from tests.waiting import PATIENCE

pytestmark = pytest.mark.ros

SCRIPT = """
import sys
from pursue_runtime.data import Package
from pursue_runtime.nodes import ui

sys.exit(ui.main(Package("UI", "example", __file__)))
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A package UI with a small model."""
    folder = tmp_path_factory.mktemp("UI")
    (folder / "scripts").mkdir()
    (folder / "scripts" / "UI").write_text(SCRIPT)
    (folder / "config").mkdir()
    model = model_data(mover("bot", "robot", 9), mover("thief", "agent", 20))
    (folder / "config" / "model.yaml").write_text(json.dumps(model))  # YAML without aliases
    (folder / "config" / "ui.yaml").write_text("format: 1\nnodes: [observer, controller_bot]\n")
    poses = "a: [0, 0, 0, 0, 0, 0, 1], b: [9, 0, 0, 0, 0, 0, 1]"
    (folder / "config" / "poses.yaml").write_text(f"format: 1\nposes: {{{poses}}}\n")
    return folder


@pytest.fixture(scope="module")
def where(ros: Ros, built: Callable[..., Path]) -> Iterator[Dict[str, str]]:
    """The environment of a roscore of our own, with the messages of a workspace."""
    names = ("PYTHONPATH", "PATH", "CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH")
    sourced = ros.for_missions(built("thesis/scenario_1"))
    there = {name: sourced[name] for name in names}
    with ros.master() as master:
        home = str(ros.home)
        yield {**ros.environment, **there, **master, "ROS_HOSTNAME": "localhost", "ROS_HOME": home}


def run(package: Path, environment: Dict[str, str], *arguments: str) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, str(package / "scripts" / "UI"), *arguments]
    return subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True, timeout=2 * PATIENCE)


def test_help_needs_no_roscore(package: Path, where: Dict[str, str]) -> None:
    done = run(package, {**where, "ROS_MASTER_URI": "http://localhost:1"}, "--help")
    assert done.returncode == 0
    assert "--trace" in done.stdout


def test_missing_nodes_are_named_and_nothing_is_started(package: Path, where: Dict[str, str]) -> None:
    done = run(package, where, "--wait", "0.5")
    assert done.returncode == 1
    assert "Not ready after 0.5 s: observer, controller_bot. The mission was not started." in done.stdout


# parameters stay with the master under the node's name
@pytest.mark.parametrize("arguments, says", [
    (["--mode", "quick"], "expected one of ask, still, random, trace"),
    (["--trace", "/nowhere/trace.yaml"], "cannot read the trace /nowhere/trace.yaml"),
    (["_pace:=soon", "__name:=hasty"], "pace is 'soon'; expected a number"),
    (["--config", "/nowhere", "__name:=lost"], "no model.yaml in /nowhere"),
])
def test_a_wrong_start_is_refused_in_one_line(package: Path, where: Dict[str, str], arguments: list, says: str) -> None:
    done = run(package, where, *arguments)
    assert done.returncode == 2
    assert says in done.stderr
    assert "Traceback" not in done.stderr


def test_a_wrong_trace_is_refused_with_its_place(package: Path, where: Dict[str, str], tmp_path: Path) -> None:
    trace = tmp_path / "trace.yaml"
    trace.write_text("- {at: 1, do: thief_a2b}\n- {at: 2, do: thief_a2c}\n")
    done = run(package, where, "--trace", str(trace))
    assert done.returncode == 2
    assert f"{trace}:2: step 2" in done.stderr


def test_without_tornado_there_is_no_page_and_the_reason_is_reported(
    package: Path, where: Dict[str, str], tmp_path: Path
) -> None:
    (tmp_path / "tornado").mkdir()
    (tmp_path / "tornado" / "__init__.py").write_text("raise ImportError('it is not here')")
    without = {**where, "PYTHONPATH": os.pathsep.join([str(tmp_path), where.get("PYTHONPATH", "")])}
    done = run(package, without, "--web", "__name:=pageless")
    assert done.returncode == 2
    assert "UI: --web needs tornado, and it is not here: install python3-tornado" in done.stderr
    assert "Traceback" not in done.stderr
    done = run(package, without, "--wait", "0.5", "__name:=plain")
    assert "Not ready after 0.5 s" in done.stdout, "nobody else needs it"


def test_what_is_typed_and_is_no_text_does_not_end_the_mission(package: Path, where: Dict[str, str]) -> None:
    command = [sys.executable, str(package / "scripts" / "UI"), "--mode", "ask", "--wait", "2", "__name:=typed"]
    environment = {**where, "PYTHONIOENCODING": "utf-8:strict"}
    done = subprocess.run(command, env=environment, input=b"\xff\n", capture_output=True, timeout=2 * PATIENCE)
    assert b"standard input is not read any more" in done.stdout + done.stderr
    assert b"Not ready after 2 s" in done.stdout and b"Traceback" not in done.stdout + done.stderr


def test_a_taken_port_is_reported(package: Path, where: Dict[str, str]) -> None:
    pytest.importorskip("tornado")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen(1)
        port = taken.getsockname()[1]
        done = run(package, where, "--web", "--port", str(port), "__name:=second")
    assert done.returncode == 2
    assert f"UI: cannot serve the page on 127.0.0.1, port {port}" in done.stderr
    assert "Traceback" not in done.stderr


def test_the_address_of_the_page_is_reported(package: Path, where: Dict[str, str]) -> None:
    pytest.importorskip("tornado")
    done = run(package, where, "--web", "--port", "0", "--host", "0.0.0.0", "--wait", "0.5", "__name:=shown")
    assert done.returncode == 1, done.stderr
    assert re.search(r"^The page is at http://[^/]+:\d+/\?token=[\w-]{20,}$", done.stdout, re.MULTILINE), done.stdout


class ObserverStub:
    """Plays the rest of the mission: whoever the UI waits for, and the observer's states."""

    def __init__(self, environment: Dict[str, str]) -> None:
        code = (Path(__file__).parent / "observer_stub.py").read_text()
        self.process = subprocess.Popen([sys.executable, "-c", code], env=environment, start_new_session=True)

    def __enter__(self) -> "ObserverStub":
        return self

    def __exit__(self, *_: object) -> None:
        end(self.process)


@pytest.mark.parametrize("status, code, says", [
    ("won", 0, "The goal is reached, after 3.0 time units."),
    ("lost", 1, "The mission is lost, after 3.0 time units: for a reason."),
])
def test_it_starts_the_mission_plays_the_trace_and_says_how_it_ended(
    package: Path, where: Dict[str, str], tmp_path: Path, status: str, code: int, says: str
) -> None:
    trace = tmp_path / "trace.yaml"
    trace.write_text("- {at: 0.1, do: thief_a2b}\n")
    with ObserverStub({**where, "LAST_STATUS": status}):
        done = run(package, where, "--trace", str(trace), "--wait", str(PATIENCE))
    assert done.returncode == code, done.stderr
    lines = [line.strip() for line in done.stdout.splitlines()]
    assert lines[0] == "example: waiting for observer, controller_bot"
    assert lines[-2:] == ["3.0  thief sets off from a to b", says]


def test_a_mission_that_no_observer_starts_is_not_waited_for(package: Path, where: Dict[str, str]) -> None:
    with ObserverStub({**where, "LAST_STATUS": ""}):
        done = run(package, where, "--mode", "still", "--wait", str(PATIENCE), "__name:=unanswered")
    assert done.returncode == 1, done.stderr
    assert done.stdout.splitlines()[-1] == "The observer does not answer _start_."
