"""An action begins only where the robot is known to be in its place; a robot that is not is sent there first."""

from __future__ import annotations

import pytest

from pursue_runtime.controller.goal import Answer, Movement
from pursue_runtime.controller.trip import STATUS_WAIT
from tests.runtime.controller.robot_world import (
    ABORTED,
    ACTIVE,
    BACK_AGAIN,
    DISPLACED,
    END,
    FAILED,
    HELD,
    PREEMPTED,
    SUCCEEDED,
    B,
    World,
)


def arrived(**settings: object) -> World:
    """A robot that has arrived at b, by its own settings."""
    world = World(**settings)
    world.at(0.0, 0.0)
    world.go()
    world.now += 9.0
    if world.robot.settings.ends == "result":
        world.at(3.2, 4.0)
        world.result(SUCCEEDED)
    else:
        world.at(3.1, 4.0)
        world.wait(0.5)
    world.stay()
    assert world.words[-1:] == [END]
    world.texts.clear()
    return world


@pytest.fixture(params=["result", "pose", "tf"])
def robot(request: pytest.FixtureRequest) -> World:
    """A robot that has arrived at b, and whose position is known."""
    return arrived(ends=request.param, goals="action")


def test_a_robot_that_has_arrived_does_its_action_at_once(robot: World) -> None:
    assert robot.robot.is_placed(robot.now)
    robot.stay(doing="e")
    robot.order("e", "doing_e_in_b")
    assert robot.actions == ["e"] and robot.words == []


@pytest.mark.parametrize("away", [(8.0, 4.0, 0.0), (3.1, 4.0, 3.1)])
def test_a_robot_that_was_taken_away_is_reported_and_goes_back_when_an_action_waits_for_it(
    robot: World, away: "tuple[float, float, float]"
) -> None:
    robot.wait(20.0)
    robot.at(*away)
    assert robot.words == [DISPLACED] and not robot.robot.is_placed(robot.now)
    robot.stay(displaced=True)
    assert robot.wait(60.0) == [] and len(robot.goals) == 1, "it stays there while nothing waits for it"
    assert robot.robot.is_placed(robot.now), "the observer knows, and refuses the command"
    robot.stay(displaced=True, returning=True, running=False)
    assert [goal.movement for goal in robot.goals[1:]] == [Movement("b", B)]
    robot.now += 5.0
    robot.at(3.0, 4.0)
    robot.result(SUCCEEDED)
    robot.wait(0.6)
    assert robot.words[-1] == BACK_AGAIN
    robot.stay()
    assert robot.wait(30.0) == [] and robot.robot.is_placed(robot.now) and robot.robot.trouble == ""


def test_a_robot_that_still_moves_on_its_way_back_is_not_there(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.stay(displaced=True, returning=True, running=False)
    robot.wait(1.0)
    for step in range(20):  # as move_base does at the end: the robot turns where it is to stand
        robot.now += 0.1
        robot.at(3.1, 4.0, 0.48 - 0.03 * step)
    assert BACK_AGAIN not in robot.words, "it was there before it was taken away, but it moves"
    robot.now += 0.1
    robot.result(SUCCEEDED)
    robot.wait(0.6)
    assert robot.words[-1] == BACK_AGAIN


def test_a_robot_is_not_back_while_move_base_has_its_goal_in_progress(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.stay(displaced=True, returning=True, running=False)
    robot.wait(1.0)
    robot.status(Answer(robot.goals[-1].name, robot.now, ACTIVE))
    robot.at(3.0, 4.0)
    robot.wait(5.0)
    assert BACK_AGAIN not in robot.words
    robot.result(SUCCEEDED)
    robot.wait(1.0)
    assert robot.words[-1] == BACK_AGAIN


def test_an_action_that_has_begun_in_the_state_begins_late(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.stay(doing="e")
    robot.order("e", "doing_e_in_b")
    assert robot.actions == [] and set(robot.words) == {DISPLACED} and "is 5.0 m from {b}" in robot.texts[-1]
    robot.stay(doing="e", displaced=True, returning=True, running=False)
    robot.wait(1.0)
    assert len(robot.goals) == 2 and robot.actions == []
    robot.at(3.0, 4.0)
    robot.result(SUCCEEDED)
    robot.wait(0.6)
    assert robot.actions == [] and robot.words[-1] == BACK_AGAIN
    robot.stay(doing="e")
    assert robot.actions == ["e"]


def test_a_robot_may_move_in_its_action(robot: World) -> None:
    robot.stay(doing="clean")
    robot.order("clean", "doing_clean_in_b")
    robot.at(8.0, 4.0)
    assert robot.wait(30.0) == [] and robot.actions == ["clean"] and len(robot.goals) == 1
    robot.stay()
    assert robot.words == [DISPLACED], "it has not come back"


def test_an_action_that_a_person_began_by_hand_is_not_looked_at(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.texts.clear()
    robot.stay(doing="clean")
    assert robot.wait(30.0) == [] and robot.actions == []


def test_a_robot_that_is_being_moved_is_sent_back_when_it_stands(robot: World) -> None:
    robot.at(5.0, 4.0)
    robot.stay(displaced=True, returning=True, running=False)
    for step in range(10):
        robot.at(5.0 + 0.1 * step, 4.0)
        robot.wait(0.3)
    assert len(robot.goals) == 1
    robot.wait(0.5)
    assert len(robot.goals) == 2


def test_a_robot_that_comes_back_by_itself_is_reported(robot: World) -> None:
    robot.at(5.0, 4.0)
    robot.stay(displaced=True)
    robot.at(3.0, 4.0)
    robot.wait(1.0)
    assert robot.words[:2] == [DISPLACED, BACK_AGAIN] and len(robot.goals) == 1


def test_the_way_back_is_held_and_fails_as_other_ways_do(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.stay(displaced=True, returning=True, running=False)
    robot.wait(1.0)
    robot.result(PREEMPTED)
    robot.wait(STATUS_WAIT)
    assert robot.words[-1] == HELD
    robot.stay(displaced=True, returning=True, held=True, running=False)
    robot.wait(30.0)
    assert len(robot.goals) == 2
    robot.stay(displaced=True, returning=True, running=False)
    for _ in range(3):
        robot.result(ABORTED)
        robot.wait(2.0)
    assert len(robot.goals) == 5 and robot.words[-1] == FAILED
    robot.stay(lost=True, running=False)
    robot.wait(30.0)
    assert len(robot.goals) == 5


def test_a_robot_that_is_sent_elsewhere_on_its_way_back_is_taken_back_though_it_moves(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.stay(displaced=True, returning=True, running=False)
    robot.wait(1.0)
    own = robot.goals[-1].name
    for step in range(5):
        robot.at(8.0 - 0.2 * step, 4.0)
        robot.wait(0.1)
    robot.status(Answer(own, robot.now, PREEMPTED), Answer("rviz-1", robot.now, ACTIVE))
    assert [goal.movement for goal in robot.goals[1:]] == [Movement("b", B)] * 2 and HELD not in robot.words


def test_the_way_back_ends_with_the_need_for_it(robot: World) -> None:
    robot.at(8.0, 4.0)
    robot.stay(displaced=True, returning=True, running=False)
    robot.wait(1.0)
    robot.stay(displaced=True)
    robot.result(ABORTED)
    robot.wait(30.0)
    assert len(robot.goals) == 2 and robot.robot.goal == ""


def test_what_is_known_by_results_alone_ends_with_a_goal_of_another_node() -> None:
    robot = World(goals="action", ends="result", position="none")
    robot.go()
    robot.result(SUCCEEDED)
    robot.stay()
    own = Answer(robot.goals[-1].name, robot.now, SUCCEEDED)
    robot.status(own)
    assert robot.robot.is_placed(robot.now) and robot.words == [END]
    robot.status(own, Answer("rviz-1", robot.now, ACTIVE))
    assert robot.words[-1] == DISPLACED and not robot.robot.is_placed(robot.now)
    assert robot.texts[-1].endswith("was sent away from {b} by another node")


@pytest.mark.parametrize("goals", ["simple", "action"])
def test_words_are_believed_until_another_node_sends_the_robot_away(goals: str) -> None:
    robot = World(goals=goals)
    robot.go()
    ours = robot.goals[-1].name if goals == "action" else "/move_base-1"
    robot.status(Answer(ours, robot.now, ACTIVE))
    robot.stay()  # its own word has ended the movement
    robot.status(Answer(ours, robot.now, SUCCEEDED))
    assert robot.robot.is_placed(robot.now) and robot.words == []
    robot.wait(5.0)
    robot.status(Answer("rviz-1", robot.now, ACTIVE))
    assert robot.words == [DISPLACED] and not robot.robot.is_placed(robot.now)
    robot.stay(displaced=True)
    robot.status(Answer("rviz-1", robot.now, SUCCEEDED))
    assert robot.wait(30.0) == [] and len(robot.goals) == 1, "it stays there while nothing waits for it"
    robot.stay(displaced=True, returning=True, running=False)
    assert [goal.movement for goal in robot.goals[1:]] == [Movement("b", B)]
    back = robot.goals[-1].name if goals == "action" else "/move_base-2"
    robot.wait(0.3)
    robot.status(Answer(back, robot.now, ACTIVE))
    assert robot.words == [DISPLACED]
    robot.status(Answer(back, robot.now, SUCCEEDED))
    assert robot.words == [DISPLACED, BACK_AGAIN]
    robot.stay()
    assert robot.robot.is_placed(robot.now) and robot.wait(30.0) == [] and robot.robot.trouble == ""


def test_a_controller_that_is_started_again_knows_that_a_robot_with_words_was_sent_away() -> None:
    robot = World(goals="action")
    robot.stay(displaced=True)
    assert robot.wait(30.0) == []
    robot.stay(displaced=True, returning=True, running=False)
    robot.result(SUCCEEDED)
    assert robot.words[-1] == BACK_AGAIN and len(robot.goals) == 1


def test_a_person_may_say_that_a_robot_with_words_is_back() -> None:
    robot = World(goals="action")
    robot.stay()
    robot.status(Answer("rviz-1", robot.now, ACTIVE))
    robot.stay(displaced=True)
    robot.status()
    robot.stay()
    assert robot.robot.is_placed(robot.now) and robot.wait(30.0) == []


def test_a_robot_with_words_may_have_goals_of_its_own_in_its_action() -> None:
    robot = World(goals="action")
    robot.stay(doing="clean")
    robot.order("clean", "doing_clean_in_b")
    robot.status(Answer("own-1", robot.now, ACTIVE))
    robot.status(Answer("own-1", robot.now, SUCCEEDED))
    robot.stay()
    assert robot.robot.is_placed(robot.now) and robot.words == []


def test_where_nothing_is_known_the_robot_is_sent_to_its_place_first() -> None:
    robot = World(goals="action", ends="result", position="none")
    robot.stay()
    assert robot.words == [DISPLACED]
    robot.stay(displaced=True, returning=True, running=False)
    robot.result(SUCCEEDED)
    assert robot.words[-1] == BACK_AGAIN and len(robot.goals) == 1


def test_a_position_may_take_a_while_to_come() -> None:
    robot = World(goals="action", ends="result")
    robot.stay()
    robot.wait(1.0)
    robot.at(3.0, 4.0)
    robot.wait(30.0)
    assert robot.words == []
    late = World(goals="action", ends="result")
    late.stay()
    assert late.wait(3.0)[:1] == [2.0] and late.words[0] == DISPLACED


def test_a_position_that_comes_after_the_arrival_and_contradicts_it_counts() -> None:
    robot = World(goals="action", ends="result")
    robot.go()
    robot.result(SUCCEEDED)
    robot.stay()
    assert robot.robot.is_placed(robot.now)
    robot.at(8.0, 4.0)
    assert robot.words[-1] == DISPLACED and not robot.robot.is_placed(robot.now)


def test_words_alone_are_believed() -> None:
    robot = World()
    robot.stay(doing="e")
    robot.order("e", "doing_e_in_b")
    assert robot.actions == ["e"] and robot.robot.is_placed(robot.now) and robot.words == []


def test_a_robot_that_reports_its_ends_itself_is_looked_at_where_a_position_is_given() -> None:
    robot = World(position="pose")
    robot.stay()
    robot.at(9.0, 9.0)
    assert robot.words == [DISPLACED]


def test_what_is_done_at_once_waits_for_the_robot_too(robot: World) -> None:
    robot.at(3.0, 4.0)
    robot.stay(running=False)
    robot.order("beep")
    assert robot.actions == ["beep"], "it is decided, whatever the mission waits for"
    robot.at(8.0, 4.0)
    robot.order("beep")
    robot.wait(5.0)
    assert robot.actions == ["beep"]
    robot.at(3.0, 4.0)
    robot.wait(1.0)
    assert robot.actions == ["beep", "beep"]


@pytest.mark.parametrize("ends", ["result", "tf"])
def test_where_the_position_is_not_published_any_more_the_arrival_does_not_count(ends: str) -> None:
    robot = arrived(ends=ends, goals="action")
    robot.vanish()
    assert not robot.robot.is_placed(robot.now) and robot.words == []
    robot.wait(3.0)
    assert robot.words[:1] == [DISPLACED] and "no position" in robot.texts[0]
    robot.stay(displaced=True)
    robot.at(3.0, 4.0)
    robot.wait(1.0)
    assert robot.words[-1] == BACK_AGAIN


def test_a_position_that_is_missing_for_a_moment_is_not_reported(robot: World) -> None:
    robot.vanish()
    robot.wait(1.0)
    robot.at(3.1, 4.0)
    robot.wait(30.0)
    assert robot.words == [] and robot.robot.is_placed(robot.now)
