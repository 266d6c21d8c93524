"""What a controller makes of a robot's answers: goals, ends and failures, each told at the right moment and once."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.controller.goal import Answer
from pursue_runtime.controller.trip import STATUS_WAIT
from pursue_runtime.controller.whereabouts import place_of, turned, yaw_of
from tests.runtime.controller.robot_world import (
    ABORTED,
    ACTIVE,
    BACK,
    END,
    FAILED,
    HELD,
    LOST,
    PREEMPTED,
    REJECTED,
    STUCK,
    SUCCEEDED,
    WAY,
    B,
    World,
)


@pytest.fixture(params=["simple", "action"])
def results(request: pytest.FixtureRequest) -> World:
    """A robot whose ends are results of goals of either kind, on its way to b."""
    world = World(goals=request.param, ends="result")
    world.go()
    return world


# Ends by results ------------------------------------------------------------------------------------------------------


def test_the_result_of_its_goal_is_its_end(results: World) -> None:
    results.now += 9.5
    results.result(SUCCEEDED)
    assert results.words == [END] and len(results.goals) == 1


def test_a_report_has_the_number_of_the_first_state_that_shows_what_it_is_about() -> None:
    robot = World(goals="action", ends="result", retries=0)
    robot.state(seq=7)
    robot.robot.start(WAY, robot.now)
    robot.act()
    robot.state(seq=8)
    robot.result(SUCCEEDED)
    assert robot.texts == [f"{END}#7"]
    robot.stay(seq=9)
    robot.state(seq=12)
    robot.robot.start(WAY, robot.now)
    robot.act()
    robot.result(ABORTED)
    assert robot.texts[-1].startswith(f"{STUCK}#12 on its way to {{b}}")


def test_an_end_before_its_window_is_reported_at_once(results: World) -> None:
    results.result(SUCCEEDED)
    assert results.words == [END]


def test_an_end_is_repeated_ever_more_slowly_until_the_state_shows_it(results: World) -> None:
    results.result(SUCCEEDED)
    assert results.wait(20.0) == [0.5, 1.5, 3.5, 7.5, 11.5, 15.5, 19.5]
    results.state(None)
    assert results.wait(20.0) == []


def test_a_result_that_comes_twice_is_one_end(results: World) -> None:
    results.result(SUCCEEDED)
    results.result(SUCCEEDED)
    results.state(None)
    results.result(SUCCEEDED)
    assert results.words == [END]


def test_results_of_goals_before_are_not_ends_of_this_one(results: World) -> None:
    results.now += 10.0
    results.result(SUCCEEDED)
    results.state(None)
    old = results.goals[-1].name, results.now - 10.0
    results.now += 2.0
    results.go(BACK)
    for status in (SUCCEEDED, PREEMPTED, ABORTED):
        results.result(status, *old)
        results.result(status, "of_somebody_else", results.now - 5.0)
    assert results.words == [END] and len(results.goals) == 2
    assert results.wait(5.0) == []


def test_a_result_says_nothing_while_the_robot_is_not_under_way(results: World) -> None:
    results.state(None)
    results.result(SUCCEEDED)
    assert results.words == []


def test_a_result_in_between_is_none(results: World) -> None:
    for pending in (0, 1, 6, 7, 77):
        results.result(pending)
    assert results.words == [] and results.wait(5.0) == []


def test_the_end_of_a_goal_of_somebody_else_is_not_ours() -> None:
    action = World(goals="action", ends="result")
    action.go()
    action.result(SUCCEEDED, "rviz-1")
    simple = World(ends="result", retries=0)
    simple.go()
    simple.now += 3.0
    simple.result(PREEMPTED, "ours", simple.now - 2.9)
    simple.result(SUCCEEDED, "rviz-1")
    simple.wait(STATUS_WAIT)
    assert (action.words, simple.words) == ([], [HELD])


@pytest.mark.parametrize("skew", [-0.4, 0.0, 0.4])
def test_clocks_of_robots_may_be_off(skew: float) -> None:
    world = World(ends="result")
    world.go()
    world.now += 0.9
    world.state(None)  # somebody reported the end, the robot still drives
    world.go(BACK)
    world.result(PREEMPTED, "first", 100.0 + skew)
    assert world.words == [] and world.robot.next_moments() == (None, None)
    world.result(SUCCEEDED, "second", 100.9 + skew)
    assert world.words == ["bot1_going_b_to_c2c"]


def test_a_person_may_publish_a_result_without_id_and_stamp() -> None:
    world = World(ends="result")
    for way, count in ((WAY, 1), (BACK, 2)):
        world.go(way)
        world.result(SUCCEEDED, "", 0.0)
        assert len(world.words) == count
        world.state(None)


# Failures -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("status", [ABORTED, REJECTED, LOST])
def test_after_a_failure_the_goal_is_sent_again_and_may_succeed(results: World, status: int) -> None:
    results.result(status)
    assert len(results.goals) == 1
    results.wait(0.99)
    assert len(results.goals) == 1
    results.wait(0.02)
    assert len(results.goals) == 2 and results.goals[1].movement == WAY
    assert results.goals[0].name != results.goals[1].name
    results.result(SUCCEEDED)
    assert results.words == [END]


@pytest.mark.parametrize(("status", "word"), [(ABORTED, STUCK), (REJECTED, FAILED), (LOST, FAILED)])
def test_a_robot_that_fails_again_and_again_is_stuck_if_move_base_has_taken_its_goal_else_it_has_failed(
    results: World, status: int, word: str
) -> None:
    for attempts in (1, 2, 3):
        assert len(results.goals) == attempts and results.words == []
        results.result(status if attempts == 3 else REJECTED)
        results.wait(1.5 if attempts < 3 else 0.0)
    assert results.words == [word]
    results.wait(10.0)
    assert len(results.goals) == 3 and set(results.words) == {word} and len(results.words) > 2


def test_a_failure_is_repeated_until_the_robot_counts_as_lost() -> None:
    world = World(ends="result", retries=0)
    world.go()
    world.result(ABORTED)
    assert world.wait(2.0) == [0.5, 1.5]
    world.state(lost=True)
    assert world.wait(20.0) == [] and world.words == [STUCK] * 3


def test_a_failure_that_is_received_twice_is_one() -> None:
    world = World(ends="result", retries=1)
    world.go()
    world.result(ABORTED)
    world.result(ABORTED)
    world.wait(1.5)
    world.result(ABORTED, world.goals[0].name)
    assert world.words == [] and len(world.goals) == 2


def test_failures_of_a_robot_that_tells_its_ends_itself_are_received_with_action_goals() -> None:
    world = World(goals="action")
    world.go()
    world.result(SUCCEEDED)
    assert world.words == []
    world.go()
    world.result(REJECTED)
    world.wait(1.0)
    assert len(world.goals) == 3


def test_nothing_is_tried_again_while_the_mission_holds_nor_once_it_ended(results: World) -> None:
    results.state(running=False)
    results.result(ABORTED)
    results.wait(10.0)
    assert len(results.goals) == 1
    results.state(running=True)
    assert len(results.goals) == 2
    results.result(ABORTED)
    results.state(None, running=False)
    results.wait(10.0)
    assert len(results.goals) == 2 and results.words == []


def test_an_end_counts_while_the_mission_holds(results: World) -> None:
    results.state(running=False)
    results.result(SUCCEEDED)
    assert results.words == [END]


def test_what_was_decided_is_begun_though_the_mission_holds() -> None:
    """The command of one robot was taken at the moment at which nobody knew what another should do."""
    world = World()
    world.stay()
    world.state(running=False)
    world.robot.start(WAY, world.now)
    world.wait(5.0)
    assert [goal.movement for goal in world.goals] == [WAY] and world.robot.is_open
    world.state(running=True)
    world.wait(5.0)
    assert len(world.goals) == 1
    world.stay(doing="e", running=False)
    world.order("e", "doing_e_in_b")
    world.wait(0.1)
    assert "e" in world.actions


def test_a_goal_waits_while_the_mission_holds_in_which_its_controller_starts() -> None:
    world = World()
    world.state(running=False)
    world.robot.start(WAY, world.now)
    world.wait(5.0)
    assert world.goals == [] and not world.robot.is_open
    world.state(running=True)
    assert [goal.movement for goal in world.goals] == [WAY]


def test_a_robot_that_is_lost_begins_nothing_while_the_mission_holds() -> None:
    world = World()
    world.stay()
    world.state(running=False, lost=True)
    world.robot.start(WAY, world.now)
    world.wait(5.0)
    assert world.goals == [] and not world.robot.is_open
    world.stay(doing="e", running=False, lost=True)
    world.order("e", "doing_e_in_b")
    world.wait(5.0)
    assert world.actions == []


def test_who_left_for_elsewhere_is_not_sent_on_the_old_way(results: World) -> None:
    results.result(ABORTED)
    results.state(None)
    results.wait(10.0)
    assert len(results.goals) == 1 and results.words == []


# Ends by positions ----------------------------------------------------------------------------------------------------


@pytest.fixture(params=["pose", "tf"])
def seen(request: pytest.FixtureRequest) -> World:
    """A robot whose position is looked at, on its way to b (3, 4)."""
    world = World(ends=request.param)
    world.go()
    return world


def test_a_robot_is_there_once_it_has_been_near_for_a_while_without_another_word(seen: World) -> None:
    seen.at(2.0, 2.0)
    assert seen.wait(5.0) == []
    seen.at(3.1, 4.2)
    assert seen.wait(0.6) == [0.5]  # amcl does not tell the pose of a robot that stands
    assert seen.words == [END]


def test_a_robot_that_moves_about_near_its_point_is_not_there_before_it_stands(seen: World) -> None:
    for _ in range(20):
        seen.at(3.1, 4.1)
        assert seen.wait(0.1) == []
        seen.at(2.9, 4.0)
        assert seen.wait(0.1) == []
    assert seen.wait(1.0)[:1] == [pytest.approx(0.4)]


def test_a_robot_that_still_turns_is_not_there(seen: World) -> None:
    for step in range(20):
        seen.at(3.0, 4.0, -0.4 + 0.04 * step)
        assert seen.wait(0.1) == [], "it turns by 0.4 radians a second"
    assert seen.wait(1.0)[:1] == [pytest.approx(0.3)]


def test_noise_of_the_position_is_no_motion(seen: World) -> None:
    for step in range(4):
        seen.at(3.0 + 0.01 * (step % 2), 4.0, 0.02 * (step % 2))
        assert seen.wait(0.1) == []
    assert seen.wait(1.0)[:1] == [pytest.approx(0.1)]


def test_a_robot_stands_where_it_moves_by_no_more_than_it_may() -> None:
    for moved, told in ((0.5, [1.0]), (0.75, [])):
        world = World(ends="pose", end_tolerance=2.0, end_settle=1.0, still_distance=0.5)
        world.go()
        world.at(3.0, 4.0)
        world.wait(0.75)
        world.at(3.0 + moved, 4.0)
        assert [0.75 + moment for moment in world.wait(0.5)][:1] == told


@pytest.mark.parametrize("yaw", [3.12, -3.12, 0.8, -1.0])
def test_a_robot_that_looks_the_wrong_way_is_not_there(seen: World, yaw: float) -> None:
    seen.at(3.0, 4.0, yaw)
    assert seen.wait(20.0) == []
    seen.at(3.0, 4.0, 0.4)
    assert seen.wait(1.0)[:1] == [0.5]


@pytest.mark.parametrize(("x", "yaw", "is_there"), [(4.0, 0.5, True), (4.001, 0.5, False), (4.0, 0.501, False)])
def test_a_robot_is_there_up_to_its_tolerances(x: float, yaw: float, is_there: bool) -> None:
    world = World(ends="pose", end_tolerance=1.0, end_yaw_tolerance=0.5)
    world.go()
    world.at(x, 4.0, yaw)
    assert bool(world.wait(1.0)) == is_there


def test_a_robot_has_arrived_though_amcl_has_not_published_its_last_motion() -> None:
    """What amcl does not publish (0.2 m, 30 degrees) and a local planner's tolerances may add up."""
    robot = World(ends="pose", goals="action")
    robot.go()
    robot.now += 9.0
    robot.at(B.x - 0.2 - 0.15, B.y, math.radians(30.0) + 0.17)
    robot.wait(0.5)
    assert robot.words == [END]


@pytest.mark.parametrize("ends", ["pose", "tf"])
def test_a_robot_has_not_arrived_while_move_base_has_its_goal_in_progress(ends: str) -> None:
    robot = World(ends=ends, goals="action")
    robot.go()
    robot.status(Answer(robot.goals[-1].name, robot.now, ACTIVE))
    robot.at(3.0, 4.0)
    assert robot.wait(5.0) == []
    robot.result(SUCCEEDED)
    assert robot.words == [END]


def test_a_place_without_orientation_demands_none() -> None:
    world = World(ends="pose")
    world.go(BACK)
    world.at(0.0, 0.0, 3.1)
    assert world.wait(1.0)[:1] == [0.5]


@given(heading=st.floats(-3.0, 3.0), roll=st.floats(-0.3, 0.3))
def test_a_heading_is_the_turn_about_the_vertical_axis(heading: float, roll: float) -> None:
    z, w = math.sin(heading / 2), math.cos(heading / 2)
    x, c = math.sin(roll / 2), math.cos(roll / 2)
    assert yaw_of(w * x, z * x, z * c, w * c) == pytest.approx(heading, abs=1e-6)


def test_headings_are_compared_across_half_a_turn() -> None:
    place = place_of("d", [1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    assert turned(place.yaw or 0.0, -3.1) == pytest.approx(0.0416, abs=1e-4)
    assert place_of("d", [1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]).yaw is None


def test_what_becomes_of_the_goal_of_a_robot_that_is_there_does_not_matter() -> None:
    for order in (("at", "failure"), ("failure", "at")):
        world = World(goals="action", ends="pose")
        world.go()
        for what in order:
            world.at(3.0, 4.0) if what == "at" else world.result(ABORTED)
            world.wait(0.6 if what == "at" else 0.3)
        world.wait(20.0)
        assert set(world.words) == {END} and len(world.goals) == 1


def test_a_movement_that_follows_without_a_state_between_is_another_one() -> None:
    world = World(ends="pose")
    world.state(WAY)
    world.at(3.0, 4.0)
    world.state(BACK)
    assert world.wait(5.0) == []
    world.at(0.0, 0.0)
    world.wait(0.5)
    assert world.words == ["bot1_going_b_to_c2c"]


def test_a_robot_that_passes_by_is_not_there(seen: World) -> None:
    for _ in range(5):
        seen.at(3.2, 4.2)
        assert seen.wait(0.4) == []
        seen.at(3.2, 4.3)
        assert seen.wait(0.4) == []


def test_a_goal_where_the_robot_is_already_ends_at_once() -> None:
    world = World(ends="pose", end_settle=0.0)
    world.go()
    world.at(3.0, 4.0)
    assert world.words == [END]


def test_a_robot_that_is_where_it_is_sent_arrives_though_its_position_is_not_published_again(seen: World) -> None:
    seen.at(3.0, 4.0)
    seen.wait(1.0)
    seen.stay()
    seen.at(0.0, 0.0)
    seen.wait(9.0)
    seen.go(BACK)
    assert seen.wait(5.0)[:1] == [0.5] and seen.words[-1] == "bot1_going_b_to_c2c"


def test_a_robot_that_a_person_sent_by_hand_is_seen_to_arrive() -> None:
    world = World(ends="pose")
    world.state(WAY)
    world.at(3.0, 4.0)
    world.wait(0.5)
    assert world.words == [END] and world.goals == []


def test_a_robot_that_failed_and_is_brought_there_is_there() -> None:
    world = World(goals="action", ends="tf", retries=0)
    world.go()
    world.result(ABORTED)
    world.state(lost=True)
    world.at(3.0, 4.0)
    world.wait(0.6)
    assert world.words == [STUCK, END]


def test_success_elsewhere_is_reported_as_a_warning() -> None:
    world = World(goals="action", ends="pose")
    world.go()
    world.at(3.0, 3.0)
    world.result(SUCCEEDED)
    assert world.words == [] and ("warn" in dict(world.said))
