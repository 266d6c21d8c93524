"""A mission is sent from a desk to three robots and a base, each a machine of its own (a network namespace with its own
ROS_HOME): it is played, replaced by another one, rolled back; and nothing changes anywhere while one of them is away.
"""

from __future__ import annotations

import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, Iterator, List

import pytest
from ros_world import Ros, make
from test_links import Nodes, nodes, until

from pursue_gen.language import load
from pursue_gen.pipeline import Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace
from tests.namespaces import Lab, lab, why_not

pytestmark = [pytest.mark.ros, pytest.mark.skipif(bool(why_not()), reason=why_not())]

MACHINES = {
    "base": "observer UI simulator controllerObj",
    "bot1": "controller_bot1",
    "bot2": "controller_bot2",
    "bot3": "controller_bot3",
}
UNIT = 0.5
"""Seconds per time unit."""

READY = "ready"
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
            inside, cwd=self.folder, env=place, capture_output=True, text=True, timeout=120, check=False
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

    def play(self) -> None:
        """Starts the mission that is ready, and waits for its goal."""
        won = self.said("The goal is reached")
        self.start()
        until(lambda: self.said("The goal is reached") > won, 90, self.made.logs)

    def start(self) -> None:
        """Says _start_ once every node is ready."""
        runs = self.said("the mission runs")
        until(self.ready, 80, self.made.logs)
        publish = "source devel/setup.bash; exec rostopic pub -1 pursue/events std_msgs/String _start_"
        self.made.start("start", publish, "desk")
        until(lambda: self.said("the mission runs") > runs, 30, self.made.logs)

    def ready(self) -> bool:
        """True where the UI, started again after the last mission, has found all nodes ready."""
        return self.made.log("base").rpartition("The goal is reached")[2].count(READY) > 0

    def goals(self, robot: str) -> List[str]:
        """The goals that the robot got so far, as x/y in metres."""
        lines = [line.split(",") for line in self.made.log(f"{robot}_goals").splitlines() if line[:1].isdigit()]
        return [f"{float(line[4]):g}/{float(line[5]):g}" for line in lines]


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
        (folder / "robots.yaml").write_text(f"format: 1\nrobots:\n{robots}timeout: 2\n", encoding="utf-8")
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
        yield fleet


def test_missions_are_sent_played_replaced_and_rolled_back(fleet: Fleet) -> None:
    """A mission that comes while another one is played waits for its end, then all robots play the new one."""
    digests = {name: fleet.desk(f"bundle {name}.pur -o {name}.pursue").split()[-1] for name in ("first", "second")}
    until(fleet.serves, 60, fleet.made.logs)
    fleet.desk("send first.pursue --to robots.yaml --wait 20")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["first"])
    fleet.start()
    fleet.desk("send second.pursue --to robots.yaml")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["first"]), "a mission was swapped while it ran"
    until(lambda: fleet.said("The goal is reached"), 60, fleet.made.logs)
    fleet.desk("send second.pursue --to robots.yaml --wait 20")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["second"])
    assert fleet.goals("bot3") == ["-1/0"]
    fleet.play()
    assert fleet.goals("bot3") == ["-1/0", "7/5"]
    assert fleet.goals("bot1") == ["1/0", "5/5"]
    fleet.desk("send --back --to robots.yaml --wait 20")
    assert fleet.current() == dict.fromkeys(MACHINES, digests["first"])
    fleet.play()
    assert fleet.goals("bot3") == ["-1/0", "7/5", "-1/0"]


def test_while_one_robot_cannot_be_reached_nothing_changes_anywhere(fleet: Fleet) -> None:
    (fleet.folder / "third.pur").write_text(SECOND.replace("duration 2", "duration 3"), encoding="utf-8")
    before = fleet.files()
    fleet.rooms.cut("bot2")
    table = fleet.desk("send third.pur --to robots.yaml", status=UNCHANGED)
    fleet.rooms.mend("bot2")
    assert "bot2" in table
    assert fleet.files() == before
    fleet.desk("send third.pur --to robots.yaml --wait 20")
    fleet.play()
