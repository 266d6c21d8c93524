"""Patterns, stories, statements and crowds on ROS, each once in its workspace: `python -m benchmarks.missions`.

`--out docs` writes how they ended to docs/benchmarks/missions.json, which `python -m docs.patterns.make` shows. What is
named (`patterns/visit`) is played alone, and replaces what is there of it. Missions run one after the other, in
simulated time. Each is recorded, and judged from the bag and the workspace's strategy alone, as `pursue-gen replay`
does.
"""

from __future__ import annotations

import argparse
import datetime
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Iterator, List, NamedTuple, Sequence, Tuple

from benchmarks.families import FAMILIES
from benchmarks.kills import outcome
from benchmarks.ros_world import ROOT, World, world
from benchmarks.synthesis import machine, version
from pursue_gen.files import write_texts
from pursue_gen.language import load, parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.request import SolveRequest
from pursue_gen.tools.replay import check, game_of, read_recording
from pursue_gen.tools.replay.game import from_workspace
from pursue_gen.tools.replay.journal import Journal
from pursue_gen.workspace import Options, write_workspace
from pursue_gen.workspace.packages import SHARED

FOLDERS = ("patterns", "industry")
STATEMENTS = {
    "assume: not (…)": "museum/shy_robot",
    "battery": "museum/battery_watch",
    "collaborative together, if … then": "airport/two_carts",
    "label, decimals": "hotel/parcel",
    "optional": "office/errands",
    "patrol without every": "museum/best_watch",
    "rule … for each robot": "hotel/laundry",
    "together only_if, travel … takes": "hotel/late_supper",
}
"""One scenario for each statement that neither patterns nor stories play, which is won because of it."""

CROWDS = {"families/delivery_8": ("delivery", 8), "families/visitors_3": ("visitors", 3)}
"""Members of the benchmarks' families that are won in stages: the name of the family, the size."""

REQUEST = SolveRequest(reaction="0.1")
FILE = "missions.json"

UNIT, SPEED = 2.0, 4
"""Simulated seconds per time unit, and per second: half a second per time unit, a twentieth for a command."""

UNTIL = 40.0
"""Time units after which a mission without a goal is ended from outside."""

LONGEST = 180.0
"""Seconds of real time after which a mission is given up."""

GOAL, SAFE = "goal", "safe"
"""How missions end that keep to everything: with the goal, or still running where there is none."""


class Mission(NamedTuple):
    """How a mission ended: GOAL, SAFE or a word of `benchmarks.kills`; why; how many events it had."""

    outcome: str
    why: str
    events: int


def names() -> List[str]:
    """All that are played, in order."""
    files = (path for folder in FOLDERS for path in sorted((ROOT / "scenarios" / folder).glob("*.pur")))
    return [*(f"{path.parent.name}/{path.stem}" for path in files), *sorted(STATEMENTS.values()), *CROWDS]


def scenario_of(name: str) -> Scenario:
    """The scenario of that name, its patrols with periods. Raises PursueError where it has errors."""
    if name not in CROWDS:
        return settled(load(ROOT / "scenarios" / f"{name}.pur"), REQUEST)
    member, size = CROWDS[name]
    text = next(family.text(size) for family in FAMILIES if family.name == member)
    title = name.rpartition("/")[2]
    return settled(parse(text, f"{title}.pur", title), REQUEST)


def build(workspace: Path, common: Path) -> None:
    """Has its nodes run from their sources over the packages that all have in common, which are built at first."""
    if not common.is_dir():
        for package in SHARED:
            shutil.copytree(workspace / "src" / package, common / "src" / package)
        done = subprocess.run(["catkin_make", "-C", str(common)], capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"catkin_make fails: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    for package in SHARED:
        (workspace / "src" / package / "CATKIN_IGNORE").touch()
    (workspace / "devel").mkdir()
    setup = f"source {common}/devel/setup.bash\nexport ROS_PACKAGE_PATH={workspace}/src:$ROS_PACKAGE_PATH\n"
    (workspace / "devel" / "setup.bash").write_text(setup, encoding="utf-8")


def play(there: World, workspace: Path, bag: Path, ends: bool) -> None:
    """Plays one mission to its end, or for UNTIL time units where it has none; it is recorded in `bag`."""
    bringup = next((workspace / "src").glob("*_bringup")).name
    given = f"record:={bag} time_unit:={UNIT} use_sim_time:=true speed:={SPEED} planner:=off"
    command = f"source {workspace}/devel/setup.bash; exec roslaunch --skip-log-check {bringup} mission.launch {given}"
    launch = there.start("roslaunch", ["bash", "-c", command])
    deadline = time.monotonic() + LONGEST
    while "the mission runs" not in there.log("roslaunch") and launch.poll() is None and time.monotonic() < deadline:
        time.sleep(0.1)
    if not ends:
        deadline = min(deadline, time.monotonic() + UNTIL * UNIT / SPEED)
    while launch.poll() is None and time.monotonic() < deadline:
        time.sleep(0.1)
    there.stop("roslaunch")


def judge(bag: Path, workspace: Path, ends: bool) -> Mission:
    """How the mission of this bag ended."""
    found = next((path for path in (bag, Path(f"{bag}.active")) if path.is_file()), None)
    if found is None:
        return Mission("no end", "nothing was recorded", 0)
    record = read_recording(found)
    assert not isinstance(record, Journal)
    findings = check(record, game_of(from_workspace(workspace)))
    word, why = outcome(findings)
    events = len({state.seq for state in record.states if state.event})
    return Mission(SAFE if word == "no end" and why == "running" and not ends else word, why, events)


def measure(chosen: Sequence[str]) -> Iterator[Tuple[str, Mission]]:
    """Plays and judges these, one after the other."""
    with tempfile.TemporaryDirectory(prefix="missions_ws_") as home:
        for name in chosen:
            promise = promised_of(scenario_of(name), REQUEST)
            scenario, won = promise.scenario, promise.solution
            folder, options = Path(home) / scenario.name, Options(reaction=won.rules.reaction)
            workspace = write_workspace(scenario, won.network, won.objective, won.strategy, options, folder)
            build(workspace, Path(home) / "common")
            with tempfile.TemporaryDirectory(prefix="missions_") as place, world(Path(place)) as there:
                play(there, workspace, Path(place) / "mission.bag", bool(scenario.reach))
                found = judge(Path(place) / "mission.bag", workspace, bool(scenario.reach))
                if found.outcome not in (GOAL, SAFE):
                    print(there.log("roslaunch")[-3000:], flush=True)
            shutil.rmtree(folder)
            yield name, found


def keep(file: Path, name: str, found: Mission) -> None:
    """Writes how a mission ended to the file, beside those that are there."""
    before = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {"missions": {}}
    result = {**found._asdict(), "date": f"{datetime.date.today()}", "version": version()}
    missions = {each: there for each, there in {**before["missions"], name: result}.items() if each in names()}
    data = {"machine": machine(), "missions": dict(sorted(missions.items()))}
    write_texts({file: json.dumps(data, indent=1, ensure_ascii=False) + "\n"})


def main(arguments: Sequence[str]) -> int:
    """Plays what is named, or all; status 1 where one did not keep to everything."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="folder/scenario; all where none is named")
    parser.add_argument("--out", type=Path, help="the folder whose benchmarks/missions.json gets the results")
    given = parser.parse_args(arguments)
    bad = 0
    for name, found in measure(given.names or names()):
        print(f"{name:36} {found.outcome:8} {found.events:4} events {found.why}", flush=True)
        bad += found.outcome not in (GOAL, SAFE)
        if given.out is not None:
            keep(given.out / "benchmarks" / FILE, name, found)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
