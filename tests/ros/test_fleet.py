"""A mission is sent from a desk to three robots and a base, each a machine of its own (a network namespace with its own
ROS_HOME): it is played, replaced by another one, rolled back; and nothing changes anywhere while one of them is away.
"""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, Iterator, List

import pytest
from launched_mission import ready
from ros_world import PUBLISH_EVENT, Ros, make
from test_links import Nodes, nodes, until

from pursue_gen.language import load
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace
from tests.namespaces import Lab, lab, why_not
from tests.waiting import PATIENCE

pytestmark = [pytest.mark.ros, pytest.mark.skipif(bool(why_not()), reason=why_not())]

MACHINES = {
    "base": "observer UI simulator controllerObj",
    "bot1": "controller_bot1",
    "bot2": "controller_bot2",
    "bot3": "controller_bot3",
}
UNIT = 0.5
"""Seconds per time unit."""

COMMAND = 2.0
"""Seconds between two commands that only ask: each keeps a processor busy that the robots wait for."""

WAIT = f"--wait {PATIENCE}"
UNCHANGED = 7

FIRST = """
// bot1 looks at a, then bot2 at b, then bot3 at c.
poi "home" //[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "a"    //[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "b"    //[0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "c"    //[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
connect home and a distance 1
connect home and b distance 1
connect home and c distance 1
event "lookA" location a duration 2
event "lookB" location b duration 2
event "lookC" location c duration 2
rule "inTurn": (lookA before lookB) before lookC
agent "bot1" controllable mobile 1 location home can_do lookA
agent "bot2" controllable mobile 1 location home can_do lookB
agent "bot3" controllable mobile 1 location home can_do lookC
reach_objective: do lookC
"""

SECOND = """
// Another building: bot3 looks at z, then bot1 at x; bot2 stays where it is.
poi "x" //[5.0, 5.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "y" //[6.0, 5.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "z" //[7.0, 5.0, 0.0, 0.0, 0.0, 0.0, 1.0]
connect x and y distance 1
connect y and z distance 1
event "seeX" location x duration 2
event "seeY" location y duration 2
event "seeZ" location z duration 2
rule "inTurn": seeZ before seeX
agent "bot1" controllable mobile 1 location y can_do seeX
agent "bot2" controllable mobile 1 location y can_do seeY
agent "bot3" controllable mobile 1 location y can_do seeZ
reach_objective: do seeX
"""


class Fleet:
    """The desk's commands, and what is to be seen on the machines."""

    def __init__(self, ros: Ros, made: Nodes, rooms: Lab, folder: Path) -> None:
        self.made, self.rooms, self.folder = made, rooms, folder
        self._ros = ros

    def home(self, machine: str) -> Path:
        """Its ROS_HOME."""
        return self.folder / "homes" / machine

    def desk(self, command: str, status: int = 0) -> str:
        """What a command of pursue-gen prints on the desk; it has to end with this status."""
        done = self.tried(command)
        told = f"{command}: {done.returncode}\n{done.stdout}{done.stderr}\n{self.made.logs()}"
        assert done.returncode == status, told
        return done.stdout

    def tried(self, command: str) -> "subprocess.CompletedProcess[str]":
        """A command of pursue-gen on the desk, whatever becomes of it."""
        program = Path(sys.executable).parent / "pursue-gen"
        inside = ["ip", "netns", "exec", self.rooms.space("desk"), str(program), *shlex.split(command)]
        place = {**self._ros.environment, "XDG_CONFIG_HOME": str(self.folder / "desk")}
        return subprocess.run(
            inside, cwd=self.folder, env=place, capture_output=True, text=True, timeout=3 * PATIENCE, check=False
        )

    def serves(self) -> bool:
        """True where all machines answer the desk."""
        return self.tried("send --status --to robots.yaml").returncode == 0

    def state(self, machine: str) -> Dict[str, Any]:
        """Which missions it has."""
        path = self.home(machine) / "pursue" / "missions" / "state.json"
        found: Dict[str, Any] = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"current": ""}
        return found

    def current(self) -> Dict[str, str]:
        """machine → the mission that it has switched to."""
        return {machine: self.state(machine)["current"] for machine in MACHINES}

    def files(self) -> List[str]:
        """All files of the stores, with what is in them."""
        found = []
        for machine in MACHINES:
            folder = self.home(machine) / "pursue" / "missions"
            found += [f"{path}: {path.read_text()}" for path in sorted(folder.rglob("*")) if path.is_file()]
        return found

    def said(self, text: str) -> int:
        """How often the base's UI has said so."""
        return self.made.log("base").count(text)

    def play(self, scenario: str) -> None:
        """Starts the mission of this scenario, and waits for its goal."""
        won = self.said("The goal is reached")
        self.start(scenario)
        until(lambda: self.said("The goal is reached") > won, self.made.logs)

    def start(self, scenario: str) -> None:
        """Says _start_ once every node is ready for the mission of this scenario."""
        runs = self.said("the mission runs")
        switched = f"has its part in mission {self.current()['base'][:12]}"

        def is_ready() -> bool:
            _, found, since = self.made.log("base").rpartition(switched)  # what was said before is of another mission
            return bool(found) and ready(since, scenario)

        until(is_ready, self.made.logs)
        self.made.start("start", f"exec python3 {PUBLISH_EVENT} _start_", "desk")
        until(lambda: self.said("the mission runs") > runs, self.made.logs)

    @contextlib.contextmanager
    def unfinished(self, robot: str) -> Iterator[None]:
        """Meanwhile the robot's controller stands still, and no mission that needs it comes to its end."""
        program, found = f"{self.folder}/ws/devel/lib/controller_{robot}/".encode(), []
        for process in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):  # it has ended meanwhile
                found += [int(process.name)] * (program in (process / "cmdline").read_bytes())
        (controller,) = found
        os.kill(controller, signal.SIGSTOP)
        try:
            yield
        finally:
            os.kill(controller, signal.SIGCONT)

    def goals(self, robot: str) -> List[str]:
        """The goals that the robot got so far, as x/y in metres."""
        lines = [line.split(",") for line in self.made.log(f"{robot}_goals").splitlines() if line[:1].isdigit()]
        return [f"{float(line[4]):g}/{float(line[5]):g}" for line in lines]

    def until_sent(self, robot: str, *goals: str) -> None:
        """Waits until the robot has got these goals: who listens to them may be slower than the UI."""
        until(lambda: self.goals(robot) == list(goals), lambda: f"{robot}: {self.goals(robot)}")


@pytest.fixture(scope="module")
def fleet(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Fleet]:
    """Three robots, a base and a desk, switched on; the desk's key is known everywhere."""
    folder = tmp_path_factory.mktemp("fleet")
    for name, text in (("first", FIRST), ("second", SECOND)):
        (folder / f"{name}.pur").write_text(text, encoding="utf-8")
    scenario = load(str(folder / "first.pur"))
    won = solve_scenario(scenario, Rules())
    options = Options(reaction=won.reaction)
    workspace = write_workspace(scenario, won.network, won.objective, won.strategy, options, folder / "ws")
    make(ros, workspace)
    with lab("master", "desk", *MACHINES) as rooms, nodes(ros, workspace, folder, rooms) as made:
        fleet = Fleet(ros, made, rooms, folder)
        fleet.desk("keys new desk")
        robots = "".join(f"  {name}: {{host: {name}}}\n" for name in MACHINES)
        (folder / "robots.yaml").write_text(f"format: 1\nrobots:\n{robots}", encoding="utf-8")
        for machine, runs in MACHINES.items():
            keys = fleet.home(machine) / "pursue" / "keys"
            keys.mkdir(parents=True)
            shutil.copy(folder / "desk" / "pursue" / "keys" / "desk.pub", keys)
            launch = f"roslaunch --wait first_bringup robot.launch name:={machine} host:=0.0.0.0"
            launch += f" time_unit:={UNIT} simulate:=true"
            command = f"source devel/setup.bash; export ROS_HOME={fleet.home(machine)}; exec {launch}"
            made.start(machine, f'{command} nodes:="{runs}"', machine)
        for robot in ("bot1", "bot3"):
            made.start(f"{robot}_goals", f"exec rostopic echo -p {robot}/move_base_simple/goal", "desk")
        until(fleet.serves, made.logs, pause=COMMAND)
        yield fleet


def test_missions_are_sent_played_replaced_and_rolled_back(fleet: Fleet) -> None:
    """A mission that comes while another one is played waits for its end, then all robots play the new one.

    bot3 has the third spot at each place: 0.8 m to the right of the given pose.
    """
    digests = {name: fleet.desk(f"bundle {name}.pur -o {name}.pursue").split()[-1] for name in ("first", "second")}
    fleet.desk(f"send first.pursue --to robots.yaml {WAIT}")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["first"])
    fleet.start("first")
    with fleet.unfinished("bot3"):
        fleet.desk("send second.pursue --to robots.yaml")
        assert fleet.current() == dict.fromkeys(MACHINES, digests["first"]), "a mission was swapped while it ran"
    until(lambda: fleet.said("The goal is reached"), fleet.made.logs)
    fleet.desk(f"send second.pursue --to robots.yaml {WAIT}")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["second"])
    fleet.until_sent("bot3", "-1/-0.8")
    fleet.play("second")
    fleet.until_sent("bot3", "-1/-0.8", "7/4.2")
    fleet.until_sent("bot1", "1/0", "5/5")
    fleet.desk(f"send --back --to robots.yaml {WAIT}")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["first"])
    fleet.play("first")
    fleet.until_sent("bot3", "-1/-0.8", "7/4.2", "-1/-0.8")


def test_while_one_robot_cannot_be_reached_nothing_changes_anywhere(fleet: Fleet) -> None:
    (fleet.folder / "third.pur").write_text(SECOND.replace("duration 2", "duration 3"), encoding="utf-8")
    before = fleet.files()
    fleet.rooms.cut("bot2")
    table = fleet.desk("send third.pur --to robots.yaml", status=UNCHANGED)
    fleet.rooms.mend("bot2")
    assert "bot2" in table
    assert fleet.files() == before
    until(fleet.serves, fleet.made.logs, pause=COMMAND)
    fleet.desk(f"send third.pur --to robots.yaml {WAIT}")
    fleet.play("third")
