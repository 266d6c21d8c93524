"""Whatever results, statuses, positions and states come, in whatever order: no goal and no action that the state does
not hold, no action twice, and every goal that was lost is sent again."""

from __future__ import annotations

import math
from typing import Any, List, NamedTuple, Optional

from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.controller.goal import Answer, Movement
from pursue_runtime.controller.settings import ENDS, GOALS
from tests.runtime.controller.robot_world import (
    ACTIVE,
    BACK,
    BACK_AGAIN,
    BLOCKED,
    CANCELLED,
    DISPLACED,
    FAILED,
    HELD,
    PREEMPTED,
    WAY,
    B,
    World,
)


class Step(NamedTuple):
    """One thing that happens."""

    kind: str
    value: Any


POSITIONS = [(3.0, 4.0, 0.0), (3.2, 4.0, 0.3), (3.0, 4.0, 3.0), (0.0, 0.0, 0.0), (9.0, 9.0, 0.0)]

STEPS = st.one_of(
    st.builds(Step, st.just("way"), st.sampled_from([WAY, BACK])),
    st.builds(Step, st.just("stay"), st.sampled_from(["", "e"])),
    st.builds(Step, st.just("over"), st.none()),
    st.builds(Step, st.just("lists"), st.tuples(*[st.booleans()] * 4)),
    st.builds(Step, st.just("act"), st.sampled_from(["e", "beep"])),
    st.builds(Step, st.just("result"), st.tuples(st.integers(0, 9), st.integers(-3, -1))),
    st.builds(Step, st.just("status"), st.lists(st.tuples(st.integers(0, 9), st.integers(-3, -1)), max_size=3)),
    st.builds(Step, st.just("other"), st.integers(0, 9)),
    st.builds(Step, st.just("at"), st.sampled_from(POSITIONS)),
    st.builds(Step, st.just("wait"), st.sampled_from([0.1, 0.6, 3.0])),
)


class Anything:
    """A world in which steps happen, and what may be sent there."""

    def __init__(self, goals: str, ends: str, **settings: object) -> None:
        self.world = World(goals=goals, ends=ends, **settings)
        self.way: Optional[Movement] = None
        self.doing: Optional[str] = None
        self.lists = {"running": True, "held": False, "displaced": False, "returning": False}
        self.acts = 0
        self.is_new = False
        self.at: Optional[tuple] = None  # type: ignore[type-arg]
        self.show()

    def show(self) -> None:
        """The state of now."""
        if self.way is not None:
            self.world.state(self.way, **self.lists)
        elif self.doing is not None:
            self.world.stay(B, self.doing, **self.lists)
        else:
            self.world.state(None, running=False)

    def do(self, step: Step) -> None:
        """It happens."""
        kind, value, world = step.kind, step.value, self.world
        if kind == "way" and value != self.way:
            self.way, self.doing, self.is_new = value, None, True
            self.show()
            world.robot.start(value, world.now)
        elif kind == "stay" and (self.way, self.doing) != (None, value):
            self.way, self.doing = None, value
            self.show()
        elif kind == "over":
            self.way, self.doing = None, None
            self.show()
        elif kind == "lists":
            self.lists = dict(zip(self.lists, value))
            self.show()
        elif kind == "act" and self.doing is not None:
            self.acts += 1
            world.order(value, f"doing_e_in_{B.poi}" if self.doing and value == "e" else "b")
        elif kind == "result" and -value[1] <= len(world.goals):
            world.result(value[0], world.goals[value[1]].name)
        elif kind == "status":
            known = [(status, world.goals[which]) for status, which in value if -which <= len(world.goals)]
            world.status(*(Answer(goal.name, world.now, status) for status, goal in known))
        elif kind == "other":
            world.status(Answer("rviz-1", world.now - 9.0, value))
        elif kind == "at":
            self.at = value
            world.at(*value)
        elif kind == "wait":
            world.wait(value)
        world.act()

    def check_goals(self, goals: List[Any]) -> None:
        """What was sent is what the state holds."""
        for goal in goals:
            assert not self.lists["held"]
            if self.way is not None:
                assert goal.movement == self.way and (self.lists["running"] or self.is_new)
                self.is_new = False
            else:
                assert self.doing is not None and self.lists["returning"] and goal.movement.place == B

    def check_words(self, words: List[str]) -> None:
        """What was published is about where the state has the robot."""
        kinds = {FAILED, HELD, DISPLACED, BACK_AGAIN}
        if self.way is not None:
            kinds = {FAILED, BLOCKED, HELD, f"bot1_{self.way.location}2{self.way.place.poi}"}
        assert set(words) <= (kinds if self.way is not None or self.doing is not None else set())


@given(st.sampled_from(GOALS), st.sampled_from(ENDS), st.lists(STEPS, max_size=40))
def test_only_what_the_state_holds_is_sent(goals: str, ends: str, steps: List[Step]) -> None:
    any_world = Anything(goals, ends)
    world = any_world.world
    for step in steps:
        sent, said, done = len(world.goals), len(world.texts), len(world.actions)
        any_world.do(step)
        any_world.check_goals(world.goals[sent:])
        any_world.check_words(world.words[said:])
        assert len(world.actions) <= any_world.acts, "an action twice"
        if len(world.actions) > done and ends in ("pose", "tf"):
            x, y, yaw = any_world.at or (math.inf, math.inf, 0.0)
            assert math.hypot(x - B.x, y - B.y) <= 0.3 and yaw <= 0.5, "an action elsewhere"


@given(st.sampled_from(GOALS), st.sampled_from(ENDS), st.lists(STEPS, max_size=20))
def test_every_goal_that_was_lost_is_sent_again_and_none_that_was_taken(
    goals: str, ends: str, steps: List[Step]
) -> None:
    any_world = Anything(goals, ends)
    world = any_world.world
    for step in steps:
        any_world.do(step)
    any_world.lists = {"running": True, "held": False, "displaced": False, "returning": False}
    any_world.way = any_world.doing = None
    any_world.show()
    any_world.do(Step("at", (9.0, 9.0, 0.0)))
    any_world.do(Step("way", WAY))
    sent = len(world.goals)
    for _ in range(10):
        world.status()
        world.wait(0.5)
    assert len(world.goals) > sent, "move_base has no goal"
    taken = Answer(world.goals[-1].name if goals == "action" else "/move_base-7", world.now, ACTIVE)
    sent = len(world.goals)
    for _ in range(40):
        world.status(taken)
        world.wait(0.5)
    assert len(world.goals) == sent, "move_base has the goal"


@given(st.sampled_from(GOALS), st.sampled_from(ENDS), st.sampled_from(sorted(CANCELLED)), st.lists(STEPS, max_size=20))
def test_a_goal_that_another_node_cancelled_is_not_sent_before_a_person_lets_the_robot_resume(
    goals: str, ends: str, status: int, steps: List[Step]
) -> None:
    any_world = Anything(goals, ends)
    world = any_world.world
    any_world.do(Step("way", WAY))
    world.result(status)
    for step in steps:
        if step.kind in ("way", "stay", "over", "lists", "other"):
            continue
        any_world.do(step)
    assert len(world.goals) == 1
    for lists in ({"held": True, "running": False}, {"running": False}, {}):
        any_world.lists = {"running": True, "held": False, "displaced": False, "returning": False, **lists}
        any_world.show()
    assert len(world.goals) == (1 if world.words and "bot1_going_c_to_b2b" in world.words else 2)


@given(st.sampled_from(GOALS), st.sampled_from(ENDS), st.lists(STEPS, max_size=12), st.integers(0, 3))
def test_another_node_that_insists_is_given_way_to(goals: str, ends: str, steps: List[Step], retries: int) -> None:
    any_world = Anything(goals, ends, retries=retries)
    world = any_world.world
    for step in steps:
        any_world.do(step)
    any_world.lists = {"running": True, "held": False, "displaced": False, "returning": False}
    any_world.way = any_world.doing = None
    any_world.show()
    any_world.do(Step("at", (9.0, 9.0, 0.0)))
    sent = len(world.goals)
    any_world.do(Step("way", WAY))
    for count in range(9):
        ours = world.goals[-1].name if goals == "action" else f"/move_base-{count}"
        world.wait(0.3)
        world.status(Answer(ours, world.now, ACTIVE))
        world.wait(3.0)
        world.status(Answer(ours, world.now, PREEMPTED), Answer(f"rviz-{count}-{world.now}", world.now, ACTIVE))
    assert len(world.goals) == sent + 1 + retries, "its goal, and as many again as the settings say"
    assert world.words[-1] == HELD
