"""Missions on a real ROS master whose nodes are killed at random moments: `python -m benchmarks.kills`.

Each mission is recorded twice (see second_recorder), and judged afterwards by `pursue_gen.tools.replay` from what
either recorder has, what the observer has heard beside that, and the workspace's strategy alone. Where there are
promises alone, the mission is ended after a time.
`--out docs` writes what was found to docs/benchmarks/kills.json and docs/kills.md; with `--first 240` it adds the
missions from 240 on to the 240 that are there. Each mission is written as soon as it and all before it have ended, so
an interruption loses none. The kills of a mission follow from its number and the seed; the moments at which they hit
the nodes do not.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import xmlrpc.client
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

from benchmarks.families import FAMILIES
from benchmarks.kills_page import BAD, OTHERS, RULES, UNTIL, WORD, Mission, mismatch, page, results, together
from benchmarks.lab_scenarios import lab_scenario
from benchmarks.ordinary_families import ORDINARY
from benchmarks.ros_world import NO_ANSWER, ROOT, Hasty, World, generated, world
from benchmarks.second_recorder import NAME, bag_of, command, heard_in, merged, topics_of, with_heard
from benchmarks.synthesis import machine, version
from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.replay import Findings, check, game_of, read_recording
from pursue_gen.tools.replay.finding import FAULT, UNRECORDED, WORLD
from pursue_gen.tools.replay.game import Game, from_workspace
from pursue_gen.tools.replay.journal import Journal
from pursue_runtime.event_words import EVENTS, FINISH
from pursue_runtime.observer.records import MARK

SCENARIOS = ("thesis/scenario_1", "thesis/scenario_4", "thesis/catch_the_thief", "patterns/strict_ordered_visit")
LONGEST = 240.0
"""Seconds of real time after which a mission is ended from outside."""


class Kill(NamedTuple):
    """A node to kill, so many seconds after the mission began."""

    after: float
    node: str


HELD = "the mission holds"
"""How what replay says of a hold begins."""

READY = 60.0
"""Seconds within which the second recorder has to be there."""

def text_of(name: str) -> str:
    """Return the text of a scenario: a file of scenarios/, a lab scenario (lab/17), a member of a family (corridor/4).
    Raises SystemExit where there is none."""
    kind, _, size = name.rpartition("/")
    made = {**{family.name: family.text for family in (*FAMILIES, *ORDINARY)}, "lab": lab_scenario}
    file = ROOT / "scenarios" / f"{name}.pur"
    if kind in made and size.isdecimal():
        return made[kind](int(size))
    if not file.is_file():
        raise SystemExit(f"there is no scenario {name}: name a file of scenarios/, lab/SEED or FAMILY/SIZE")
    return file.read_text(encoding="utf-8")


def draw(seed: int, number: int, nodes: Sequence[str], length: float) -> List[Kill]:
    """Return the kills of a mission: one to four, within `length` seconds, of any nodes but the recorder."""
    source = random.Random(f"{seed}/{number}")
    count = source.choice((1, 1, 2, 2, 3, 4))
    moments = sorted(source.uniform(0.0, length) for _ in range(count))
    kills = [Kill(moment, source.choice(nodes)) for moment in moments]
    if source.random() < 0.2:  # two at the same moment
        kills.append(Kill(moments[-1], source.choice(nodes)))
    return kills


def process_of(uri: str, node: str) -> int:
    """Return the process of a node as it says itself; 0 where none answers."""
    with contextlib.suppress(*NO_ANSWER):
        with xmlrpc.client.ServerProxy(uri, transport=Hasty()) as master:
            found: Any = master.lookupNode("/kills", f"/{node}")
        if found[0] == 1:
            with xmlrpc.client.ServerProxy(str(found[2]), transport=Hasty()) as slave:
                answer: Any = slave.getPid("/kills")
            return int(answer[2])
    return 0


def subscribed(uri: str, node: str) -> Set[str]:
    """Return the topics to which a node has subscribed, as the master has them."""
    with xmlrpc.client.ServerProxy(uri, transport=Hasty()) as master:
        state: Any = master.getSystemState("/kills")
    return {topic for topic, nodes in state[2][1] if f"/{node}" in nodes}


def start_second(there: World, file: Path, game: Game) -> None:
    """Start the second recorder; return when it has subscribed. Raises SystemExit where it does not come up."""
    topics = topics_of(agent.name for agent in game.scenario.agents if agent.is_robot)
    second = there.start("second", command(file, topics))
    deadline = time.monotonic() + READY
    while not set(topics) <= subscribed(there.variables["ROS_MASTER_URI"], NAME):
        if second.poll() is not None or time.monotonic() > deadline:
            raise SystemExit(f"the second recorder does not come up: {there.log('second')}")
        time.sleep(0.05)


def play(there: World, workspace: Path, kills: Sequence[Kill], bag: Path, unit: float, seed: int, ends: bool) -> None:
    """Play one mission to its end, with these kills; it is recorded in `bag`. One that does not end by itself is ended
    after UNTIL time units."""
    bringup = next((workspace / "src").glob("*_bringup")).name
    given = f"record:={bag} time_unit:={unit} seed:={seed}"
    command = f"source {workspace}/devel/setup.bash; exec roslaunch --skip-log-check {bringup} mission.launch {given}"
    launch = there.start("roslaunch", ["bash", "-c", command])
    deadline = time.monotonic() + LONGEST
    while "the mission runs" not in there.log("roslaunch") and launch.poll() is None and time.monotonic() < deadline:
        time.sleep(0.05)
    begin = time.monotonic()
    for kill in kills:
        with contextlib.suppress(subprocess.TimeoutExpired):
            launch.wait(max(0.0, begin + kill.after - time.monotonic()))
            break  # the mission is over
        process = process_of(there.variables["ROS_MASTER_URI"], kill.node)
        with contextlib.suppress(ProcessLookupError):
            if process:
                os.kill(process, signal.SIGKILL)
    with contextlib.suppress(subprocess.TimeoutExpired):
        if not ends:
            with contextlib.suppress(subprocess.TimeoutExpired):
                launch.wait(max(0.0, begin + UNTIL * unit - time.monotonic()))
            # again and again: the observer may be away
            there.start("finish", ["rostopic", "pub", "-r", "1", f"/{EVENTS}", "std_msgs/String", FINISH])
        launch.wait(max(0.0, deadline - time.monotonic()))
    there.stop(*(name for name in ("roslaunch", "finish") if name in there.running))


_worlds: Set[World] = set()
"""Those of the missions that are under way."""

_ends = threading.Event()
"""Set when no mission is to go on."""


@contextlib.contextmanager
def _open(there: World) -> Iterator[None]:
    """A world is there whose processes have to end with this program. Raises SystemExit where that ends already."""
    _worlds.add(there)
    try:
        if _ends.is_set():
            raise SystemExit(1)
        yield
    finally:
        _worlds.discard(there)


@contextlib.contextmanager
def _ending_all() -> Iterator[None]:
    """Whatever goes wrong, a signal too, ends the processes of all missions: their threads would wait for them."""
    _ends.clear()
    try:
        yield
    except BaseException:
        _ends.set()
        for there in list(_worlds):
            there.stop()
        raise


def judge(bag: Path, second: Path, journals: Iterable[Path], game: Game) -> Tuple[str, str, Tuple[str, ...]]:
    """Return a word of OUTCOMES and why, and what both recorders have missed: from what either of them has, the words
    that the observer has heard, and the workspace's strategy alone."""
    try:
        record, other = (read_recording(bag_of(path)) for path in (bag, second))
    except PursueError as problem:
        return "no end", f"a recorder has nothing: {problem}", ()
    assert not isinstance(record, Journal) and not isinstance(other, Journal)
    whole, gaps = with_heard(merged(record, other), heard_in(journals))
    findings = check(whole, game)
    missed = [f"{WORD} {word.text}" for word in gaps]
    missed += [f"state {each.seq}: {each.text}" for each in findings.findings if each.kind == "acknowledged"]
    return (*outcome(findings), tuple(missed))


def outcome(findings: Findings) -> Tuple[str, str]:
    """Return a word of OUTCOMES for what was found in the recordings, and why. Every fault counts, and so does what was
    not recorded: an order that nobody has recorded or acknowledged reached no robot."""
    faults = [each for each in findings.findings if each.level in (FAULT, UNRECORDED)]
    if faults:
        return "wrong", f"state {faults[0].seq}: {faults[0].text}"
    if findings.won:
        return "goal", ""
    if findings.status == "stopped":
        return "stopped", findings.reason
    if findings.status != "lost":
        return "no end", findings.status
    late = [each for each in findings.findings if (each.level, each.kind) == (WORLD, "late")]
    held = [each for each in findings.findings if each.kind == "hold"]  # it holds, or goes on
    why = late[:1] or [each for each in held[-1:] if each.text.startswith(HELD)]
    return ("lost", f"{why[0].text}; {findings.reason}") if why else ("wrong", "the mission was lost")


def mission(
    number: int, seed: int, workspaces: Sequence[Tuple[str, Path, Game]], unit: float, keep: Optional[Path]
) -> Mission:
    """Play and judge one mission on a master of its own; one without goal leaves its files in `keep`."""
    scenario, workspace, game = workspaces[number % len(workspaces)]
    nodes = ["observer", "UI", "simulator", *(folder.name for folder in (workspace / "src").glob("controller*"))]
    ends = bool(game.objective.goal)
    kills = draw(seed, number, sorted(nodes), (40.0 if scenario in OTHERS else 20.0) * unit)
    with tempfile.TemporaryDirectory(prefix="kills_") as home, world(Path(home)) as there, _open(there):
        bag, second = Path(home) / "mission.bag", Path(home) / "second.bag"
        start_second(there, second, game)
        play(there, workspace, kills, bag, unit, number, ends)
        there.stop("second")
        journals = sorted(path for path in Path(home).glob("pursue/*/journal-*") if path.suffix != MARK)
        found, why, missed = judge(bag, second, journals, game)
        if found in BAD:
            print(there.log("roslaunch")[-6000:], flush=True)
        if found != "goal" and keep:
            shutil.copytree(home, keep / f"mission_{number}", dirs_exist_ok=True)
    killed = tuple(f"{kill.node} after {kill.after:.2f} s" for kill in kills)
    return Mission(number, scenario, found, why, killed, missed)


def measure(
    numbers: Sequence[int], seed: int, jobs: int, unit: float, names: Sequence[str], keep: Optional[Path] = None
) -> Iterator[Mission]:
    """Play and judge the missions with these numbers, `jobs` at a time; each as soon as it and all before it ended."""
    with tempfile.TemporaryDirectory(prefix="kills_ws_") as home, ThreadPoolExecutor(jobs) as pool:
        workspaces = []
        for name in names:
            short = re.sub(r"\W+", "_", name)
            workspace = generated(text_of(name), short, Path(home) / short, RULES)
            workspaces.append((name, workspace, game_of(from_workspace(workspace))))
        with _ending_all():
            for each in pool.map(lambda number: mission(number, seed, workspaces, unit, keep), numbers):
                kills = ", ".join(each.kills)
                print(f"{each.number:4} {each.scenario:30} {each.outcome:8} {each.why} [{kills}]", flush=True)
                for what in each.missed:
                    print(f"     both recorders have missed: {what}", flush=True)
                yield each


def options() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(description="Plays missions on ROS whose nodes are killed, and judges them.")
    parser.add_argument("--missions", type=int, default=300, help="so many (300)")
    parser.add_argument("--first", type=int, default=0, metavar="NUMBER", help="the number of the first one (0)")
    parser.add_argument("--seed", type=int, default=1, help="of the kills (1)")
    parser.add_argument("--jobs", type=int, default=2, help="missions at a time (2)")
    parser.add_argument("--unit", type=float, default=0.5, help="seconds per time unit (0.5)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write kills.md and benchmarks/kills.json there")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="copy bags and logs of missions without goal there")
    parser.add_argument("--machine", default=machine(), help="how the results name the machine")
    parser.add_argument("--date", default=datetime.date.today().isoformat(), help="how they give the date (today)")
    what = "as thesis/scenario_1, lab/17, corridor/4"
    parser.add_argument("scenarios", nargs="*", default=SCENARIOS, metavar="SCENARIO", help=what)
    return parser


def _leave(*_: object) -> None:
    """SIGTERM: leave no process behind; what comes after the first one does not disturb that."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    sys.exit(1)


def main() -> int:
    """Play, judge, print, and write; the exit status is 1 where a mission was wrong or had no end."""
    from pursue_gen.files import write_texts

    given = options().parse_args()
    signal.signal(signal.SIGTERM, _leave)
    kept = given.out / "benchmarks" / "kills.json" if given.out else None
    before = json.loads(kept.read_text(encoding="utf-8")) if kept and given.first else None
    part = {"first": given.first, "date": given.date, "commit": version()}
    head = {"seed": given.seed, "unit": given.unit, "machine": given.machine, "parts": [part]}
    if before and mismatch(before, head):
        options().error(mismatch(before, head))

    def so_far(done: Sequence[Mission]) -> Dict[str, Any]:
        found = {**results(done), **head, "parts": [{**part, "missions": len(done)}]}
        return together(before, found) if before else found

    done: List[Mission] = []
    numbers = range(given.first, given.first + given.missions)
    for each in measure(numbers, given.seed, given.jobs, given.unit, given.scenarios, given.keep):
        done.append(each)
        if kept:  # at once, so that an interruption loses nothing
            found = so_far(done)
            write_texts({kept: json.dumps(found, indent=1) + "\n", given.out / "kills.md": page(found)})
    print(page(so_far(done)))
    return 1 if so_far(done)["bad"] else 0


if __name__ == "__main__":
    sys.exit(main())
