"""Simulated robots begin what they are ordered to do when they get that order, and nothing without it."""

from __future__ import annotations

from typing import List, Optional

import pytest

from pursue_gen.tools.simulation.event_queue import EventQueue
from pursue_gen.tools.simulation.faults import Breakdown, FaultPlan
from pursue_gen.tools.simulation.world import SimulatedAgent
from pursue_runtime.event_words import ORDERED
from pursue_runtime.orders import Order
from tests.runtime.models import state
from tests.tools.simulation.stages import stage

THERE, BACK, ACTION = "going_c_to_b", "going_b_to_c", "doing_bot1_inb_in_b"


class Robot:
    """bot1 of the thesis's scenario 1, and what it has reported."""

    def __init__(self, breakdown: Optional[Breakdown] = None) -> None:
        self.events = EventQueue(1000.0)
        self.reports: List[str] = []
        plan = FaultPlan((), "1", 1000.0, 30.0, (), ())
        plan.breakdown = breakdown
        self.stage = stage("thesis/scenario_1")
        self.agent = SimulatedAgent(self.stage, "bot1", self.events, plan, "1", self.report, self.stage.reaction)
        self.enter(1, "c")

    def report(self, agent: str, word: str) -> None:
        """Take a report, for the first time: it is made again until a state shows it."""
        text = word.partition("~")[0]
        if ORDERED not in word and text not in self.reports:
            self.reports.append(text)

    def enter(self, seq: int, location: str) -> None:
        """The state of this number has it at another location, since now."""
        self.agent.on_state(state(self.stage.model, seq, self.events.now, {}, bot1=location))

    def order(self, target: str, seq: int) -> None:
        """It gets the order for this location, from a controller whose newest state is of this number."""
        self.agent.on_order(Order("bot1", "e", seq, target), seq)

    def wait(self, seconds: float) -> None:
        """So much time passes."""
        end = self.events.now + seconds
        while (self.events.next_time() or end) < end:
            self.events.step()
        self.events.now = end


@pytest.mark.parametrize("location", [ACTION, BACK, THERE])
@pytest.mark.parametrize("after", [False, True])
def test_an_order_for_what_is_over_begins_nothing_else(location: str, after: bool) -> None:
    """A controller that was restarted, and gets its first state late, orders what its robot has done already."""
    robot = Robot()
    robot.enter(2, THERE)
    robot.order(THERE, 2)
    robot.wait(12.0)
    assert robot.reports == ["bot1_going_c_to_b2b#2"]
    robot.enter(3, "b")
    robot.reports.clear()
    if not after:
        robot.order(THERE, 2)
    robot.wait(0.1)
    robot.enter(8, location)
    if after:
        robot.order(THERE, 2)
    robot.wait(20.0)
    assert robot.reports == []
    robot.order(location, 8)
    robot.wait(12.0)
    assert robot.reports != []


def test_a_goal_that_is_given_again_just_before_the_arrival_is_none_for_the_next_movement() -> None:
    robot = Robot()
    robot.enter(2, THERE)
    robot.order(THERE, 2)
    robot.wait(12.0)
    robot.order(THERE, 2)  # its controller was started again
    robot.enter(3, "b")
    robot.wait(1.0)
    robot.reports.clear()
    robot.enter(4, BACK)
    robot.wait(20.0)
    assert robot.reports == []
    robot.order(BACK, 4)
    robot.wait(12.0)
    assert robot.reports == ["bot1_going_b_to_c2c#4"]


def test_a_robot_breaks_down_in_what_it_does_and_ends_nothing_else_when_it_can_go_on() -> None:
    robot = Robot(Breakdown("bot1", 1, 0.5, reported=True, back=4.0))
    robot.enter(2, THERE)
    robot.wait(20.0)
    assert robot.reports == []  # it has not begun
    robot.order(THERE, 2)
    robot.wait(5.0)
    assert robot.reports == ["bot1:_failed_#2"]
    robot.enter(3, "b")  # a person has reported its arrival
    robot.enter(4, ACTION)
    robot.wait(10.0)
    assert robot.reports == ["bot1:_failed_#2"]
    robot.order(ACTION, 4)
    robot.wait(5.0)
    assert robot.reports[1:] == ["bot1_inbDONE#4"]


def test_a_robot_that_can_go_on_ends_what_it_was_at() -> None:
    robot = Robot(Breakdown("bot1", 1, 0.5, reported=True, back=30.0))
    robot.enter(2, THERE)
    robot.order(THERE, 2)
    robot.order(THERE, 2)
    robot.wait(30.0)
    assert robot.reports == ["bot1:_failed_#2"]
    robot.wait(6.0)
    assert robot.reports[1:] == ["bot1_going_c_to_b2b#2"]


def test_a_robot_that_has_been_quick_breaks_down_no_more() -> None:
    robot = Robot(Breakdown("bot1", 1, 0.5, reported=True))
    robot.enter(2, THERE)
    robot.order(THERE, 2)
    robot.wait(1.0)
    robot.enter(3, "b")
    robot.wait(1.0)
    robot.enter(4, BACK)
    robot.order(BACK, 4)
    robot.wait(20.0)
    assert robot.reports == ["bot1_going_b_to_c2c#4"]
