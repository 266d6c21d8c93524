"""Links that break and come back, and masters that are lost: on real sockets, and between machines that are network
namespaces, as in the thesis's experiment with containers.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import subprocess
import time
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Optional, Set
from xmlrpc.client import ServerProxy

import pytest
from preloaded import process_of
from ros_world import Ros, end, free_port

from tests.namespaces import Lab, lab, why_not
from tests.waiting import PATIENCE

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

PROBE = Path(__file__).resolve().parent / "link_probe.py"
LONG = pytest.param(200, marks=pytest.mark.skipif(os.environ.get("PURSUE_LONG_TESTS") != "1",
                                                  reason="takes minutes; PURSUE_LONG_TESTS=1 runs it"))
needs_namespaces = pytest.mark.skipif(bool(why_not()), reason=why_not())


def until(
    done: Callable[[], object], told: Callable[[], str], seconds: float = PATIENCE, pause: float = 0.1
) -> None:
    """Waits until it is so, looking after each pause; the test fails after so many seconds, with what was told."""
    deadline = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < deadline, f"not so after {seconds} s:\n{told()}"
        time.sleep(pause)


class Nodes:
    """Processes by name, each with a log; started on a machine of the lab, or on this one."""

    def __init__(self, ros: Ros, workspace: Path, logs: Path, rooms: Optional[Lab]) -> None:
        self._ros, self._workspace, self._logs, self._rooms = ros, workspace, logs, rooms
        self.port = 11311
        self.running: Dict[str, "subprocess.Popen[bytes]"] = {}

    def start(self, name: str, command: str, machine: str = "") -> None:
        """Starts a shell command under this name."""
        there = {"ROS_MASTER_URI": f"http://127.0.0.1:{self.port}", "PYTHONUNBUFFERED": "1"}
        if self._rooms is not None:
            there.update(self._rooms.variables(machine, "master"))
            source, found, rest = command.partition("setup.bash; ")
            command = f"{source}{found}{self._rooms.at(machine, rest)}" if found else self._rooms.at(machine, command)
        self.running[name] = self._ros.start(command, self._workspace, self._logs / name, **there)

    def core(self, name: str = "roscore") -> None:
        """Starts a roscore, and waits until it serves; any but the first gets the port of that. It ends by itself where
        its port is somebody else's by now, and where its master takes more than ten seconds: then there is another."""
        first, deadline = name == "roscore", time.monotonic() + 2 * PATIENCE
        while name not in self.running or "started core service" not in self.log(name):
            assert time.monotonic() < deadline, self.logs()
            if name not in self.running or self.running[name].poll() is not None:
                self.port = free_port() if first and self._rooms is None else self.port
                self.start(name, f"source devel/setup.bash; exec roscore -p {self.port}", "master")
            time.sleep(0.1)

    def log(self, name: str) -> str:
        """The lines that it has printed so far."""
        text = (self._logs / name).read_text(errors="replace")
        return text[:text.rfind("\n") + 1]

    def logs(self) -> str:
        """What everybody has printed."""
        return "\n".join(f"--- {name}\n{self.log(name)[-3000:]}" for name in self.running)

    def kill(self, name: str, sign: signal.Signals) -> None:
        """Sends the signal to it and its children, or to the process that does its work."""
        started = self.running[name].pid
        works = process_of(started)
        if works == started:
            os.killpg(started, sign)
        else:
            os.kill(works, sign)

    def statuses(self, *names: str) -> Dict[str, int]:
        """Waits for their ends."""
        waited = [self.running[name] for name in names]
        until(lambda: all(process.poll() is not None for process in waited), self.logs, 2 * PATIENCE)
        return {name: self.running[name].returncode for name in names}


@contextlib.contextmanager
def nodes(ros: Ros, workspace: Path, logs: Path, rooms: Optional[Lab] = None) -> Iterator[Nodes]:
    """A roscore (on the machine `master`, where there are rooms), and what else is started; all of it ends here."""
    made = Nodes(ros, workspace, logs, rooms)
    try:
        made.core()
        yield made
    finally:
        for name, process in made.running.items():
            if name != "roscore" and process.poll() is None:  # all at once: each takes seconds
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGINT)
                    made.kill(name, signal.SIGCONT)
        for _, process in sorted(made.running.items(), key=lambda running: running[0] == "roscore"):
            end(process)


# Links of single topics ----------------------------------------------------------------------------------------------


def talk(made: Nodes, workspace: Path, talker: str = "talker") -> int:
    """Starts talker and listener, and waits until they are connected: the last number that was heard then."""
    for name, role in (("listener", "listener"), ("talker", talker)):
        made.start(name, f"source devel/setup.bash; exec python3 {PROBE} {role}", name)
    until(lambda: len(heard(made)) > 20, made.logs)
    return max(heard(made))


def heard(made: Nodes) -> List[int]:
    """The numbers that the listener has heard, in order."""
    return [int(line) for line in made.log("listener").splitlines() if line.isdigit()]


def more(made: Nodes, numbers: int = 30) -> None:
    """Waits until the listener has heard so many more."""
    before = max(heard(made))
    until(lambda: max(heard(made)) > before + numbers, made.logs)


def once(made: Nodes, since: int) -> bool:
    """True if every number from that one on was heard, and none twice. Nodes that have just begun may have to connect
    once more, and what is published until then nobody hears."""
    numbers = sorted(number for number in heard(made) if number >= since)
    return numbers == list(range(since, numbers[-1] + 1))


def test_a_connection_that_was_dropped_is_made_again(ros: Ros, built: Build, tmp_path: Path) -> None:
    """rospy takes it that the publisher is gone, and never asks again."""
    workspace = built("thesis/scenario_1")
    with nodes(ros, workspace, tmp_path) as made:
        talk(made, workspace)
        made.kill("talker", signal.SIGUSR1)
        more(made)


def test_a_first_connection_that_is_not_answered_is_tried_again(ros: Ros, built: Build, tmp_path: Path) -> None:
    """rospy waits for the answer for ever, and for a minute where a busy machine does not even take the connection."""
    workspace = built("thesis/scenario_1")
    with nodes(ros, workspace, tmp_path) as made:
        since = talk(made, workspace, "deaf")
        assert "connected to it anew" in made.log("listener"), made.logs()
        until(lambda: once(made, since), made.logs)


def test_the_messages_of_a_node_that_stood_still_are_received_whole(ros: Ros, built: Build, tmp_path: Path) -> None:
    workspace = built("thesis/scenario_1")
    with nodes(ros, workspace, tmp_path) as made:
        since = talk(made, workspace)
        made.kill("talker", signal.SIGSTOP)
        time.sleep(8)  # three are enough where the listener has them; it may stand still for a while itself
        made.kill("talker", signal.SIGCONT)
        until(lambda: "/talker was silent for a while" in made.log("listener"), made.logs)
        more(made)
        until(lambda: once(made, since), made.logs)


@needs_namespaces
@pytest.mark.parametrize("seconds", [8, LONG])
def test_a_cut_link_comes_back_by_itself(ros: Ros, built: Build, tmp_path: Path, seconds: int) -> None:
    workspace = built("thesis/scenario_1")
    with lab("master", "talker", "listener") as rooms, nodes(ros, workspace, tmp_path, rooms) as made:
        since = talk(made, workspace)
        rooms.cut("talker")
        time.sleep(seconds)
        rooms.mend("talker")
        more(made)
        if seconds < 100:  # after that the talker's machine gives up what it could not send
            until(lambda: once(made, since), made.logs)


# Missions -------------------------------------------------------------------------------------------------------------

MACHINES = {"observer": "room0", "controller_bot1": "room1", "controller_bot2": "room2", "controllerObj": "room3",
            "simulator": "desk", "UI": "desk"}


def play(made: Nodes, unit: float, options: str = "") -> None:
    """Starts the nodes of scenario 1, in real time (what is cut off would have no /clock); it takes some 20 units."""
    for node, room in MACHINES.items():
        package = "UI" if node == "simulator" else node
        told = {"observer": f"_time_unit:={unit} --journal off {options}", "UI": f"--autostart --wait {PATIENCE}"}
        made.start(node, f"source devel/setup.bash; exec src/{package}/scripts/{node} {told.get(node, '')}", room)


@needs_namespaces
@pytest.mark.parametrize("seconds", [3, 15, LONG])
def test_a_mission_whose_robot_is_cut_off_goes_on_by_itself(
    ros: Ros, built: Build, tmp_path: Path, seconds: int
) -> None:
    rooms_of = ("master", *sorted(set(MACHINES.values())))
    workspace = built("thesis/scenario_1")
    with lab(*rooms_of) as rooms, nodes(ros, workspace, tmp_path, rooms) as made:
        silence = 5 if seconds > 5 else 30  # after a short cut it takes a while, too, until somebody is heard
        play(made, 0.5, f"_silence:={silence}")
        until(lambda: "bot1_c2b by bot1" in made.log("observer"), made.logs)
        rooms.cut("room1")
        time.sleep(seconds)
        assert "The goal is reached" not in made.log("UI"), "the mission needs its robot"
        rooms.mend("room1")
        assert made.statuses(*MACHINES) == dict.fromkeys(MACHINES, 0), made.logs()
        assert "The goal is reached" in made.log("UI")
        assert ("controller_bot1 is silent" in made.log("observer")) is (seconds > silence)


OTHERS = {"recorder": "UI/scripts/recorder", "sim_clock": "UI/scripts/sim_clock",
          "reader": "pursue_reader/scripts/pursue_reader",
          "manager": "communication_manager/scripts/communication_manager --port 0"}


@pytest.mark.parametrize("way, reason", [
    ("it is interrupted", "the ROS master is gone"),
    ("it is killed", "the ROS master is gone"),
    ("it is started again", "was started anew"),
    ("another program gets its port", "the ROS master is gone, and another program answers at its address"),
])  # fmt: skip
def test_a_lost_master_stops_every_node_with_the_reason_and_status_1(
    ros: Ros, built: Build, tmp_path: Path, way: str, reason: str
) -> None:
    with nodes(ros, built("thesis/scenario_1"), tmp_path) as made:
        play(made, 3.0)
        for name, program in OTHERS.items():
            made.start(name, f"source devel/setup.bash; export ROS_HOME={tmp_path}/home; exec src/{program}")
        names = (*MACHINES, *OTHERS)
        until(lambda: "bot1_c2b by bot1" in made.log("observer"), made.logs)
        until(lambda: set(names) - {"reader", "manager"} <= registered(made), made.logs)
        held = names if way.startswith(("it is started", "another")) else ()
        for node in held:  # however long the other one takes: no node sees that there is none meanwhile
            made.kill(node, signal.SIGSTOP)
        if way == "it is killed":
            os.kill(ServerProxy(f"http://127.0.0.1:{made.port}").getPid("/test")[2], signal.SIGKILL)  # type: ignore[index]
        else:
            end(made.running["roscore"])
        if way == "it is started again":
            made.core("another")
        elif held:
            made.start("server", f"exec python3 -m http.server {made.port} --bind 127.0.0.1")
            until(lambda: is_served(made.port), made.logs)
        for node in held:
            made.kill(node, signal.SIGCONT)
        assert made.statuses(*names) == dict.fromkeys(names, 1), made.logs()
        assert [node for node in names if reason not in made.log(node)] == [], made.logs()
        assert "Traceback" not in "".join(made.log(node) for node in names), made.logs()


def test_a_lost_master_ends_a_mission_that_has_not_begun(ros: Ros, built: Build, tmp_path: Path) -> None:
    with nodes(ros, built("thesis/scenario_1"), tmp_path) as made:
        for node in ("observer", "UI"):
            made.start(node, f"source devel/setup.bash; exec rosrun {node} {node} {'--wait 600' * (node == 'UI')}")
        until(lambda: {"observer", "UI"} <= registered(made), made.logs)
        end(made.running["roscore"])
        assert made.statuses("observer", "UI") == {"observer": 1, "UI": 1}, made.logs()
        assert all("the ROS master is gone" in made.log(node) for node in ("observer", "UI")), made.logs()


def test_where_roslaunch_loses_its_own_master_ui_and_observer_say_so(ros: Ros, built: Build, tmp_path: Path) -> None:
    log, workspace = tmp_path / "launch", built("thesis/scenario_1")
    line = f"roslaunch --skip-log-check scenario_1_bringup mission.launch time_unit:=3 wait:={PATIENCE:g}"
    command = f"source devel/setup.bash; exec {line}"
    launch, there = ros.start_with_master(command, workspace, log, ROS_HOME=str(tmp_path))
    try:
        until(lambda: "bot1 sets off from c to b" in log.read_text(errors="replace"), log.read_text)
        os.kill(ServerProxy(there["ROS_MASTER_URI"]).getPid("/test")[2], signal.SIGKILL)  # type: ignore[index]
        launch.wait(PATIENCE)
    finally:
        end(launch)
    said = log.read_text(errors="replace")
    assert "The mission cannot go on: the ROS master is gone." in said, said[-6000:]
    nodes_lines = re.findall(r"^\[ERROR\].*ends here: the ROS master is gone", said, re.MULTILINE)
    assert len(nodes_lines) >= len(MACHINES), f"each node logs it: {nodes_lines}"


def registered(made: Nodes) -> Set[str]:
    """The names of the nodes that publish and are subscribed."""
    _, _, (publishers, subscribers, _) = ServerProxy(f"http://127.0.0.1:{made.port}").getSystemState("/test")  # type: ignore[misc]
    both = [{name.strip("/") for _, names in found for name in names} for found in (publishers, subscribers)]
    return both[0] & both[1]


def is_served(port: int) -> bool:
    """True as soon as somebody takes connections there."""
    with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
        return True
    return False


def test_simulated_time_goes_on_where_a_killed_clock_was(ros: Ros, built: Build, tmp_path: Path) -> None:
    with nodes(ros, built("thesis/scenario_1"), tmp_path) as made:
        lives = [a_clocks_life(made, name) for name in ("first", "second")]
    times = [moment for life in lives for moment in life]
    assert times == sorted(times)
    # The second life begins at four times the speed: who listens needs a moment to connect.
    assert lives[0][0] < 15 and 0 <= lives[1][0] - lives[0][-1] < 15, "neither anew nor far ahead"


def a_clocks_life(made: Nodes, name: str) -> List[float]:
    """Starts a clock, and kills it after its eighth second; the times that somebody has heard of it (seconds)."""
    made.start(f"{name}_ears", "source devel/setup.bash; exec rostopic echo -p /clock")
    made.start(name, "source devel/setup.bash; exec rosrun UI sim_clock _speed:=4")

    def told() -> List[float]:
        rows = [line.split(",") for line in made.log(f"{name}_ears").splitlines()]
        return [int(row[1]) / 1e9 for row in rows if len(row) == 2 and row[1].isdigit()]

    until(lambda: len(told()) > 40 and told()[-1] > 8, made.logs)
    made.kill(name, signal.SIGKILL)
    end(made.running[f"{name}_ears"])
    return told()
