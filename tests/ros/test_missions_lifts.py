"""Lifts in missions on ROS: called on a topic, ridden where they report that they are open, free afterwards."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml
from door_missions import CALM, FAKE, made_of, need_messages
from launched_mission import PLAYED, LaunchedMission, launched
from ros_world import Ros

pytestmark = pytest.mark.ros

HOTEL = """\
poi "hall0" //[0, 0, 0, 0, 0, 0, 1]
poi "hall1" //[20, 0, 0, 0, 0, 0, 1]
lift "lift1" at hall0, hall1 comes within 60 takes 10 to 60 //[4, 0, 0, 0, 0, 1, 0] hall1 [24, 0, 0, 0, 0, 1, 0]
connect hall0 and hall1 distance 8 by lift1
event "fetch" location hall1 duration 2
agent "bot" controllable mobile 1 location hall0 can_do fetch
reach_objective: do fetch
"""
LIFT = Path(__file__).with_name("fake_lift.py")

RMF = '''
from genpy.dynamic import generate_dynamic

LiftRequest = generate_dynamic(
    "rmf_lift_msgs/LiftRequest",
    "string lift_name\\ntime request_time\\nstring session_id\\nuint8 request_type\\n"
    "string destination_floor\\nuint8 door_state\\n",
)["rmf_lift_msgs/LiftRequest"]
LiftState = generate_dynamic(
    "rmf_lift_msgs/LiftState",
    "time lift_time\\nstring lift_name\\nstring[] available_floors\\nstring current_floor\\nstring destination_floor\\n"
    "uint8 door_state\\nuint8 motion_state\\nuint8[] available_modes\\nuint8 current_mode\\nstring session_id\\n",
)["rmf_lift_msgs/LiftState"]
'''
"""A package with the messages of Open-RMF's lifts."""


def rides(run: LaunchedMission, lift: str, low: str, high: str) -> None:
    """The robot sets off, gets its goal when the lift, which is started then, is open at its floor, and rides."""
    run.until_step("bot_hall02hall1")
    run.until(lambda: run.values("doors").get("waited_for") == "lift1")
    run.until_back("doors", run.kill("doors"))
    assert run.orders() == [], "the lift has reported nothing"
    with run.program(f"source devel/setup.bash; exec python3 {LIFT} {lift}", "lift") as there:
        run.until(lambda: ("bot", "[20.0, 0.0]") in run.orders())
        run.until(lambda: f"is at {high}" in there.output())
        run.publish("bot_going_hall0_to_hall12hall1")
        run.until(lambda: "asked to be free" in there.output())
        said = re.findall("asked to .*|is at .+", there.output())
        assert said[:5] == [f"asked to {low}", f"is at {low}", f"asked to {high}", f"is at {high}", "asked to be free"]
        run.until_step("fetch")
        run.publish("fetchDONE")
        assert run.until_over() == "won", run.output()


@pytest.mark.parametrize(
    ("kind", "adapter", "floors"), [("Int32", "std_msgs", ("0", "1")), ("String", "string", ("hall0", "hall1"))]
)
def test_a_robot_rides_in_a_lift_that_finds_it_aboard(
    ros: Ros, tmp_path: Path, kind: str, adapter: str, floors: "tuple[str, str]"
) -> None:
    over = made_of(HOTEL, "hotel", ros, tmp_path)
    with launched(ros, over, tmp_path / "run", ("bot",), **PLAYED, **CALM, doors=adapter) as run:
        rides(run, f"{kind} pursue/lifts/lift1/command pursue/lifts/lift1/state lift1 bot", *floors)


def test_a_lift_of_open_rmf_is_called_by_its_messages(ros: Ros, tmp_path: Path) -> None:
    over = made_of(HOTEL, "hotel", ros, tmp_path)
    stub = tmp_path / "stub" / "rmf_lift_msgs" / "msg"
    stub.mkdir(parents=True)
    (stub.parent / "__init__.py").touch()
    (stub / "__init__.py").write_text(RMF)
    with open(over / "devel" / "setup.bash", "a") as setup:
        setup.write(f"export PYTHONPATH={tmp_path / 'stub'}:$PYTHONPATH\n")
    settings = tmp_path / "lifts.yaml"
    settings.write_text("lift1: {adapter: rmf, name: Lift1, floors: {hall0: L1, hall1: L2}}\n")
    given = {"door_settings": str(settings)}
    with launched(ros, over, tmp_path / "run", ("bot",), **PLAYED, **CALM, **given) as run:
        rides(run, "Lift lift_requests lift_states Lift1 bot", "L1", "L2")


def test_a_robot_with_move_base_says_when_it_is_in_the_cabin(ros: Ros, tmp_path: Path) -> None:
    need_messages(ros)
    over = made_of(HOTEL, "hotel", ros, tmp_path)
    bot = {"start": [0.0, 0.0], "travel": 2.0, "acts": 2.2, "plays": ["succeed"]}
    (tmp_path / "fake.yaml").write_text(yaml.safe_dump({"robots": {"bot": bot}}))
    fake = f"rosparam load {tmp_path}/fake.yaml /fake_move_base && exec python3 {FAKE}"
    lift = f"source devel/setup.bash; exec python3 {LIFT} Int32 pursue/lifts/lift1/command pursue/lifts/lift1/state x"
    arguments = {**PLAYED, **CALM, "goals": "action", "ends": "pose"}
    with launched(ros, over, tmp_path / "run", ("bot",), **arguments) as run, run.program(fake, "fake") as robot:
        run.until(lambda: "bot stands 2.00 0.00" in robot.output())
        with run.program(lift, "lift") as there:
            run.until(lambda: "is at 1" in there.output())
            assert "bot goal 20.00 0.00" not in robot.output(), "it is not on the map of that floor yet"
            with run.program("rostopic pub /bot/test std_msgs/String 'data: put 24.0 0.0 3.14'", "put"):
                assert run.until_over() == "won", run.output()
    assert re.findall("bot goal (.*)", robot.output()) == ["2.00 0.00", "4.00 0.00", "20.00 0.00"]
    assert re.findall("asked to (.*)", there.output())[:3] == ["0", "1", "be free"]


def test_goals_are_in_the_frame_of_their_level_and_it_gets_out_on_the_map_of_the_other_one(
    ros: Ros, tmp_path: Path
) -> None:
    need_messages(ros)
    above = HOTEL.replace("[20, 0, 0,", "[0, 0, 8,").replace(" hall1 [24, 0, 0, 0, 0, 1, 0]", "")
    over = made_of(above, "hotel", ros, tmp_path, levels={"L1": 0.0, "L2": 8.0})
    bot = {"start": [0.0, 0.0], "frame": "L1/map", "travel": 2.0, "acts": 2.2, "plays": ["succeed"]}
    (tmp_path / "fake.yaml").write_text(yaml.safe_dump({"robots": {"bot": bot}}))
    (tmp_path / "robots.yaml").write_text('map_frame: "{level}/map"\n')
    fake = f"rosparam load {tmp_path}/fake.yaml /fake_move_base && exec python3 {FAKE}"
    lift = f"source devel/setup.bash; exec python3 {LIFT} Int32 pursue/lifts/lift1/command pursue/lifts/lift1/state x"
    arguments = {**PLAYED, **CALM, "goals": "action", "ends": "pose", "robots": str(tmp_path / "robots.yaml")}
    with launched(ros, over, tmp_path / "run", ("bot",), **arguments) as run, run.program(fake, "fake") as robot:
        run.until(lambda: "bot stands 2.00 0.00" in robot.output())
        with run.program(lift, "lift") as there:
            run.until(lambda: "is at 1" in there.output())
            assert "in L2/map" not in robot.output(), "its map is still that of the level below"
            with run.program("rostopic pub /bot/test std_msgs/String 'data: map L2/map'", "map"):
                assert run.until_over() == "won", run.output()
    goals = ["2.00 0.00 in L1/map", "4.00 0.00 in L1/map", "0.00 0.00 in L2/map"]
    assert re.findall("bot goal (.*)", robot.output()) == goals


def test_simulated_lifts_are_ridden_by_simulated_robots(ros: Ros, tmp_path: Path) -> None:
    over = made_of(HOTEL, "hotel", ros, tmp_path)
    with launched(ros, over, tmp_path / "run", ("bot",), use_sim_time=True, speed=20) as run:
        assert run.until_over() == "won", run.output()
        assert [robot for robot, _ in run.orders()] == ["bot", "bot"]
