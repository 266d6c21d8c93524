"""The benchmarks on ROS run, in small: what they measure is told, how fast it was is not judged here."""

from __future__ import annotations

import json
import socket
import sys
from pathlib import Path
from typing import List
from urllib.parse import urlparse

import pytest
from ros_world import Ros

from benchmarks import ros_world as bench
from benchmarks.ros_world import PORTS, free_port, world

pytestmark = [pytest.mark.ros, pytest.mark.benchmark]

ROOT = Path(__file__).resolve().parent.parent.parent


def test_hundreds_of_events_leave_memory_and_clocks_as_they_were(ros: Ros, tmp_path: Path) -> None:
    # A simulator that waits for the processor sees an order when its clock is late: for more than 1.5 time units, 0.2 s
    # here, it takes the order for an old one, and the robot never sets off.
    slow = "--speed 8 --hold 0.1"
    command = f"{sys.executable} -m benchmarks.soak --events 200 --warm 80 {slow} --out {tmp_path} --machine m"
    done = ros.run(command, ROOT, 900)
    assert done.returncode == 0, done.stdout
    found = json.loads((tmp_path / "benchmarks" / "reaction.json").read_text())["soak"]
    assert found["events"] >= 200 and found["missed"] == 0
    assert found["drift_ms"] < 1.0
    grown = {name: memory["end"] - memory["warm"] for name, memory in found["memory"].items()}
    assert all(kib < 1024 for kib in grown.values()), grown


def test_reactions_are_measured_beside_floor_and_thesis(ros: Ros, tmp_path: Path) -> None:
    command = f"{sys.executable} -m benchmarks.reaction --events 20 --thesis-events 3 --idle 2 --out {tmp_path}"
    done = ros.run(command, ROOT, 600)
    assert done.returncode in (0, 1), done.stdout
    assert "Traceback" not in done.stdout, done.stdout
    found = json.loads((tmp_path / "benchmarks" / "reaction.json").read_text())
    counts = {name: row["count"] for name, row in found["reaction"].items()}
    assert counts == {"floor": 20, "command": 20, "order": 20, "thesis": 3}
    assert found["reaction"]["thesis"]["median"] >= 100, "it waits for a tenth of a second at least"
    assert set(found["idle"]) == {"observer", "controller_bot", "simulator", "UI"}
    assert "three bare hops" in (tmp_path / "reaction.md").read_text()


@pytest.fixture
def ports(monkeypatch: pytest.MonkeyPatch) -> List[int]:
    """The ports that benchmarks take for free at first; after them, they get such that are."""
    chosen: List[int] = []
    monkeypatch.setattr(bench, "free_port", lambda: chosen.pop(0) if chosen else free_port())
    return chosen


def test_where_a_port_was_taken_meanwhile_the_roscore_gets_another(ros: Ros, tmp_path: Path, ports: List[int]) -> None:
    with ros.master() as stranger, socket.socket() as mute:
        mute.bind(("", 0))
        taken = [int(str(urlparse(stranger["ROS_MASTER_URI"]).port)), mute.getsockname()[1]]
        ports.extend(taken)
        with world(tmp_path) as there:
            assert not ports
            assert urlparse(there.variables["ROS_MASTER_URI"]).port not in taken
            assert list(there.running) == ["roscore"] and there.running["roscore"].poll() is None


def test_where_no_roscore_comes_up_none_stays_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "roscore").write_text(f"#!/bin/sh\necho $$ $2 >> {tmp_path}/started\nexec false\n")
    (tmp_path / "roscore").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    with pytest.raises(SystemExit, match=f"no roscore comes up, on {PORTS} ports"), world(tmp_path):
        raise AssertionError("there is no roscore")
    assert len({line.split()[1] for line in (tmp_path / "started").read_text().splitlines()}) == PORTS
