"""A robot on a way through a door waits in front of it, and gets its goal when the door is open for it."""

from __future__ import annotations

from pursue_runtime.controller.goal import Halt
from pursue_runtime.controller.whereabouts import place_of
from pursue_runtime.doors.opened import Opened
from tests.runtime.controller.robot_world import ABORTED, END, HELD, PREEMPTED, SUCCEEDED, WAY, World

WAIT = place_of("d1", [1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0])
DOOR = frozenset({"d1"})
THROUGH = WAY._replace(halts=(Halt(DOOR, WAIT),))
"""The way, through a door."""


def on_its_way(wait: bool = True, **settings: object) -> World:
    robot = World(**{"goals": "action", "ends": "result", **settings})
    way = THROUGH if wait else THROUGH._replace(halts=(Halt(DOOR),))
    robot.state(way, seq=7)
    robot.robot.start(way, robot.now)
    robot.act()
    return robot


def opens(robot: World, seq: int = 7, name: str = "bot1") -> None:
    robot.robot.opened = Opened("m", seq, {"d1": frozenset({name})})
    robot.act()


def places(robot: World) -> "list[str]":
    return [goal.movement.place.poi for goal in robot.goals]


def test_it_waits_in_front_and_goes_on_when_the_door_is_open() -> None:
    robot = on_its_way()
    assert places(robot) == ["d1"]
    robot.result(SUCCEEDED)
    assert robot.words == [] and robot.wait(20.0) == [], "to be in front of the door is no arrival"
    opens(robot)
    assert places(robot) == ["d1", "b"]
    robot.result(SUCCEEDED)
    assert robot.words == [END]


def test_it_does_not_stop_where_the_door_is_open_in_time() -> None:
    robot = on_its_way()
    first = robot.goals[0].name
    opens(robot)
    robot.result(PREEMPTED, goal=first)
    assert places(robot) == ["d1", "b"]
    robot.result(SUCCEEDED)
    assert robot.words == [END]


def test_what_was_said_before_it_set_off_or_of_another_robot_does_not_count() -> None:
    robot = on_its_way()
    opens(robot, seq=6)
    opens(robot, name="bot2")
    assert places(robot) == ["d1"]


def test_a_place_in_front_that_it_does_not_reach_is_no_failure() -> None:
    robot = on_its_way(retries=0)
    robot.result(ABORTED)
    assert robot.words == []
    opens(robot)
    assert places(robot) == ["d1", "b"]


def test_without_a_pose_of_the_door_it_gets_no_goal_until_the_door_is_open() -> None:
    robot = on_its_way(wait=False)
    assert places(robot) == []
    opens(robot)
    assert places(robot) == ["b"]


def test_nor_does_one_that_reports_its_ends_itself() -> None:
    robot = on_its_way(goals="simple", ends="words")
    assert places(robot) == []
    opens(robot)
    assert places(robot) == ["b"]


def test_a_goal_that_another_node_cancels_in_front_of_the_door_holds_the_mission() -> None:
    robot = on_its_way()
    robot.status()
    robot.result(PREEMPTED)
    robot.wait(3.0)
    assert robot.words[:1] == [HELD]


def test_it_has_not_arrived_by_its_position_before_the_door_is_open() -> None:
    robot = on_its_way(ends="pose")
    robot.at(3.0, 4.0)
    robot.wait(5.0)
    assert robot.words == []
