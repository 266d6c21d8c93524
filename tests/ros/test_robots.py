"""Robots as move_base shows them, instead of the simulator: whole missions by results, poses and tf; and failures."""

from __future__ import annotations

import contextlib
import re
import time
from collections import Counter
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List

import pytest
import yaml
from ros_world import Ros, end, generated, make

from tests.waiting import PATIENCE

pytestmark = pytest.mark.ros

FAKE = Path(__file__).resolve().parent / "fake_move_base.py"
UNIT = 0.2
"""Seconds per time unit: a movement takes 1.8 to 2 s, bot1_inb 0.6 to 0.8 s, bot2_ina 1.2 to 1.4 s."""

SLACK = 100
"""Time units by which the robots may be late in their model: they move in real time, and a machine may stand still."""

LAUNCH = f"exec roslaunch scenario_1_bringup mission.launch simulate:=false time_unit:={UNIT} tolerance:=0.5"


@pytest.fixture(scope="module")
def workspace(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    wanted = "move_base_msgs.msg, actionlib_msgs.msg, tf2_ros"
    found = ros.run(f"python3 -c 'import {wanted}'", ros.home)
    if found.returncode:
        pytest.skip(f"no messages of move_base here: {found.stdout.strip().splitlines()[-1]}")
    slack = {"bot1": SLACK, "bot2": SLACK}
    return make(ros, generated("thesis/scenario_1", tmp_path_factory.mktemp("robots") / "ws", slack=slack))


class Robots:
    """Two fake robots at the initial point of the scenario, and what they have heard."""

    def __init__(self, ros: Ros, workspace: Path, logs: Path, there: Dict[str, str], **more: Dict[str, Any]) -> None:
        files = {bot: workspace / f"src/controller_{bot}/config/poses.yaml" for bot in ("bot1", "bot2")}
        poses = {bot: yaml.safe_load(file.read_text())["poses"] for bot, file in files.items()}
        usual: Dict[str, Dict[str, Any]] = {"bot1": {"acts": 3.5 * UNIT}, "bot2": {"acts": 6.5 * UNIT}}
        robots = {
            name: {"start": poses[name]["c"][:2], "travel": 9.5 * UNIT, **settings, **more.get(name, {})}
            for name, settings in usual.items()
        }
        self.log = logs / "robots"
        self.goals = {f"{x:.2f} {y:.2f}": poi for own in poses.values() for poi, (x, y, *_) in own.items()}
        (logs / "robots.yaml").write_text(yaml.safe_dump({"robots": robots}))
        ros.run(f"rosparam load {logs}/robots.yaml /fake_move_base", workspace, **there)
        self.process = ros.start(f"exec python3 {FAKE}", workspace, self.log, **there)

    def heard(self, robot: str) -> List[str]:
        """What this robot has heard, goals by their names."""
        told = re.findall(rf"^{robot} (\w+) ?(.*)$", self.log.read_text(), re.MULTILINE)
        return [f"{what} {self.goals.get(detail, detail)}".strip() for what, detail in told]


@contextlib.contextmanager
def playing(ros: Ros, workspace: Path, logs: Path, arguments: str, **robots: Dict[str, Any]) -> Iterator[Any]:
    """A mission with fake robots: (robots, what roslaunch says, its process)."""
    with ros.master() as there:
        fakes = Robots(ros, workspace, logs, there, **robots)
        mission = ros.start(f"source devel/setup.bash; {LAUNCH} {arguments}", workspace, logs / "launch", **there)
        try:
            yield fakes, logs / "launch", mission
        finally:
            end(mission)
            end(fakes.process)


def played(ros: Ros, workspace: Path, logs: Path, arguments: str, **robots: Dict[str, Any]) -> Any:
    """Plays it to its end: (robots, what was said)."""
    with playing(ros, workspace, logs, arguments, **robots) as (fakes, log, mission):
        deadline = time.monotonic() + 2 * PATIENCE
        while mission.poll() is None and time.monotonic() < deadline:
            time.sleep(0.1)
    return fakes, log.read_text()


def wait_for(condition: Callable[[], bool], log: Path, what: str) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, f"{what}; it was said:\n{log.read_text()[-8000:]}"
        time.sleep(0.05)


def well(said: str) -> None:
    """The goal was reached, each end counted once, and none was told where it cannot be; but one that is not answered
    for half a second, on a busy machine, is told again."""
    assert "The goal is reached" in said, said[-8000:]
    assert not re.search(r'File ".*/controller_\w+/scripts/', said), said[-8000:]
    again = {word for word, times in Counter(re.findall(r"reports (\w+)", said)).items() if times > 1}
    assert set(re.findall(r"(\S+): it cannot happen", said)) <= again, said[-8000:]
    for word in ("bot1_going_c_to_b2b", "bot2_going_c_to_a2a"):
        assert len(re.findall(rf"state \d+: {word}", said)) == 1, said[-8000:]


def test_action_goals_a_failure_on_the_way_and_results_that_come_twice(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    (tmp_path / "own.yaml").write_text("bot1: {retry_delay: 0.1}\n")
    bot1 = {"plays": ["abort", "reject", "succeed"], "travel": 8.5 * UNIT}
    arguments = f"goals:=action ends:=result robots:={tmp_path}/own.yaml"
    robots, said = played(ros, workspace, tmp_path, arguments, bot1=bot1, bot2={"plays": ["twice"]})
    well(said)
    assert robots.heard("bot1") == ["goal b", "goal b", "goal b", "action bot1_inb"]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]


def test_simple_goals_an_early_end_and_a_result_of_long_ago(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    arguments = "ends:=result on_uncovered:=warn"
    robots, said = played(ros, workspace, tmp_path, arguments, bot1={"travel": 0.05}, bot2={"plays": ["stale"]})
    well(said)
    early = "bot1_going_c_to_b2b is outside the model's time window"
    assert early in said and "bot2_going_c_to_a2a is outside" not in said, said[-8000:]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]


def test_ends_are_seen_by_pose_and_by_tf(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text("end_settle: 0.2\nbot1: {ends: pose}\nbot2: {ends: tf, goals: action}\n")
    slower = {"travel": 9.2 * UNIT}  # a robot is within the tolerance some moments before its goal
    robots, said = played(ros, workspace, tmp_path, f"robots:={tmp_path}/own.yaml", bot1=slower, bot2=slower)
    well(said)
    assert robots.heard("bot1") == ["goal b", "action bot1_inb"]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]


def test_a_robot_that_cannot_go_fails_and_others_are_called_back_when_the_mission_stops(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    (tmp_path / "own.yaml").write_text("retries: 1\nretry_delay: 4\n")  # until then bot2, too, is on its way
    arguments = f"ends:=result on_stop:=cancel planner:=off robots:={tmp_path}/own.yaml"
    bot1, bot2 = {"plays": ["abort"]}, {"plays": ["never"]}
    with playing(ros, workspace, tmp_path, arguments, bot1=bot1, bot2=bot2) as (robots, log, mission):
        failed = "reports bot1:_failed_"
        wait_for(lambda: failed in log.read_text() and "goal a" in robots.heard("bot2"), log, "bot1 has not failed")
        wait_for(lambda: "cancel" in robots.heard("bot2"), log, "bot2 is not called back")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
        assert robots.heard("bot1") == ["goal b", "goal b"]


def test_a_robot_that_connects_late_is_told_and_is_called_back_when_its_controller_is_interrupted(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    automata = "[{name: bot1, location: going_c_to_b}, {name: bot2, location: c}]"
    fields = f"seq: 3, stamp: {{secs: 1}}, time_unit: 1.0, automata: {automata}, clocks: [{{name: Cbot1, value: 1.0}}]"
    publish = f"exec rostopic pub -l pursue/state pursue_msgs/SystemState '{{{fields}, status: %s}}'"
    told = {status: publish % status for status in ("holding", "running")}
    command = "exec rosrun controller_bot1 controller_bot1 _goals:=action _on_stop:=cancel"
    with contextlib.ExitStack() as cleanup:
        there = cleanup.enter_context(ros.master())

        def start(command: str, log: Path) -> Any:
            process = ros.start(f"source devel/setup.bash; {command}", workspace, log, **there)
            cleanup.callback(end, process)
            return process

        controller, log = start(command, tmp_path / "controller"), tmp_path / "controller"
        holding = start(told["holding"], tmp_path / "holding")
        robots = Robots(ros, workspace, tmp_path, there)
        cleanup.callback(end, robots.process)
        wait_for(lambda: "bot1/amcl_pose" in ros.run("rostopic list", workspace, **there).stdout, log, "no robots")
        assert "bot1 goes to b" not in log.read_text() and robots.heard("bot1") == [], "nobody sets out in a hold"
        end(holding)
        start(told["running"], tmp_path / "running")
        wait_for(lambda: robots.heard("bot1") == ["goal b"], log, "bot1 was not told")
        end(controller)
        wait_for(lambda: robots.heard("bot1") == ["goal b", "cancel"], log, "bot1 was not called back")


@pytest.mark.parametrize(
    ("parameters", "hidden", "message"),
    [
        ("_simulated:=true _ends:=pose", "", "bot1, which is simulated"),
        ("_ends:=result", "move_base_msgs", "ends:=result needs the ROS package move_base_msgs"),
    ],
)
def test_settings_that_cannot_be_end_the_controller_with_status_3(
    ros: Ros, workspace: Path, tmp_path: Path, parameters: str, hidden: str, message: str
) -> None:
    if hidden:
        (tmp_path / f"{hidden}.py").write_text("raise ImportError('not here')\n")
    command = f"export PYTHONPATH={tmp_path}:$PYTHONPATH; exec rosrun controller_bot1 controller_bot1 {parameters}"
    with ros.master() as there:
        done = ros.run(f"source devel/setup.bash; {command}", workspace, **there)
    assert (done.returncode, message in done.stdout, "Traceback" in done.stdout) == (3, True, False), done.stdout
