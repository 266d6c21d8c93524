"""Goals that are lost before they are taken, and goals that somebody else cancels."""

from __future__ import annotations

import pytest

from pursue_runtime.controller.goal import FIRST_WAIT, Answer, Goal, GoalTracker
from pursue_runtime.controller.settings import Settings
from pursue_runtime.sentences import in_words
from tests.runtime.controller.robot_world import (
    ABORTED,
    ACTIVE,
    BACK,
    END,
    HELD,
    PENDING,
    PREEMPTED,
    RECALLED,
    STUCK,
    SUCCEEDED,
    WAY,
    World,
)

TAKEN_BY_OTHER = "This goal was canceled because another goal was received by the simple action server"


@pytest.fixture(params=["simple", "action"])
def robot(request: pytest.FixtureRequest) -> World:
    """A robot with goals of either kind, on its way to b."""
    world = World(goals=request.param, ends="result")
    world.status()
    world.go()
    return world


def its_id(robot: World) -> str:
    """The id with which move_base lists the last goal."""
    return robot.goals[-1].name if robot.robot.settings.goals == "action" else f"/move_base-{len(robot.goals)}"


def listed(robot: World, status: int = ACTIVE) -> Answer:
    """The last goal, as the status of move_base has it."""
    return Answer(its_id(robot), robot.now, status)


# Taken or not ---------------------------------------------------------------------------------------------------------


def statuses(robot: World, seconds: float, *answers: Answer) -> None:
    """move_base publishes this status five times a second."""
    for _ in range(round(seconds * 5)):
        robot.status(*answers)
        robot.wait(0.2)


def test_a_goal_that_the_robot_does_not_have_is_sent_again_at_growing_intervals(robot: World) -> None:
    sent = []
    for _ in range(200):
        robot.status()
        sent += [robot.now] * (len(robot.goals) > len(sent) + 1)
        robot.wait(0.2)
    gaps = [later - earlier for earlier, later in zip([100.0, *sent], sent)]
    assert gaps == pytest.approx([1.0, 2.2, 4.2, *[8.2] * (len(gaps) - 3)], abs=0.3) and len(gaps) == 6
    assert {goal.movement for goal in robot.goals} == {WAY}


def test_a_goal_that_was_taken_is_never_sent_again(robot: World) -> None:
    robot.wait(0.3)
    entry = listed(robot)
    statuses(robot, 60.0, entry)
    assert len(robot.goals) == 1 and robot.words == []


def test_a_robot_without_a_status_gets_its_goal_once(robot: World) -> None:
    robot.wait(60.0)
    assert len(robot.goals) == 1


def test_one_status_from_before_the_goal_came_means_nothing(robot: World) -> None:
    robot.status()
    robot.wait(0.4)
    entry = listed(robot)
    statuses(robot, 3.0, entry)
    assert len(robot.goals) == 1


def test_a_robot_that_was_started_again_gets_the_goal_again(robot: World) -> None:
    robot.wait(0.1)
    statuses(robot, 3.0, listed(robot))
    statuses(robot, 2.0)
    assert len(robot.goals) == 2
    robot.status(Answer(its_id(robot), robot.now, ACTIVE))
    robot.result(SUCCEEDED, its_id(robot))
    assert robot.words == [END]


def test_a_goal_that_is_lost_is_not_sent_again_while_the_mission_holds_nor_once_it_is_over(robot: World) -> None:
    robot.state(running=False)
    statuses(robot, 20.0)
    assert len(robot.goals) == 1
    robot.state()
    assert len(robot.goals) == 2
    robot.stay()
    statuses(robot, 20.0)
    robot.state(None, running=False)
    statuses(robot, 20.0)
    assert len(robot.goals) == 2


def test_the_same_goal_sent_twice_and_taken_twice_is_no_cancellation() -> None:
    robot = World(ends="result")
    robot.go()
    statuses(robot, 1.4)
    assert len(robot.goals) == 2, "the robot was too slow to list the first one"
    robot.result(PREEMPTED, "/move_base-1", robot.now - 0.1, TAKEN_BY_OTHER)
    robot.status(Answer("/move_base-1", robot.now - 0.1, PREEMPTED), Answer("/move_base-2", robot.now, ACTIVE))
    robot.wait(5.0)
    assert len(robot.goals) == 2 and robot.words == []
    robot.result(SUCCEEDED, "/move_base-2")
    assert robot.words == [END]


def test_results_in_the_status_count_where_the_result_itself_was_missed(robot: World) -> None:
    robot.status(listed(robot))
    robot.wait(3.0)
    robot.status(Answer(its_id(robot), 100.0, SUCCEEDED, "Goal reached."))
    assert robot.words == [END]


def test_a_goal_that_has_ended_before_is_not_taken_for_the_one_that_is_missing() -> None:
    """What the robot is doing may be ours, whatever its clock says; what it has done before the goal is not."""
    robot = World(ends="pose", goals="simple")
    robot.go()
    for _ in range(8):
        robot.status(Answer("/rviz-1", robot.now - 50.0, SUCCEEDED))
        robot.wait(1.0)
    assert len(robot.goals) > 1
    sent = len(robot.goals)
    for _ in range(60):
        robot.status(Answer("/move_base-1", robot.now - 500.0, ACTIVE))
        robot.wait(1.0)
    assert len(robot.goals) == sent


def test_the_status_shows_failures_of_simple_goals_too() -> None:
    robot = World(ends="pose", retries=0)
    robot.go()
    robot.status(Answer("/move_base-1", robot.now, ACTIVE))
    robot.status(Answer("/move_base-1", robot.now, ABORTED, "Robot is oscillating."))
    assert robot.texts == [f"{STUCK}#0 on its way to {{b}}: it moves to and fro"]


# Cancelled by somebody else -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("status", "text"), [(PREEMPTED, ""), (PREEMPTED, TAKEN_BY_OTHER), (RECALLED, "")])
def test_a_robot_whose_goal_is_cancelled_waits_for_a_person(robot: World, status: int, text: str) -> None:
    robot.result(status, its_id(robot), text=text)
    statuses(robot, 30.0)
    assert len(robot.goals) == 1 and set(robot.words) == {HELD} and text in robot.texts[0]
    assert robot.robot.trouble.startswith("on its way to {b}: ") and robot.robot.goal == ""
    robot.state(held=True, running=False)
    assert robot.wait(60.0) == [] and len(robot.goals) == 1
    robot.state()
    assert len(robot.goals) == 2 and robot.goals[1].movement == WAY
    robot.result(SUCCEEDED)
    assert robot.words[-1] == END


def test_a_cancelled_goal_waits_for_the_mission_too(robot: World) -> None:
    robot.result(PREEMPTED, its_id(robot))
    robot.state(held=True, running=False)
    robot.state(running=False)
    assert robot.wait(9.0) == [] and len(robot.goals) == 1
    robot.state()
    assert len(robot.goals) == 2


def test_a_robot_that_is_held_when_its_controller_starts_gets_no_goal_before_it_resumes() -> None:
    robot = World(goals="action", ends="result")
    robot.state(held=True, running=False)
    robot.robot.start(WAY, robot.now)
    robot.wait(30.0)
    robot.state(held=True)
    assert robot.goals == []
    robot.state()
    assert len(robot.goals) == 1


def test_a_new_movement_is_not_held_by_what_became_of_the_goal_before(robot: World) -> None:
    robot.wait(9.0)
    first = its_id(robot)
    robot.stay()
    robot.wait(1.5)
    robot.go(BACK)
    robot.result(PREEMPTED, first, 100.0, TAKEN_BY_OTHER)
    robot.wait(5.0)
    assert HELD not in robot.words and [goal.movement for goal in robot.goals] == [WAY, BACK]


def test_who_brings_a_held_robot_to_its_place_ends_the_movement() -> None:
    robot = World(goals="action", ends="pose")
    robot.go()
    robot.result(PREEMPTED)
    robot.state(held=True, running=False)
    robot.at(3.0, 4.0)
    robot.wait(0.6)
    assert robot.words[-1] == END and len(robot.goals) == 1


# Sent elsewhere by somebody else --------------------------------------------------------------------------------------


def sent_elsewhere(robot: World, name: str, result_first: bool = True) -> None:
    """Another node sends the robot a goal of this id, as move_base shows that: a result, and a status with both."""
    ours = Answer(its_id(robot), robot.now, PREEMPTED, TAKEN_BY_OTHER)
    if result_first:
        robot.result(PREEMPTED, ours.goal, text=TAKEN_BY_OTHER)
    robot.status(ours, Answer(name, robot.now, PENDING))
    if not result_first:
        robot.result(PREEMPTED, ours.goal, text=TAKEN_BY_OTHER)


@pytest.mark.parametrize("result_first", [True, False])
def test_a_robot_that_is_sent_elsewhere_is_taken_back_at_once_and_the_operator_is_told(
    robot: World, result_first: bool
) -> None:
    robot.wait(0.3)
    robot.status(listed(robot))
    robot.wait(3.0)
    sent_elsewhere(robot, "rviz-1", result_first)
    assert [goal.movement for goal in robot.goals] == [WAY, WAY] and robot.words == []
    assert robot.robot.trouble == "on its way to {b}: sent elsewhere by another node; its goal is sent again"
    assert ("warn", f"bot1 {in_words(robot.robot.trouble)}") in robot.said
    robot.wait(0.3)
    statuses(robot, 5.0, listed(robot), Answer("rviz-1", robot.now - 0.3, PREEMPTED))
    assert len(robot.goals) == 2 and robot.words == []
    robot.result(SUCCEEDED, its_id(robot))
    assert robot.words == [END] and robot.robot.trouble == ""


def test_a_person_who_insists_holds_the_robot_and_the_reason_says_how_often(robot: World) -> None:
    for count in range(3):
        robot.wait(0.3)
        robot.status(listed(robot))
        robot.wait(3.0)
        sent_elsewhere(robot, f"rviz-{count}")
    assert len(robot.goals) == 3 and set(robot.words) == {HELD}
    assert f"{HELD}#0 on its way to {{b}}: preempted by another node 3 times: {TAKEN_BY_OTHER}" in robot.texts
    robot.state(held=True, running=False)
    robot.status(Answer("rviz-3", robot.now, ACTIVE))
    robot.wait(30.0)
    assert len(robot.goals) == 3, "never two who send it to and fro"
    robot.state()
    robot.wait(0.3)
    robot.status(listed(robot))
    assert len(robot.goals) == 4
    robot.wait(3.0)
    sent_elsewhere(robot, "rviz-4")
    assert len(robot.goals) == 5, "a person has let it resume: the count begins anew"


def test_without_retries_a_robot_that_is_sent_elsewhere_is_held_at_once() -> None:
    robot = World(goals="action", ends="result", retries=0)
    robot.go()
    sent_elsewhere(robot, "rviz-1")
    assert len(robot.goals) == 1 and "preempted by another node: " in robot.texts[0] and set(robot.words) == {HELD}


def test_a_robot_that_is_sent_elsewhere_while_the_mission_holds_is_taken_back_when_it_goes_on(robot: World) -> None:
    robot.status(listed(robot))
    robot.state(running=False)
    robot.wait(3.0)
    sent_elsewhere(robot, "rviz-1")
    robot.wait(30.0)
    assert len(robot.goals) == 1
    robot.state()
    assert len(robot.goals) == 2 and HELD not in robot.words


def test_a_robot_that_is_sent_elsewhere_after_its_movement_is_not_sent_on_the_old_way(robot: World) -> None:
    robot.status(listed(robot))
    robot.wait(3.0)
    robot.result(PREEMPTED, its_id(robot), text=TAKEN_BY_OTHER)
    robot.stay()
    robot.status(Answer("rviz-1", robot.now, ACTIVE))
    robot.wait(30.0)
    assert len(robot.goals) == 1


@pytest.mark.parametrize("result_first", [True, False])
def test_a_status_that_shows_the_cancellation_alone_decides_at_once(robot: World, result_first: bool) -> None:
    robot.status(listed(robot))
    robot.wait(3.0)
    if result_first:
        robot.result(PREEMPTED, its_id(robot))
        assert robot.words == []
    robot.status(Answer(its_id(robot), robot.now, PREEMPTED))
    assert robot.words == [HELD] and len(robot.goals) == 1


def test_a_goal_of_ours_that_was_lost_is_sent_again_though_another_node_has_one_in_progress(robot: World) -> None:
    robot.wait(0.3)
    robot.status(listed(robot))
    robot.wait(3.0)
    statuses(robot, 1.4, Answer("rviz-1", robot.now, ACTIVE))  # move_base was started again, and has lost ours
    assert len(robot.goals) == 2


def test_a_goal_that_waits_for_its_second_attempt_is_lost_with_the_movement(robot: World) -> None:
    robot.result(ABORTED, its_id(robot))
    robot.status(Answer("rviz-1", robot.now, PENDING))
    robot.stay()
    robot.wait(9.0)
    assert len(robot.goals) == 1


# How often a simple goal may still be answered ------------------------------------------------------------------------


def sent_twice() -> GoalTracker:
    """A tracker of a simple goal that was sent at 100.0, and again at 101.0."""
    tracker = GoalTracker(Settings(goals="simple"))
    tracker.send(Goal("first", WAY), 100.0, 0.0)
    assert tracker.send_again(101.0, 1.0) == Goal("first", WAY)
    return tracker


def test_a_goal_that_was_sent_twice_may_be_cancelled_once_for_the_second_one_to_take_its_place() -> None:
    tracker = sent_twice()
    assert not tracker.ends(Answer("one", 100.6, PREEMPTED)) and tracker.current is not None
    assert tracker.ends(Answer("two", 101.0, PREEMPTED)) and tracker.current is None


def test_once_the_robot_drives_by_the_second_one_a_cancelled_goal_is_over() -> None:
    tracker = sent_twice()
    assert tracker.on_status([Answer("two", 101.0, ACTIVE)], 1.0 + FIRST_WAIT)
    assert tracker.ends(Answer("two", 101.0, PREEMPTED)) and tracker.current is None


def test_so_long_as_the_first_answer_may_be_under_way_it_is_waited_for() -> None:
    tracker = sent_twice()
    assert tracker.on_status([Answer("two", 101.0, ACTIVE)], 0.9 + FIRST_WAIT)
    assert not tracker.ends(Answer("two", 101.0, PREEMPTED)) and tracker.current is not None


def test_a_goal_that_was_sent_once_is_over_when_it_is_cancelled() -> None:
    tracker = GoalTracker(Settings(goals="simple"))
    tracker.send(Goal("first", WAY), 100.0, 0.0)
    assert tracker.ends(Answer("one", 100.0, PREEMPTED)) and tracker.current is None
