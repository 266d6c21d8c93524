"""The benchmarks on ROS run, in small: what they measure is told, how fast it was is not judged here."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from ros_world import Ros

pytestmark = pytest.mark.ros

ROOT = Path(__file__).resolve().parent.parent.parent


def test_hundreds_of_events_leave_memory_and_clocks_as_they_were(ros: Ros, tmp_path: Path) -> None:
    command = f"{sys.executable} -m benchmarks.soak --events 250 --warm 100 --out {tmp_path} --machine m --date d"
    done = ros.run(command, ROOT, 900)
    assert done.returncode == 0, done.stdout
    found = json.loads((tmp_path / "benchmarks" / "reaction.json").read_text())["soak"]
    assert found["events"] >= 250 and found["missed"] == 0
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
