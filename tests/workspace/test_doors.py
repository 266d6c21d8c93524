"""What a workspace has for doors that open by themselves: the ways through them, where robots wait, the node."""

from __future__ import annotations

import math
from typing import Dict

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.scenario import Pose
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options
from pursue_gen.workspace.generate import generate
from pursue_gen.workspace.poses_text import DOOR_DISTANCE, in_front_of
from pursue_runtime.doors.keeper import read_doors
from pursue_runtime.poses import read_poses

LAB = """\
poi "hall"{hall}
poi "lab"{lab}
door "d1" opens within 8{door}
connect hall and lab distance 4{through}
event "fetch" location lab
agent "bot" controllable mobile 1 location hall can_do fetch
agent "guest" mobile 1 location hall
reach_objective: do fetch
"""
POSES = {"hall": " //[0, 0, 0, 0, 0, 0, 1]", "lab": " //[4, 0, 0, 0, 0, 0, 1]"}


def files(door: str = "", through: str = " through d1") -> Dict[str, bytes]:
    read = parse(LAB.format(door=door, through=through, **POSES), "lab.pur", "lab")
    won = solve_scenario(read, DEFAULT)
    return generate(read, won.network, won.objective, won.strategy, Options(reaction=DEFAULT.reaction))


def test_a_controller_knows_the_doors_of_its_robots_ways_and_where_the_robot_waits() -> None:
    made = files(" //[2, 0, 0, 0, 0, 0.7071068, 0.7071068]")
    poses = read_poses(yaml.safe_load(made["src/controller_bot/config/poses.yaml"]))
    assert set(poses.doors) == {"bot"} and set(poses.doors["bot"]) == {"going_hall_to_lab", "going_lab_to_hall"}
    assert poses.doors["bot"]["going_hall_to_lab"][0].doors == {"d1"}
    assert "doors" not in yaml.safe_load(made["src/UI/config/poses.yaml"])


def test_without_a_pose_of_the_door_no_place_to_wait_is_known() -> None:
    poses = read_poses(yaml.safe_load(files()["src/controller_bot/config/poses.yaml"]))
    assert poses.doors["bot"]["going_hall_to_lab"][0].wait is None


def test_the_node_for_doors_knows_whom_it_opens_them_for() -> None:
    settings = yaml.safe_load(files()["src/UI/config/ui.yaml"])
    door = read_doors(settings)["d1"]
    assert door.within == 8.0 and door.asked_by == {"bot": ["going_hall_to_lab", "going_lab_to_hall"]}
    assert "doors" in settings["nodes"]


def test_where_no_way_leads_through_a_door_nothing_is_different() -> None:
    made = files(through="")
    settings = yaml.safe_load(made["src/UI/config/ui.yaml"])
    assert "doors" not in settings and "doors" not in settings["nodes"]
    assert b'name="doors"' not in made["src/lab_bringup/launch/mission.launch"]
    assert yaml.safe_load(made["src/controller_bot/config/poses.yaml"])["format"] == 1
    assert b'name="doors"' in files()["src/lab_bringup/launch/mission.launch"]


@given(st.floats(-math.pi, math.pi), st.floats(-5, 5), st.floats(-5, 5))
def test_robots_wait_in_front_of_the_door_on_their_side_and_look_at_it(yaw: float, x: float, y: float) -> None:
    door = Pose(0.0, 0.0, 0.0, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    start = Pose(x, y, 0.0, 0.0, 0.0, 0.0, 1.0)
    waits = in_front_of(door, start)
    across = math.cos(yaw), math.sin(yaw)
    side, own = (at[0] * across[0] + at[1] * across[1] for at in ((x, y), waits))
    distance = min(DOOR_DISTANCE, math.hypot(x, y))
    assert math.hypot(*waits[:2]) == pytest.approx(distance, abs=0.01)
    assert abs(side) < 0.01 or side * own >= 0 or distance < 0.01
    looks = 2 * math.atan2(waits[5], waits[6])
    ahead = math.cos(looks) * waits[0] + math.sin(looks) * waits[1]
    assert ahead == pytest.approx(-distance, abs=0.01)


def test_containers_and_services_have_the_node_for_doors_where_there_are_some() -> None:
    read = parse(LAB.format(door="", through=" through d1", **POSES), "lab.pur", "lab")
    won = solve_scenario(read, DEFAULT)
    options = Options(reaction=DEFAULT.reaction, docker=True, systemd=True)
    made = generate(read, won.network, won.objective, won.strategy, options)
    assert yaml.safe_load(made["docker/compose.yaml"])["services"]["doors"]["command"][:3] == ["rosrun", "UI", "doors"]
    assert b"rosrun UI doors" in made["systemd/pursue-doors.service"]
