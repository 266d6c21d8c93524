"""Measures how fast a mission reacts on a real ROS master, and what it costs to wait: `python -m benchmarks.reaction`.

docs/reaction.md says what is measured; `--out docs` writes it anew, and the figures in docs/benchmarks/reaction.json.
"""

from __future__ import annotations

import argparse
import datetime
import json
import signal
import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Sequence

from benchmarks.ros_world import World, generated, idle_load, world
from benchmarks.synthesis import machine

ROOT = Path(__file__).resolve().parent.parent

SCENARIO = """// A guest calls, the robot answers as soon as it may, again and again.
poi "desk"
event "call"
event "answer"
rule "turn": call before answer
agent "bot" controllable location desk can_do answer
agent "guest" location desk can_do call
objective: if call then answer within 20
"""

UNIT = 0.05
"""Seconds per time unit: an agent may act again after one."""

RATIO = 3.0
"""p99 of the reaction may be so many times the floor's."""

NODES = ("observer", "controller_bot", "simulator", "UI")


def start_mission(there: World, folder: Path) -> None:
    """Start all nodes of the generated workspace; the UI starts the mission."""
    workspace = generated(SCENARIO, "answer", folder)
    there.node(workspace, "observer", "observer", f"_time_unit:={UNIT}")
    there.node(workspace, "controller_bot")
    there.node(workspace, "UI", "simulator")
    there.node(workspace, "UI", "UI", "--autostart", "--mode", "still")


def start_others(there: World) -> None:
    """Start two relays (with the probe three hops), and the thesis's scheme in a namespace of its own."""
    roles = [sys.executable, "-m", "benchmarks.reaction_nodes"]
    there.start("relay1", [*roles, "relay", "floor/in", "floor/between"])
    there.start("relay2", [*roles, "relay", "floor/between", "floor/out"])
    for role in ("thesis_observer", "thesis_controller"):
        there.start(role, [*roles, role], ROS_NAMESPACE="thesis")


def measure(events: int, thesis: int, seconds: float) -> Dict[str, Any]:
    """The figures of one run: milliseconds by what was timed, percent of a core by node."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that no process stays behind
    with tempfile.TemporaryDirectory(prefix="reaction_") as home, world(Path(home)) as there:
        start_mission(there, Path(home) / "ws")
        start_others(there)
        roles = [sys.executable, "-m", "benchmarks.reaction_nodes"]
        probe = there.start("probe", [*roles, "probe", str(events), str(thesis)])
        probe.wait()
        lines = there.log("probe").strip().splitlines()
        if probe.returncode or not lines:
            raise SystemExit(f"the probe failed: {' '.join(lines[-3:])}")
        times: Dict[str, List[float]] = json.loads(lines[-1])
        there.stop("probe", "relay1", "relay2", "thesis_observer", "thesis_controller")
        load = idle_load(there, seconds)
    return {
        "reaction": {name: figures(some) for name, some in times.items() if some},
        "idle": {name: round(100 * load[name], 3) for name in NODES},
        "idle_seconds": seconds,
        "unit": UNIT,
    }


def figures(seconds: Sequence[float]) -> Dict[str, float]:
    """Count, and in milliseconds median, 99th percentile and worst."""
    ordered = sorted(1000 * value for value in seconds)
    p99 = ordered[min(len(ordered) - 1, int(0.99 * len(ordered)))]
    found = {"count": float(len(ordered)), "median": statistics.median(ordered), "p99": p99, "worst": ordered[-1]}
    return {name: round(value, 3) for name, value in found.items()}


def options() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(description="Measures how fast a generated mission reacts on a real ROS master.")
    parser.add_argument("--events", type=int, default=1000, help="of the mission, and as many of the floor (1000)")
    parser.add_argument("--thesis-events", type=int, default=200, help="with the thesis's scheme, which is slow (200)")
    parser.add_argument("--idle", type=float, default=20.0, metavar="SECONDS", help="to watch the waiting nodes (20)")
    parser.add_argument("--render", action="store_true", help="measure nothing, write again what --out holds")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write reaction.md and benchmarks/reaction.json there")
    parser.add_argument("--machine", default=machine(), help="how the results name the machine")
    parser.add_argument("--date", default=datetime.date.today().isoformat(), help="how they give the date (today)")
    return parser


def main() -> int:
    """Measures, prints, and writes; the exit status is 1 where the reaction is slower than it should be."""
    from benchmarks import reaction_page
    from pursue_gen.files import write_texts

    given = options().parse_args()
    kept = given.out / "benchmarks" / "reaction.json" if given.out else None
    old = json.loads(kept.read_text()) if kept and kept.is_file() else {}
    if given.render:
        results = old
    else:
        found = measure(given.events, given.thesis_events, given.idle)
        results = {**old, **found, "machine": given.machine, "date": given.date}
    print(reaction_page.reaction_table(results), reaction_page.idle_table(results), sep="\n")
    if given.out and kept:
        page = given.out / "reaction.md"
        text = reaction_page.filled(page.read_text() if page.is_file() else None, results)
        write_texts({kept: json.dumps(results, indent=1) + "\n", page: text})
    times = results["reaction"]
    return 0 if times["order"]["p99"] <= RATIO * times["floor"]["p99"] else 1


if __name__ == "__main__":
    sys.exit(main())
