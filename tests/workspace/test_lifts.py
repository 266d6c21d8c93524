"""What a workspace has for lifts: where robots wait for them and in them, whom the node for doors sends them to."""

from __future__ import annotations

from typing import Any, Dict

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.lifts import WAITS_AT
from pursue_gen.language.scenario import Pose
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options
from pursue_gen.workspace.generate import generate
from pursue_gen.workspace.poses_text import before_cabin
from pursue_runtime.data import DataError
from pursue_runtime.doors.lifts import read_lifts
from pursue_runtime.drives.robots import driven_robots
from pursue_runtime.poses import Doorway, read_poses

HOTEL = """\
poi "hall0" //[0, 0, 0, 0, 0, 0, 1]
poi "hall1" //[20, 0, 4, 0, 0, 0, 1]
lift "lift1" at hall0, hall1 comes within 40 takes 10 to 20{cabin}
connect hall0 and hall1 distance 4{by}
event "fetch" location hall1
agent "bot" controllable mobile 1 location hall0 can_do fetch
agent "guest" mobile 1 location hall0
reach_objective: do fetch
"""
UP, DOWN = "going_hall0_to_hall1", "going_hall1_to_hall0"


CABINS = " //[4, 0, 0, 0, 0, 1, 0] hall1 [24, 0, 4, 0, 0, 1, 0]"


def files(cabin: str = CABINS, by: str = " by lift1") -> Dict[str, bytes]:
    read = parse(HOTEL.format(cabin=cabin, by=by), "hotel.pur", "hotel")
    won = solve_scenario(read, DEFAULT)
    return generate(read, won.network, won.objective, won.strategy, Options(reaction=DEFAULT.reaction))


def test_a_robot_waits_in_front_of_the_lift_and_in_the_cabin_as_it_is_on_its_floor() -> None:
    data = yaml.safe_load(files()["src/controller_bot/config/poses.yaml"])
    ways = read_poses(data).doors["bot"]
    assert data["format"] == 5 and set(ways) == {UP, DOWN}
    assert ways[UP] == (
        Doorway(frozenset({"lift1 at hall0"}), [2.0, 0, 0, 0, 0, 0, 1.0]),
        Doorway(frozenset({"lift1 at hall1"}), [4.0, 0, 0, 0, 0, 1.0, 0], True, [24.0, 0, 4.0, 0, 0, 1.0, 0]),
    )
    assert ways[DOWN][0].wait == [22.0, 0, 4.0, 0, 0, 0, 1.0]
    assert ways[DOWN][1].wait == [24.0, 0, 4.0, 0, 0, 1.0, 0]


def test_where_a_lift_goes_straight_up_on_one_map_the_robot_knows_where_it_is() -> None:
    ways = read_poses(yaml.safe_load(files(" //[4, 0, 0, 0, 0, 1, 0]")["src/controller_bot/config/poses.yaml"])).doors
    assert ways["bot"][UP][1].out is None
    waits = [ways["bot"][way][1].wait for way in (UP, DOWN)]
    assert [wait and wait[2] for wait in waits] == [0.0, 4.0], "it gets in at the height of its floor"


def test_without_a_pose_of_the_cabin_it_goes_on_where_it_gets_in() -> None:
    ways = read_poses(yaml.safe_load(files("")["src/controller_bot/config/poses.yaml"])).doors["bot"]
    assert ways[UP] == (Doorway(frozenset({"lift1 at hall0"})),)


def test_the_node_for_doors_knows_who_rides_from_where_to_where() -> None:
    made = files()
    settings = yaml.safe_load(made["src/UI/config/ui.yaml"])
    assert read_lifts(settings) == {
        "lift1": (40.0, 20.0, ("hall0", "hall1"), {"bot": {UP: ("hall0", "hall1"), DOWN: ("hall1", "hall0")}})
    }
    assert "doors" in settings["nodes"] and b'name="doors"' in made["src/hotel_bringup/launch/mission.launch"]


def test_without_a_mission_robots_drive_on_ways_by_no_lift() -> None:
    made = files()

    def read(name: str) -> Any:
        return yaml.safe_load(made[f"src/UI/config/{name}"])

    with pytest.raises(DataError, match="no robot of this scenario is mobile"):
        driven_robots(read, {}, lambda _: None)


def test_where_no_way_goes_by_lift_nothing_is_different() -> None:
    made = files(by="")
    assert "lifts" not in yaml.safe_load(made["src/UI/config/ui.yaml"])
    assert b'name="doors"' not in made["src/hotel_bringup/launch/mission.launch"]
    assert yaml.safe_load(made["src/controller_bot/config/poses.yaml"])["format"] == 1


@given(st.floats(-9, 9), st.floats(-9, 9))
def test_robots_wait_between_the_cabin_and_where_they_set_off(x: float, y: float) -> None:
    cabin, start = Pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), Pose(x, y, 1.0, 0.0, 0.0, 0.0, 1.0)
    at = before_cabin(cabin, start)
    far = (x * x + y * y) ** 0.5
    assert (at[0] ** 2 + at[1] ** 2) ** 0.5 == pytest.approx(min(WAITS_AT, far), abs=0.01)
    assert at[0] * y == pytest.approx(at[1] * x, abs=0.02) and at[2] == 1.0
