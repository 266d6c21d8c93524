"""A mission of thousands of events in simulated time on a real ROS master: does memory grow, do clocks drift?

`python -m benchmarks.soak` plays 10,000 events of a cleaning robot that is called again and again, at random moments,
and watches every node; `--out docs` writes what it found to docs/benchmarks/reaction.json and docs/reaction.md.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import signal
import sys
import tempfile
import threading
import time
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, List, Optional

from benchmarks.ros_world import World, generated, resident_kib, world
from benchmarks.synthesis import machine
from pursue_gen.solving.rules import Rules

ROOT = Path(__file__).resolve().parent.parent

SCENARIO = """// A cleaning robot that is called again and again, and has to rinse its mop before it wipes again.
poi "office"
poi "washroom"
connect office and washroom distance 2
event "call"
event "wipe" location office duration 2
event "rinse" location washroom duration 2
rule "turn": call before wipe
rule "mop": wipe before rinse
agent "bot" controllable mobile 1 location washroom can_do wipe, rinse
agent "clerk" location office can_do call
objective: if call then wipe within 400
"""

RULES = Rules(reaction=Fraction(1, 2))
"""Time that is fifty times as fast makes a delay of 10 ms on a busy machine half a time unit: commands get that room,
and the deadline lets a lost event be published again (after half a second of real time)."""

NODES = ("observer", "controller_bot", "simulator", "UI")
MOST_DRIFT = 0.001
"""Seconds by which a clock may be beside the time since its last reset."""


class Clocks:
    """Compares every clock of the states with the stamps, from its last reset on."""

    def __init__(self) -> None:
        self.seq, self.status, self.reason = -1, "", ""
        self.first: Optional[float] = None
        self.last = 0.0
        self.drift = 0.0
        self.missed = 0
        self._zeros: Dict[str, float] = {}

    def update(self, text: str) -> None:
        """Take a state. A clock that is 0 in it was reset at its stamp; the others go on."""
        head, _, rest = text.partition("\n")
        facts = dict(part.split("=", 1) for part in head.split() if "=" in part)
        seq, stamp, unit = int(facts["seq"]), float(facts["stamp"]), float(facts["unit"])
        self.missed += max(0, seq - self.seq - 1) if self.seq >= 1 else 0
        self.seq, self.status, self.reason = seq, facts["status"], head.partition(" reason=")[2]
        if seq < 1:
            return
        self.first = stamp if self.first is None else self.first
        self.last = stamp
        for line in rest.split("\n\n", 1)[1].splitlines():
            name, _, value = line.partition("=")
            if name not in self._zeros or float(value) == 0.0:
                self._zeros[name] = stamp - float(value) * unit
            else:
                self.drift = max(self.drift, abs(float(value) * unit - (stamp - self._zeros[name])))


class StateSubscriber:
    """A subscriber of the states."""

    def __init__(self) -> None:
        import rospy
        from std_msgs.msg import String

        rospy.init_node("soak", disable_signals=True)
        self.received = threading.Condition()
        self.clocks = Clocks()
        rospy.Subscriber("pursue/system_state", String, self.receive, queue_size=10000, tcp_nodelay=True)

    def receive(self, message: Any) -> None:
        """A state."""
        with self.received:
            self.clocks.update(message.data)
            self.received.notify_all()

    def wait(self, seq: int, patience: float) -> bool:
        """True once the mission has come so far; False where it has ended before, or nothing comes for so long."""
        with self.received:
            while self.clocks.seq < seq and self.clocks.status in ("", "waiting", "running", "holding"):
                if not self.received.wait(patience):
                    return False
            return self.clocks.seq >= seq


def start(there: World, workspace: Path, speed: float, hold: float, pace: float) -> None:
    """The whole mission in simulated time, with a guest who calls at random moments."""
    there.run(["rosparam", "set", "/use_sim_time", "true"])
    # A step for every ms of real time: more often would cost the nodes more than the mission does.
    there.node(workspace, "UI", "sim_clock", f"_speed:={speed}", f"_hold:={hold}", f"_step:={speed / 1000}")
    there.node(workspace, "observer", "observer", "_lost_after:=1000")
    there.node(workspace, "controller_bot")
    there.node(workspace, "UI", "simulator", "_seed:=1")
    there.node(workspace, "UI", "UI", "--autostart", "--mode", "random", "--seed", "1", "--pace", str(pace))


def measure(events: int, warm: int, speed: float, hold: float, pace: float) -> Dict[str, Any]:
    """The figures of one mission. Raises SystemExit where it does not get so far."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that no process stays behind
    with tempfile.TemporaryDirectory(prefix="soak_") as home, world(Path(home)) as there:
        start(there, generated(SCENARIO, "cleaning", Path(home) / "ws", RULES), speed, hold, pace)
        os.environ.update(there.variables)
        subscriber = StateSubscriber()
        seen = subscriber.clocks
        if not subscriber.wait(1, 60.0):
            raise SystemExit(f"the mission does not start: {there.log('UI')[-500:]}")
        begin = time.monotonic()
        series: List[Dict[str, int]] = []
        for seq in [*range(warm, events, max(1, events // 10)), events]:
            if not subscriber.wait(seq, 60.0):
                reason = f"{seen.status} {seen.reason}\n{there.log('observer')[-1500:]}"
                raise SystemExit(f"the mission got to state {seen.seq} only: {reason}")
            series.append({"seq": seen.seq, **{name: resident_kib(there.running[name]) for name in NODES}})
            print(series[-1], flush=True)
        return {
            "events": seen.seq,
            "warm": warm,
            "seconds": round(time.monotonic() - begin, 1),
            "mission_seconds": round(seen.last - (seen.first or 0.0), 3),
            "drift_ms": round(1000 * seen.drift, 6),
            "missed": seen.missed,
            "memory": {name: {"warm": series[0][name], "end": series[-1][name]} for name in NODES},
        }


def options() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(description="Plays one long mission in simulated time and watches its nodes.")
    parser.add_argument("--events", type=int, default=10_000, help="so many (10,000)")
    parser.add_argument("--warm", type=int, default=1_000, help="events before memory is looked at first (1,000)")
    parser.add_argument("--speed", type=float, default=50.0, help="simulated seconds per real one (50)")
    parser.add_argument("--hold", type=float, default=0.02, help="seconds of standstill after a message (0.02)")
    parser.add_argument("--pace", type=float, default=2.0, help="time units between two calls, on average (2)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write reaction.md and benchmarks/reaction.json there")
    parser.add_argument("--machine", default=machine(), help="how the results name the machine")
    parser.add_argument("--date", default=datetime.date.today().isoformat(), help="how they give the date (today)")
    return parser


def main() -> int:
    """Plays, prints, and writes; the exit status is 1 where clocks drift."""
    from benchmarks import reaction_page
    from pursue_gen.files import write_texts

    given = options().parse_args()
    found = measure(given.events, given.warm, given.speed, given.hold, given.pace)
    results: Dict[str, Any] = {"soak": {**found, "machine": given.machine, "date": given.date}}
    print(reaction_page.soak_sentences(results), reaction_page.soak_table(results), sep="\n")
    if given.out:
        kept, page = given.out / "benchmarks" / "reaction.json", given.out / "reaction.md"
        results = {**(json.loads(kept.read_text()) if kept.is_file() else {}), **results}
        text = reaction_page.filled(page.read_text() if page.is_file() else None, results)
        write_texts({kept: json.dumps(results, indent=1) + "\n", page: text})
    return 0 if found["drift_ms"] <= 1000 * MOST_DRIFT else 1


if __name__ == "__main__":
    sys.exit(main())
