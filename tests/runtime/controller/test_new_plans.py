"""A controller goes from one plan to the next with the state that names it, and is silent while the mission holds."""

from __future__ import annotations

from typing import Any

from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.event_words import Word
from pursue_runtime.strategy import Plans, Strategy
from tests.runtime.controller.test_scheduler import STRATEGY, state
from tests.runtime.texts import read

LATER = STRATEGY.replace("5 <= Cbot && Cbot <= 6", "8 <= Cbot")


def player() -> Any:
    return CommandScheduler(Strategy(read(STRATEGY)), "controller_bot")


def plan(text: str = LATER) -> Any:
    return Strategy(read(text))


def test_it_says_that_it_has_a_plan_and_plays_on_until_a_state_names_it() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    assert bot.add_plan(1, plan(), 101.0) == Word("controller_bot", "_plan_", 1)
    assert bot.next_wakeup() == (105.0, None)
    bot.on_state(state(2, 102.0, clock=2.0)._replace(plan=1), 102.0)
    assert bot.next_wakeup() == (108.0, None)
    assert bot.on_timer(108.0).seq == 2


def test_it_does_nothing_by_a_plan_that_it_does_not_have_yet() -> None:
    bot = player()
    bot.on_state(state(2, 100.0, clock=5.5)._replace(plan=1), 100.0)
    assert bot.next_wakeup() == (None, None) and bot.on_timer(100.1) is None
    bot.add_plan(1, plan(), 101.0)
    assert bot.next_wakeup() == (102.5, None)


def test_while_the_mission_holds_nothing_is_due() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_state(state(2, 102.0, clock=2.0, status="holding"), 102.0)
    assert bot.next_wakeup() == (None, None) and bot.on_timer(105.0) is None
    bot.on_state(state(3, 103.0, clock=3.0), 103.0)
    assert bot.next_wakeup() == (105.0, None)


def test_what_happens_while_the_mission_holds_is_no_order_of_ours() -> None:
    bot = player()
    bot.on_state(state(1, 100.0, clock=5.0, status="holding"), 100.0)
    assert bot.on_state(state(2, 100.5, "going_c_to_b", event="bot_c2b", status="holding"), 100.5) == []
    assert bot.counts["not_ours"] == 1


def test_it_says_again_that_it_has_the_plan_while_the_mission_may_wait_for_that() -> None:
    bot = player()
    bot.on_state(state(1, 100.0, status="holding"), 100.0)
    assert bot.repeated_receipt() is None
    bot.add_plan(3, plan(), 100.5)
    assert bot.repeated_receipt() == Word("controller_bot", "_plan_", 3)
    bot.on_state(state(2, 101.0)._replace(plan=3), 101.0)
    assert bot.repeated_receipt() is None


def test_the_plan_in_force_is_kept_however_many_are_made_and_dropped() -> None:
    plans = Plans("own")
    at = lambda number: plans.strategy_for(state(1, 0.0)._replace(plan=number))
    for number in (1, 2, 3):
        plans.add(number, f"plan {number}")
    assert at(0) == "own"
    assert at(2) == "plan 2"
    plans.add(4, "plan 4")
    assert [at(number) for number in (4, 3, 2)] == ["plan 4", "plan 3", "plan 2"]


def test_an_older_plan_than_the_one_in_force_is_forgotten() -> None:
    plans = Plans("own")
    at = lambda number: plans.strategy_for(state(1, 0.0)._replace(plan=number))
    plans.add(1, "plan 1")
    assert at(1) == "plan 1"
    plans.add(2, "plan 2")
    assert [at(number) for number in (0, 1, 2, 3)] == [None, "plan 1", "plan 2", None]
