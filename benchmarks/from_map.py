"""From a map to missions, by the documented commands alone: `python -m benchmarks.from_map`.

A floor of three rooms, two robots, a scenario of first guesses: `pursue-gen survey`, `ws`, `rosrun UI drive_legs`,
`pursue-gen calibrate`, `ws` again, and then the missions that count. No number is edited in between. The robots are
fakes of move_base that drive on the map; their speeds, accelerations, turning and planning times and the durations of
their actions are drawn from a seed, and all times vary. Each of the seeds is another pair of robots. `--out docs`
writes what was found to docs/benchmarks/from_map.json, and the tables in docs/robots.md.

All runs in simulated time; commands have the time that they have in life, as the clock stands still after messages.
"""

from __future__ import annotations

import argparse
import datetime
import json
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from random import Random
from typing import Any, Dict, List, NamedTuple, Sequence, Tuple

import yaml

from benchmarks.kills import outcome
from benchmarks.robots_on_map import nature
from benchmarks.ros_world import ROOT, World, world
from benchmarks.synthesis import machine, version
from benchmarks.tables import markdown
from pursue_gen.files import write_texts
from pursue_gen.language import load
from pursue_gen.tools.replay import check, game_of, read_recording
from pursue_gen.tools.replay.finding import WORLD
from pursue_gen.tools.replay.game import from_workspace
from pursue_gen.tools.replay.journal import Journal
from pursue_runtime.drives.report import ARRIVED
from pursue_runtime.state import RUNNING

MAP = ROOT / "docs" / "survey" / "three_rooms.yaml"
RADIUS = 0.3

SCENARIO = """\
// Two robots on a floor of three rooms. All numbers are first guesses.
poi "desk"  //[1.0, 1.0, 0, 0, 0, 0, 1]
poi "hall"  //[6.0, 2.5, 0, 0, 0, 0, 1]
poi "shelf" //[11.0, 5.0, 0, 0, 0, 0.7071, 0.7071]

connect desk and hall distance 7
connect hall and shelf distance 6

event "fetch" location shelf duration 3
event "drop" location desk duration 3
event "inspect" location shelf duration 3

rule "parcel": fetch before drop

agent "bot1" controllable mobile 3 location desk can_do fetch, drop
agent "bot2" controllable mobile 3 location hall can_do inspect

objective: bot1 never_with bot2 at shelf
reach_objective: do drop and inspect within 300
"""

SPEED = 0.5
"""Metres per second: what both robots' data sheets say."""

DRIVES_SPEED, MISSION_SPEED = 8, 4
"""Simulated seconds per second."""

BESIDE, ASKEW = 0.1, 0.3
"""Metres and radians by which robots stand beside their places when a mission begins."""

LONGEST = {"drives": 1800.0, "mission": 300.0}
"""Seconds of real time after which it is given up."""

FILE = "from_map.json"
_PART = re.compile(r"(<!-- measured: from_map -->\n)(.*?)(<!-- end -->)", re.DOTALL)


class Mission(NamedTuple):
    """How a mission ended (a word of `benchmarks.kills.OUTCOMES`) and why, after how many time units, and where the
    world left the model."""

    outcome: str
    why: str
    seconds: float
    left: Tuple[str, ...]


class Story:
    """A person with a map and two robots; `steps` has each command and how long it took, in seconds."""

    def __init__(self, home: Path, seed: int) -> None:
        self.home, self.seed = home, seed
        self.steps: List[Tuple[str, float]] = []
        events = [event.name for event in load(self.write("my_floor.pur", SCENARIO)).events]
        self.robots = {name: nature(Random(f"{seed} {name}"), events) for name in ("bot1", "bot2")}
        for file in MAP.parent.glob("three_rooms.*"):
            if file.suffix != ".pur":
                shutil.copy(str(file), str(home / file.name.replace("three_rooms.yaml", "map.yaml")))

    def write(self, name: str, text: str) -> Path:
        """A file of this person."""
        (self.home / name).write_text(text, encoding="utf-8")
        return self.home / name

    def command(self, text: str) -> str:
        """Runs a command to its end, and returns what it says. Raises SystemExit where it fails."""
        start = time.monotonic()
        shell = ["bash", "-c", f"cd {shlex.quote(str(self.home))} && {text}"]
        done = subprocess.run(shell, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self._say(text, time.monotonic() - start)
        if done.returncode:
            raise SystemExit(f"{text} fails: {done.stdout}")
        return done.stdout

    def workspace(self, scenario: str, folder: str) -> str:
        """Generates a workspace and builds it; what `ws` says."""
        said = self.command(f"pursue-gen ws {scenario} -o {folder} --map map.yaml")
        self.command(f"catkin_make -C {folder}")
        return said

    def drives(self, folder: str, times: int) -> Path:
        """Has both robots drive all ways, and do their actions, so often; the bag."""
        with world(self.home) as there:
            self.place_robots(there, folder, "drives")
            self._start(there, "sim_clock", folder, f"rosrun UI sim_clock _speed:={DRIVES_SPEED} _step:=0.05")
            while "/sim_clock" not in there.run(["rosnode", "list"]).stdout:
                time.sleep(0.2)
            # The clock runs no faster than life before the first word of a mission.
            there.run(["rostopic", "pub", "--once", "/pursue/events", "std_msgs/String", "faster"])
            command = f"rosrun UI drive_legs _times:={times} _actions:={times}"
            self._start(there, "drive_legs", folder, command)
            self._wait(there, "drive_legs", command, LONGEST["drives"])
            print(there.log("drive_legs")[-1500:], flush=True)
        return next((self.home / "pursue").glob("*/drives.bag"))

    def mission(self, folder: str, name: str) -> Path:
        """Plays a mission; its bag."""
        bag = self.home / f"{name}.bag"
        with world(self.home) as there:
            self.place_robots(there, folder, name)
            bringup = next((self.home / folder / "src").glob("*_bringup")).name
            command = f"roslaunch {bringup} mission.launch simulate:=false record:="
            self._start(there, "roslaunch", folder, f"{command}{bag} use_sim_time:=true speed:={MISSION_SPEED}")
            self._wait(there, "roslaunch", f"{command}{bag.name}", LONGEST["mission"])
            self.write(f"{name}.txt", there.log("roslaunch"))
        return bag

    def place_robots(self, there: World, folder: str, seed: str) -> None:
        """Brings the robots to where the mission begins, as exactly as a person does, and switches them on."""
        random, scenario = Random(f"{self.seed} {seed}"), load(next(self.home.glob("my_floor.pur")))
        robots: Dict[str, Any] = {}
        for agent in scenario.agents:
            poses = self.home / folder / "src" / f"controller_{agent.name}" / "config" / "poses.yaml"
            x, y = yaml.safe_load(poses.read_text(encoding="utf-8"))["poses"][agent.location.name][:2]
            start = [x + random.uniform(-BESIDE, BESIDE), y + random.uniform(-BESIDE, BESIDE)]
            described = {**vars(self.robots[agent.name]), "acts": dict(self.robots[agent.name].acts)}
            robots[agent.name] = {"start": [*start, random.uniform(-ASKEW, ASKEW)], "nature": described}
        there.run(["rosparam", "set", "/use_sim_time", "true"])
        given = {"map": str(self.home / "map.yaml"), "radius": RADIUS, "seed": f"{self.seed} {seed}", "robots": robots}
        there.run(["rosparam", "set", "/fake_move_base", json.dumps(given)])
        there.start("robots", [sys.executable, "-m", "benchmarks.robots_on_map_node"])

    def _start(self, there: World, name: str, folder: str, command: str) -> None:
        """Starts a command of a workspace."""
        sourced = f"source {shlex.quote(str(self.home / folder))}/devel/setup.bash; exec {command}"
        there.start(name, ["bash", "-c", sourced], PYTHONUNBUFFERED="1")

    def _wait(self, there: World, name: str, command: str, limit: float) -> None:
        """Waits until a process has ended, and ends it after so many seconds."""
        start = time.monotonic()
        while there.running[name].poll() is None and time.monotonic() < start + limit:
            time.sleep(0.2)
        self._say(command, time.monotonic() - start)
        there.stop(name)

    def _say(self, what: str, seconds: float) -> None:
        self.steps.append((what, round(seconds, 1)))
        print(f"{seconds:7.1f} s  {what}", flush=True)


def judge(bag: Path, workspace: Path) -> Mission:
    """How the mission of this bag ended, by the bag and the workspace's strategy alone."""
    found = next((path for path in (bag, Path(f"{bag}.active")) if path.is_file()), None)
    if found is None:
        return Mission("no end", "nothing was recorded", 0.0, ())
    record = read_recording(found)
    assert not isinstance(record, Journal)
    findings = check(record, game_of(from_workspace(workspace)))
    word, why = outcome(findings)
    left = tuple(finding.text for finding in findings.findings if finding.level == WORLD)
    running = [state for state in record.states if state.status == RUNNING]
    took = (record.states[-1].stamp - running[0].stamp) / running[0].unit if running else 0.0
    return Mission(word, why, round(took, 1), left)


def driven(bag: Path) -> Dict[str, float]:
    """How many drives and actions are in a bag, how many of them failed, and the minutes of the robots' time that all
    took."""
    record = read_recording(bag, drives=True)
    assert not isinstance(record, Journal)
    drives = record.drives
    minutes = (drives[-1].end - drives[0].start) / 60
    failed = sum(each.outcome != ARRIVED for each in drives)
    actions = sum(bool(each.action) for each in drives)
    return {"drives": len(drives) - actions, "actions": actions, "failed": failed, "minutes": round(minutes, 1)}


def windows(scenario: Path) -> Dict[str, str]:
    """The window of each way and event of a scenario, as it stands there."""
    text = scenario.read_text(encoding="utf-8")
    travel = re.findall(r"^travel (\w+ from \w+ to \w+) takes (\S+ to \S+)", text, re.MULTILINE)
    return dict([*re.findall(r'^event "(\w+)".* duration (\S+(?: to \S+)?)', text, re.MULTILINE), *travel])


def played(home: Path, seed: int, times: int, missions: int) -> Dict[str, Any]:
    """The whole story of one pair of robots, in a folder of its own; what docs/benchmarks/from_map.json has of it."""
    story = Story(home, seed)
    story.command(f"pursue-gen survey map.yaml my_floor.pur --speed {SPEED}")
    story.workspace("my_floor_surveyed.pur", "first_ws")
    drives = story.drives("first_ws", times)
    copy = "my_floor_calibrated.pur"
    print(story.command(f"pursue-gen calibrate my_floor_surveyed.pur {drives} -o {copy}"), flush=True)
    said = story.workspace(copy, "ws")
    found = []
    for number in range(1, missions + 1):
        name = f"mission_{number}"
        found.append(judge(story.mission("ws", name), home / "ws"))
        print(*found[-1], sep="; ", flush=True)
    promised = re.search(r"Time to the goal: at most (\S+) time units", said)
    before, after = windows(home / "my_floor_surveyed.pur"), windows(home / copy)
    return {
        "seed": seed,
        "times": times,
        "robots": {name: {**vars(robot), "acts": dict(robot.acts)} for name, robot in story.robots.items()},
        "steps": [[text.replace(f"{home}/", ""), seconds] for text, seconds in story.steps],
        "driven": driven(drives),
        "windows": {what: [before.get(what, ""), window] for what, window in after.items()},
        "promised": float(promised[1]) if promised else None,
        "missions": [mission._asdict() for mission in found],
    }


def tables(data: Dict[str, Any]) -> str:
    """What was found with each pair of robots, side by side: the windows, and the missions."""
    pairs = data["pairs"]
    guess, *_ = pairs
    heads = ("way or event", "first guess, survey", *(f"calibrated, seed {pair['seed']}" for pair in pairs))
    rows = [(what, before, *(pair["windows"][what][1] for pair in pairs)) for what, (before, _) in
            guess["windows"].items()]  # fmt: skip
    text = markdown(heads, rows, left=len(heads))
    lines = []
    for pair in pairs:
        for number, mission in enumerate(pair["missions"], start=1):
            left = "; ".join(mission["left"]) or mission["why"] or "nothing"
            promised = f"{pair['promised']:.0f}" if pair["promised"] is not None else "none"
            took = f"{mission['seconds']:.0f}"
            lines.append((str(pair["seed"]), str(number), mission["outcome"], left, took, promised))
    heads = ("seed", "mission", "end", "what left the model", "time units", "promised")
    return text + "\n" + markdown(heads, lines, left=4)


def filled(page: str, data: Dict[str, Any]) -> str:
    """The page with these tables."""
    return _PART.sub(lambda match: f"{match[1]}\n{tables(data)}\n{match[3]}", page)


def main(arguments: Sequence[str]) -> int:
    """Plays the story; status 1 where a mission was not won."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=10, help="how many count (10)")
    parser.add_argument("--times", type=int, default=10, help="how often each way is driven before (10)")
    seeds = "of the robots, and of all that varies: a pair of robots each (1 2)"
    parser.add_argument("--seed", type=int, nargs="+", default=[1, 2], help=seeds)
    parser.add_argument("--keep", type=Path, help="an empty folder for everything that is written on the way")
    parser.add_argument("--out", type=Path, help="the folder of robots.md and benchmarks/from_map.json")
    given = parser.parse_args(arguments)
    pairs = []
    with tempfile.TemporaryDirectory(prefix="from_map_") as place:
        for seed in given.seed:
            home = (given.keep or Path(place)).resolve() / f"seed_{seed}"
            home.mkdir(parents=True)
            pairs.append(played(home, seed, given.times, given.missions))
    data = {"machine": machine(), "date": f"{datetime.date.today()}", "version": version(), "pairs": pairs}
    print(tables(data))
    if given.out is not None:
        page = given.out / "robots.md"
        texts = {page: filled(page.read_text(encoding="utf-8"), data)}
        write_texts({**texts, given.out / "benchmarks" / FILE: json.dumps(data, indent=1, ensure_ascii=False) + "\n"})
    return int(any(mission["outcome"] != "goal" for pair in pairs for mission in pair["missions"]))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
