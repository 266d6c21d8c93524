"""Doors in missions on ROS: asked on a topic, and passed when they report on a topic that they are open."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml
from door_missions import CALM, FAKE, made_of, need_messages
from launched_mission import PLAYED, LaunchedMission, launched
from ros_world import Ros

pytestmark = pytest.mark.ros

LAB = """\
poi "hall" //[0, 0, 0, 0, 0, 0, 1]
poi "lab" //[4, 0, 0, 0, 0, 0, 1]
door "d1" opens within 60 //[2, 0, 0, 0, 0, 0, 1]
connect hall and lab distance 4 through d1
event "fetch" location lab duration 2
agent "bot" controllable mobile 1 location hall can_do fetch
reach_objective: do fetch
"""
DOOR = Path(__file__).with_name("fake_door.py")

RMF = '''
from genpy.dynamic import generate_dynamic

_MODE = "=" * 80 + "\\nMSG: rmf_door_msgs/DoorMode\\nuint32 value\\n"
DoorRequest = generate_dynamic(
    "rmf_door_msgs/DoorRequest",
    "time request_time\\nstring requester_id\\nstring door_name\\nDoorMode requested_mode\\n" + _MODE,
)["rmf_door_msgs/DoorRequest"]
DoorState = generate_dynamic(
    "rmf_door_msgs/DoorState", "time door_time\\nstring door_name\\nDoorMode current_mode\\n" + _MODE
)["rmf_door_msgs/DoorState"]
'''
"""A package with the messages of Open-RMF's doors, as far as they matter here."""


def passes(run: LaunchedMission, kind: str, *topics: str) -> None:
    """The robot sets off, and gets its goal when the door, which is started then, reports that it is open."""
    run.until_step("bot_hall2lab")
    command = f"source devel/setup.bash; exec python3 {DOOR} {kind} {' '.join(topics)}"
    run.until(lambda: run.values("doors").get("waited_for") == "d1")
    run.until_back("doors", run.kill("doors"))
    assert run.orders() == [], "the door has reported nothing"
    with run.program(command, "door") as door:
        run.until(lambda: ("bot", "[4.0, 0.0]") in run.orders())
        said = door.output().split("\n")
        assert said.index("asked to open") < said.index("is open")
        assert "asked to close" not in said, "the robot is on its way"
        run.publish("bot_going_hall_to_lab2lab")
        run.until(lambda: "is closed" in door.output())
        run.until_step("fetch")
        run.publish("fetchDONE")
        assert run.until_over() == "won", run.output()


@pytest.mark.parametrize(
    ("kind", "adapter"), [("Bool", "std_msgs"), ("String", "string")]
)
def test_a_robot_passes_a_door_when_that_reports_that_it_is_open(
    ros: Ros, tmp_path: Path, kind: str, adapter: str
) -> None:
    over = made_of(LAB, "lab", ros, tmp_path)
    with launched(ros, over, tmp_path / "run", ("bot",), **PLAYED, **CALM, doors=adapter) as run:
        passes(run, kind, "pursue/doors/d1/command", "pursue/doors/d1/state")


def test_a_robot_with_move_base_waits_in_front_of_the_door(ros: Ros, tmp_path: Path) -> None:
    need_messages(ros)
    over = made_of(LAB, "lab", ros, tmp_path)
    bot = {"start": [0.0, 0.0], "travel": 2.0, "acts": 2.2, "plays": ["succeed"]}
    (tmp_path / "fake.yaml").write_text(yaml.safe_dump({"robots": {"bot": bot}}))
    fake = f"rosparam load {tmp_path}/fake.yaml /fake_move_base && exec python3 {FAKE}"
    door = f"source devel/setup.bash; exec python3 {DOOR} Bool pursue/doors/d1/command pursue/doors/d1/state"
    arguments = {**PLAYED, **CALM, "goals": "action", "ends": "result"}
    with launched(ros, over, tmp_path / "run", ("bot",), **arguments) as run, run.program(fake, "fake") as robot:
        run.until(lambda: "bot stands 1.00 0.00" in robot.output())
        assert "bot goal 4.00 0.00" not in robot.output()
        with run.program(door, "door"):
            assert run.until_over() == "won", run.output()
    assert re.findall("bot goal (.*)", robot.output()) == ["1.00 0.00", "4.00 0.00"]


def test_a_door_of_open_rmf_is_asked_by_its_messages(ros: Ros, tmp_path: Path) -> None:
    over = made_of(LAB, "lab", ros, tmp_path)
    stub = tmp_path / "stub" / "rmf_door_msgs" / "msg"
    stub.mkdir(parents=True)
    (stub.parent / "__init__.py").touch()
    (stub / "__init__.py").write_text(RMF)
    with open(over / "devel" / "setup.bash", "a") as setup:
        setup.write(f"export PYTHONPATH={tmp_path / 'stub'}:$PYTHONPATH\n")
    settings = tmp_path / "doors.yaml"
    settings.write_text("d1: {adapter: rmf, name: main_door}\n")
    given = {"door_settings": str(settings)}
    with launched(ros, over, tmp_path / "run", ("bot",), **PLAYED, **CALM, **given) as run:
        passes(run, "Door", "door_requests", "door_states", "main_door")


def test_without_open_rmfs_messages_the_node_says_what_is_missing(ros: Ros, tmp_path: Path) -> None:
    over = made_of(LAB, "lab", ros, tmp_path)
    with launched(ros, over, tmp_path / "run", ("bot",), **PLAYED, **CALM, doors="rmf", respawn=False) as run:
        run.until(lambda: "needs the ROS package rmf_door_msgs, which is not here" in run.output())


def test_simulated_doors_open_for_simulated_robots(ros: Ros, tmp_path: Path) -> None:
    over = made_of(LAB, "lab", ros, tmp_path)
    with launched(ros, over, tmp_path / "run", ("bot",), use_sim_time=True, speed=20) as run:
        assert run.until_over() == "won", run.output()
        assert [robot for robot, _ in run.orders()] == ["bot", "bot"]
