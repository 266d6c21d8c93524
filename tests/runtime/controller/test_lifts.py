"""A robot on a way by lift waits in front of it, drives in, says that it is in it, and gets out where it is open."""

from __future__ import annotations

from typing import List

from pursue_runtime.controller.goal import Halt, Movement
from pursue_runtime.controller.whereabouts import place_of
from pursue_runtime.doors.opened import Opened
from tests.runtime.controller.robot_world import ABORTED, END, PREEMPTED, STUCK, SUCCEEDED, WAY, World

FRONT = place_of("l1 at c", [1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0])
CABIN = place_of("l1 at b", [2.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0])
RIDE = WAY._replace(halts=(Halt(frozenset({"l1 at c"}), FRONT), Halt(frozenset({"l1 at b"}), CABIN, True)))
"""The way, by a lift from c to b."""


def on_its_way(ride: Movement = RIDE, **settings: object) -> World:
    robot = World(**{"goals": "action", "ends": "result", **settings})
    robot.state(ride, seq=7)
    robot.robot.start(ride, robot.now)
    robot.act()
    return robot


def opens(robot: World, *floors: str, seq: int = 7) -> None:
    robot.robot.opened = Opened("m", seq, {f"l1 at {floor}": frozenset({"bot1"}) for floor in floors})
    robot.act()


def places(robot: World) -> List[str]:
    return [goal.movement.place.poi for goal in robot.goals]


def test_it_rides() -> None:
    robot = on_its_way()
    assert places(robot) == ["l1 at c"]
    robot.result(SUCCEEDED)
    assert robot.to_lifts == [] and robot.words == []
    opens(robot, "c")
    assert places(robot) == ["l1 at c", "l1 at b"]
    robot.result(SUCCEEDED)
    assert robot.to_lifts == ["bot1:aboard#7"] and robot.words == [], "to be in the lift is no arrival"
    opens(robot)
    robot.wait(20.0)
    assert len(places(robot)) == 2 and len(robot.to_lifts) > 1, "it is said again until the lift is there"
    opens(robot, "b")
    assert places(robot)[2:] == ["b"]
    said = len(robot.to_lifts)
    robot.result(SUCCEEDED)
    robot.wait(20.0)
    assert robot.words[:1] == [END] and len(robot.to_lifts) == said


def test_it_gets_in_where_the_lift_is_open_already() -> None:
    robot = on_its_way()
    first = robot.goals[0].name
    opens(robot, "c")
    robot.result(PREEMPTED, goal=first)
    assert places(robot) == ["l1 at c", "l1 at b"]


def test_a_cabin_that_it_cannot_drive_into_is_tried_again_and_then_reported() -> None:
    robot = on_its_way(retries=1, retry_delay=1.0)
    opens(robot, "c")
    robot.result(ABORTED)
    robot.wait(2.0)
    assert places(robot) == ["l1 at c", "l1 at b", "l1 at b"]
    robot.result(ABORTED)
    assert robot.to_lifts == [] and robot.words == [STUCK]


def test_by_its_position_it_is_in_the_lift_when_it_stands_there() -> None:
    robot = on_its_way(ends="pose")
    opens(robot, "c")
    robot.at(2.0, 2.0)
    robot.result(SUCCEEDED)
    robot.wait(5.0)
    assert robot.to_lifts[:1] == ["bot1:aboard#7"] and robot.words == []
    opens(robot, "b")
    robot.at(3.0, 4.0)
    robot.result(SUCCEEDED)
    robot.wait(5.0)
    assert robot.words[:1] == [END]


def test_it_gets_out_when_it_knows_where_it_is_on_the_map_of_that_floor() -> None:
    inside = RIDE.halts[1]._replace(out=place_of("l1 at b", [22.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    robot = on_its_way(RIDE._replace(halts=(RIDE.halts[0], inside)), ends="result", position="pose")
    opens(robot, "c")
    robot.at(2.0, 2.0)
    robot.result(SUCCEEDED)
    opens(robot, "b")
    assert places(robot) == ["l1 at c", "l1 at b"]
    robot.at(22.0, 2.0)
    assert places(robot) == ["l1 at c", "l1 at b", "b"]


def test_it_gets_out_when_it_is_on_the_map_of_that_level_where_each_has_its_own() -> None:
    room = RIDE._replace(place=place_of("b", [3.0, 4.0, 8.0, 0.0, 0.0, 0.0, 1.0]))
    robot = on_its_way(room, ends="result", position="pose")
    opens(robot, "c")
    robot.at(2.0, 2.0, height=0.0)
    robot.result(SUCCEEDED)
    opens(robot, "b")
    assert places(robot) == ["l1 at c", "l1 at b"], "its map is still that of the level below"
    robot.at(2.0, 2.0, height=8.0)
    assert places(robot) == ["l1 at c", "l1 at b", "b"]


def test_one_that_reports_its_ends_itself_rides_by_itself() -> None:
    robot = on_its_way(RIDE._replace(halts=RIDE.halts[:1]), goals="simple", ends="words")
    assert places(robot) == []
    opens(robot, "c")
    assert places(robot) == ["b"] and robot.to_lifts == []


def test_a_controller_that_begins_while_the_robot_is_in_the_lift_lets_it_out() -> None:
    robot = World(goals="action", ends="result")
    robot.state(RIDE, seq=9)
    assert places(robot) == []
    opens(robot, "b", seq=9)
    assert places(robot) == ["b"]


def test_one_that_begins_while_the_robot_gets_in_lets_it_get_in() -> None:
    robot = World(goals="action", ends="result")
    robot.state(RIDE, seq=9)
    opens(robot, "c", seq=9)
    assert places(robot) == ["l1 at b"]
    robot.result(SUCCEEDED)
    assert robot.to_lifts == ["bot1:aboard#9"]
