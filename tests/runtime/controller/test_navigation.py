"""What a controller makes of a robot's answers: goals, ends and failures, each told at the right moment and once."""

from __future__ import annotations

import math
from typing import Any, List, NamedTuple, Optional, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.controller.navigation import ENDS, GOALS, Movement, Navigation, read_settings
from pursue_runtime.data import DataError

WAY = Movement("going_c_to_b", "b", 3.0, 4.0)
BACK = Movement("going_b_to_c", "c", 0.0, 0.0)
END, FAILED, BLOCKED = "bot1_going_c_to_b2b", "bot1:_failed_", "bot1:_blocked_"
PREEMPTED, SUCCEEDED, ABORTED, REJECTED, RECALLED, LOST = 2, 3, 4, 5, 8, 9


class World:
    """A robot with a clock: both clocks run alike, `act` does what is due now."""

    def __init__(self, **settings: object) -> None:
        self.now = 100.0
        self.said: List[Tuple[str, str]] = []
        self.robot = Navigation(
            "bot1", read_settings("bot1", settings), lambda level, text: self.said.append((level, text))
        )
        self.goals: List[Any] = []
        self.words: List[str] = []

    def act(self) -> None:
        goal, word = self.robot.due(self.now, self.now)
        self.goals += [goal] if goal else []
        self.words += [word] if word else []

    def go(self, way: Any = WAY) -> None:
        self.state(way)
        self.robot.start(way, self.now)
        self.act()

    def state(self, way: Any = WAY, running: bool = True, lost: bool = False) -> None:
        self.robot.on_state(way, running, lost)
        self.act()

    def result(self, status: int, goal: Optional[str] = None, stamp: Optional[float] = None) -> None:
        """The answer to the last goal, unless another is named."""
        name = self.goals[-1].name if goal is None else goal
        self.robot.on_result(name, self.now if stamp is None else stamp, status, self.now)
        self.act()

    def at(self, x: float, y: float) -> None:
        self.robot.on_position(x, y, self.now)
        self.act()

    def wait(self, seconds: float) -> List[float]:
        """Time passes; it is woken when it asked to be, and in the end. The moments of its words, from now."""
        begin, end = self.now, self.now + seconds
        told = []
        for _ in range(1000):
            wake = min((moment for moment in self.robot.next_moments() if moment is not None), default=math.inf)
            self.now = min(max(self.now, wake), end)
            before = len(self.words)
            self.act()
            told += [self.now - begin] * (len(self.words) - before)
            if wake > end:
                return told
        raise AssertionError("it never sleeps")


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
    assert (action.words, simple.words) == ([], [FAILED])


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


@pytest.mark.parametrize("status", [PREEMPTED, ABORTED, REJECTED, RECALLED, LOST])
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


@pytest.mark.parametrize(
    ("status", "word"),
    [(ABORTED, BLOCKED), (REJECTED, FAILED), (PREEMPTED, FAILED), (RECALLED, FAILED), (LOST, FAILED)],
)
def test_a_robot_that_fails_again_and_again_has_failed_and_its_way_is_blocked_if_move_base_aborts(
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
    assert world.wait(20.0) == [] and world.words == [BLOCKED] * 3


def test_a_failure_that_is_heard_twice_is_one() -> None:
    world = World(ends="result", retries=1)
    world.go()
    world.result(ABORTED)
    world.result(ABORTED)
    world.wait(1.5)
    world.result(ABORTED, world.goals[0].name)
    assert world.words == [] and len(world.goals) == 2


def test_failures_of_a_robot_that_tells_its_ends_itself_are_heard_with_action_goals() -> None:
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


def test_a_goal_waits_while_the_mission_holds() -> None:
    world = World()
    world.state(running=False)
    world.robot.start(WAY, world.now)
    world.wait(5.0)
    assert world.goals == []
    world.state(running=True)
    assert [goal.movement for goal in world.goals] == [WAY]


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


def test_a_robot_that_moves_about_near_its_point_is_there(seen: World) -> None:
    for _ in range(4):
        seen.at(3.1, 4.1)
        assert seen.wait(0.05) == []
        seen.at(2.9, 4.0)
        assert seen.wait(0.05) == []
    assert seen.wait(0.2) == [pytest.approx(0.1)]


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


def test_positions_of_a_robot_that_is_not_under_way_say_nothing(seen: World) -> None:
    seen.at(3.0, 4.0)
    seen.wait(1.0)
    seen.state(None)
    assert not seen.robot.needs_position
    seen.at(0.0, 0.0)
    seen.go(BACK)
    assert seen.wait(5.0) == [] and seen.robot.needs_position, "what was seen before the goal does not count"
    assert seen.words == [END, END]


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
    assert world.words == [BLOCKED, END]


def test_success_elsewhere_is_told_as_a_warning() -> None:
    world = World(goals="action", ends="pose")
    world.go()
    world.at(3.0, 3.0)
    world.result(SUCCEEDED)
    assert world.words == [] and ("warn" in dict(world.said))


# Whatever happens -----------------------------------------------------------------------------------------------------


class Step(NamedTuple):
    kind: str
    value: Any


STEPS = st.one_of(
    st.builds(Step, st.just("state"), st.sampled_from([WAY, BACK, None])),
    st.builds(Step, st.just("hold"), st.booleans()),
    st.builds(Step, st.just("result"), st.tuples(st.integers(0, 9), st.integers(-3, -1))),
    st.builds(Step, st.just("at"), st.sampled_from([(3.0, 4.0), (0.0, 0.0), (9.0, 9.0)])),
    st.builds(Step, st.just("wait"), st.sampled_from([0.1, 0.6, 3.0])),
)


@given(st.sampled_from(GOALS), st.sampled_from(ENDS), st.lists(STEPS, max_size=30))
def test_whatever_comes_it_speaks_of_the_present_way_alone(goals: str, ends: str, steps: List[Step]) -> None:
    world = World(goals=goals, ends=ends)
    way, running, sent = None, True, 0
    for kind, value in steps:
        before, told = len(world.goals), len(world.words)
        if kind == "state" and value != way:
            way, sent = value, 0
            world.go(way) if way else world.state(None, running)
            running = running or way is not None
        elif kind == "hold":
            running = not value
            world.state(way, running)
        elif kind == "result" and -value[1] <= len(world.goals):
            world.result(value[0], world.goals[value[1]].name)
        elif kind == "at":
            world.at(*value)
        elif kind == "wait":
            world.wait(value)
        sent += len(world.goals) - before
        assert all(goal.movement == way for goal in world.goals[before:]) and sent <= 3
        assert running or len(world.goals) == before
        expected = {FAILED, BLOCKED, f"bot1_{way.location}2{way.poi}"} if way else set()
        assert set(world.words[told:]) <= expected
        assert ends != "words" or not set(world.words) - {FAILED, BLOCKED}


# Settings -------------------------------------------------------------------------------------------------------------


def test_a_robots_own_settings_win_over_the_nodes() -> None:
    own_ones = {"ends": "tf", "base_frame": "{robot}/base"}
    given_here = {"config": "", "ends": "pose", "end_tolerance": 1, "bot1": own_ones}
    own, other = (read_settings(robot, given_here) for robot in ("bot1", "bot2"))
    assert (own.ends, own.end_tolerance, own.base_frame) == ("tf", 1.0, "bot1/base")
    assert (other.ends, other.base_frame, other.goals) == ("pose", "bot2/base_link", "simple")


@pytest.mark.parametrize(
    ("given_here", "message"),
    [
        ({"ends": "results"}, "~ends of bot1 is 'results'; expected one of words, result, pose, tf"),
        ({"goals": "service"}, "~goals of bot1 is 'service'; expected one of simple, action"),
        ({"on_stop": True}, "~on_stop is True; expected a name"),
        ({"end_tolerance": -1}, "~end_tolerance is -1; expected a number that is not negative"),
        ({"end_settle": "soon"}, "~end_settle is 'soon'; expected a number"),
        ({"end_settle": math.inf}, "~end_settle is inf; expected a number"),
        ({"retries": 1.5}, "~retries is 1.5; expected a whole number"),
        ({"retries": True}, "~retries is True; expected a whole number"),
        ({"bot1": {"end": "pose"}}, "~bot1 is {'end': 'pose'}; expected some of goals, ends"),
        ({"bot1": "pose"}, "~bot1 is 'pose'; expected some of goals, ends"),
        ({"simulated": True, "ends": "pose"}, "bot1, which is simulated"),
        ({"simulated": True, "bot1": {"goals": "action"}}, "bot1, which is simulated"),
    ],
)
def test_settings_that_cannot_be_are_told(given_here: Any, message: str) -> None:
    with pytest.raises(DataError) as told:
        read_settings("bot1", given_here)
    assert message in str(told.value)
