"""A controller's player speaks when a command is due, for the state it knows; its robot moves once that is taken."""

from __future__ import annotations

from typing import Any, List, Optional, Tuple

import pytest

from pursue_runtime.controller.scheduler import UNREADY, CommandScheduler
from pursue_runtime.event_words import Word
from pursue_runtime.orders import Order, parse_order
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Command, Strategy
from tests.runtime.texts import read

STRATEGY = """
format: 1
controller: controller_bot
commands_agents: [bot]
reaction: 0.2
strategy:
- state: {bot: c}
  commands:
  - {do: bot_c2b, agent: bot, from: c, to: going_c_to_b, when: ["5 <= Cbot && Cbot <= 6"]}
- state: {bot: b}
  commands:
  - {do: catch, agent: bot, from: b, to: b, when: ["1 < Cbot"]}
"""


def player(text: str = STRATEGY) -> Any:
    return CommandScheduler(Strategy(read(text)))


def state(
    seq: int, stamp: float, bot: str = "c", clock: float = 0.0, event: str = "", status: str = "running",
    orders: Any = (),
) -> Any:  # fmt: skip
    what = event, "bot" if event else "", status
    made = SystemState(seq, stamp, {"bot": bot}, {}, {"Cbot": clock}, *what, orders=tuple(orders))
    return made._replace(commanded=bool(orders))


GO = "bot:bot_c2b@2/going_c_to_b"
CATCH = "bot:catch@4/b!"


def test_it_waits_for_the_moment_and_speaks_for_the_state_it_knows() -> None:
    bot = player()
    assert bot.on_state(state(1, 100.0), 100.0) == []
    assert bot.next_wakeup() == (105.0, None)
    assert bot.on_timer(104.9) is None and bot.next_wakeup() == (105.0, None)
    assert bot.on_timer(105.0) == Word("bot", "bot_c2b", 1)


def test_it_does_nothing_before_the_mission_runs_nor_after() -> None:
    for status in ("waiting", "won", "lost", "stopped"):
        bot = player()
        assert bot.on_state(state(0, 100.0, bot="going_c_to_b", status=status), 100.0) == []
        assert bot.next_wakeup() == (None, None) and bot.on_timer(105.0) is None


def test_a_new_state_replaces_what_was_planned() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_state(state(2, 102.0, clock=1.0), 102.0)
    assert bot.next_wakeup() == (106.0, None)
    assert bot.on_timer(106.0).seq == 2


def test_a_word_that_is_not_answered_is_sent_again_ever_more_slowly() -> None:
    bot = player(STRATEGY.replace(" && Cbot <= 6", ""))
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_timer(105.0)
    patience: List[Optional[float]] = []
    for step in range(6):
        patience.append(bot.next_wakeup()[1])
        assert bot.next_wakeup()[0] is None
        assert bot.on_timer(106.0 + step) == Word("bot", "bot_c2b", 1)
    assert patience == pytest.approx([0.04, 0.04, 0.04, 0.08, 0.16, 0.32])
    assert bot.counts["sent_again"] == 6


def test_it_falls_silent_when_the_window_has_passed() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_timer(105.0)
    assert bot.on_timer(107.0) is None and bot.next_wakeup() == (None, None)


def test_an_answered_word_is_not_repeated() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_timer(105.0)
    bot.on_state(state(2, 105.0, bot="going_c_to_b", event="bot_c2b"), 105.0)
    assert bot.next_wakeup() == (None, None) and bot.on_timer(106.0) is None


def test_it_may_wake_late_within_the_reaction_and_not_later() -> None:
    for late, spoken in ((0.09, True), (0.19, True), (0.21, False)):
        bot = player(STRATEGY.replace("Cbot <= 6", "Cbot <= 5"))
        bot.on_state(state(1, 100.0), 100.0)
        assert (bot.on_timer(105.0 + late) is not None) is spoken
        assert bot.counts["too_late"] == (not spoken)


TWO = STRATEGY.replace("Cbot <= 6", "Cbot < 6").replace(
    "- state: {bot: b}",
    '  - {do: bot_c2a, agent: bot, from: c, to: going_c_to_a, when: ["6 <= Cbot"]}\n- state: {bot: b}',
)
"""With a second command in the first state, for later."""


@pytest.mark.parametrize(
    ("clock", "late", "event"),
    [
        (5.99, 0.05, "bot_c2b"),
        (5.99, 0.15, "bot_c2b"),
        (5.99, 0.25, "bot_c2a"),
        (5.5, 0.45, "bot_c2b"),
        (6.0, 0.0, "bot_c2a"),
    ],
)
def test_what_was_due_when_the_state_began_is_said_until_the_reaction_is_over(
    clock: float, late: float, event: str
) -> None:
    bot = player(TWO)
    bot.on_state(state(1, 100.0, clock=clock), 100.0 + late)
    assert bot.next_wakeup()[0] <= 100.0 + late
    assert bot.on_timer(100.0 + late) == Word("bot", event, 1)


def test_a_lost_word_is_said_again_before_another_one_that_is_due_meanwhile() -> None:
    bot = player(TWO.replace("reaction: 0.2", "reaction: 2"))
    bot.on_state(state(1, 100.0, clock=5.9), 100.0)
    assert [bot.on_timer(moment).event for moment in (100.0, 100.5, 101.5, 103.5)] == ["bot_c2b"] * 3 + ["bot_c2a"]


def test_a_window_that_is_still_open_is_used_however_late() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    assert bot.on_timer(105.9) == Word("bot", "bot_c2b", 1)
    assert bot.counts["too_late"] == 0


def test_its_robot_moves_once_the_observer_has_taken_the_word() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    orders = bot.on_state(state(2, 105.0, bot="going_c_to_b", event="bot_c2b", orders=[GO]), 105.0)
    assert orders == [Order("bot", "bot_c2b", 2, "going_c_to_b")]
    assert bot.on_state(state(2, 107.0, bot="going_c_to_b", event="bot_c2b", clock=2.0, orders=[GO]), 107.0) == []
    assert bot.on_state(state(3, 114.0, bot="b", event="bot_going_c_to_b2b"), 114.0) == []


def test_an_instantaneous_action_goes_to_the_robot_too() -> None:
    bot = player()
    bot.on_state(state(3, 114.0, bot="b"), 114.0)
    orders = bot.on_state(state(4, 116.0, bot="b", event="catch", orders=[CATCH]), 116.0)
    assert orders == [Order("bot", "catch", 4, "b", at_once=True)]


@pytest.mark.parametrize("open_order, done", [(CATCH, ()), (GO, (f"{GO}+",))])
def test_an_order_that_was_acknowledged_is_not_given_again_for_a_state_of_the_same_moment(
    open_order: str, done: Tuple[str, ...]
) -> None:
    at = open_order.rstrip("!").partition("/")[2]
    given = state(4, 116.0, bot=at, event="catch", orders=[open_order])
    bot = player()
    assert bot.on_state(given, 116.0) == [parse_order(open_order)]
    assert bot.on_state(given._replace(orders=done), 116.0) == []
    assert bot.on_state(given, 116.4) == [] and bot.counts["old"] == 1
    late = player()
    assert late.on_state(given._replace(orders=done), 116.0) == [each for each in map(parse_order, done) if each]
    assert late.on_state(given, 116.4) == []


def test_orders_of_other_robots_are_not_ours() -> None:
    bot = player()
    bot.on_state(state(1, 100.0, bot="b"), 100.0)
    assert bot.on_state(state(2, 101.0, bot="b", orders=["dog:catch@2/b!"]), 101.0) == []


@pytest.mark.parametrize("order", [GO, "bot:pick_in_box@7/doing_pick_in_box_in_b", CATCH])
def test_one_that_comes_late_or_missed_states_has_the_orders_that_stand(order: str) -> None:
    at = order.rstrip("!").partition("/")[2]
    fresh = player()
    assert fresh.on_state(state(7, 100.0, bot=at, orders=[order]), 101.0) == [parse_order(order)]
    missed = player()
    missed.on_state(state(1, 90.0), 90.0)
    assert missed.on_state(state(7, 100.0, bot=at, orders=[order]), 101.0) == [parse_order(order)]


def test_a_restart_makes_no_order_of_what_somebody_published_by_hand() -> None:
    assert player().on_state(state(2, 102.0, bot="going_c_to_b", event="bot_c2b"), 103.0) == []


def test_a_robot_gets_no_order_that_the_strategy_does_not_hold() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    assert bot.on_state(state(2, 102.0, bot="going_c_to_a", event="bot_c2a"), 102.0) == []
    assert bot.counts["not_ours"] == 1


def test_a_robot_does_not_leave_before_it_has_acknowledged_what_it_was_to_do_at_once() -> None:
    bot = player()
    waiting = state(4, 100.0, clock=5.5, orders=["bot:wave@4/c!"])
    bot.on_state(waiting, 100.0)
    assert bot.on_timer(100.1) is None and bot.next_wakeup() == (None, UNREADY), "not at once again"
    assert bot.on_state(waiting._replace(stamp=100.2, orders=()), 100.2) == [] and bot.is_new
    assert bot.next_wakeup()[0] <= 100.2
    assert bot.on_timer(100.2) == Word("bot", "bot_c2b", 4)


def test_no_command_is_published_for_a_robot_that_cannot_get_the_order() -> None:
    bot = player()
    bot.on_state(state(1, 100.0, clock=5.5), 100.0)
    assert bot.on_timer(100.1, lambda command: command.event != "bot_c2b") is None
    assert bot.on_timer(100.15, lambda command: command.event == "bot_c2b") == Word("bot", "bot_c2b", 1)


def test_a_burst_of_late_states_changes_nothing() -> None:
    """After a cut the newest state may come first, and what was sent before it last."""
    history = [state(1, 100.0), state(2, 105.0, "going_c_to_b", event="bot_c2b"), state(3, 110.0, "b", clock=0.0)]
    bot = player()
    bot.on_state(history[2], 110.2)
    wake = bot.next_wakeup()
    for late in (*history, *reversed(history)):
        assert bot.on_state(late, 112.0) == [], "no robot moves on it"
        assert bot.state == history[2] and bot.next_wakeup() == wake
    assert bot.on_timer(wake[0]) == Word("bot", "catch", 3)
    assert bot.counts["old"] == 4


def test_an_observer_that_counts_back_is_not_followed_and_no_robot_moves() -> None:
    bot = player()
    bot.on_state(state(7, 100.0, "b"), 100.0)
    wake = bot.next_wakeup()
    begun = state(2, 201.0, "going_c_to_b", event="bot_c2b")
    for strange in (state(0, 200.0, status="waiting"), state(1, 200.0), begun, begun._replace(seq=7)):
        assert bot.on_state(strange, 201.0) == []
        assert bot.state.seq == 7 and bot.next_wakeup() == wake


def test_after_an_end_an_observer_that_starts_anew_is_followed_and_so_is_one_whose_clock_was_set_back() -> None:
    bot = player()
    bot.on_state(state(7, 100.0, "b", status="stopped"), 100.0)
    bot.on_state(state(1, 200.0), 200.0)
    assert bot.state.seq == 1
    bot.on_state(state(2, 150.0, "going_c_to_b", event="bot_c2b"), 150.0)
    assert bot.state.seq == 2


def test_a_state_that_is_said_again_is_no_news() -> None:
    bot = player()
    for current, news in ((state(1, 100.0), True), (state(1, 101.0, clock=1.0), False), (state(2, 102.0), True),
                          (state(1, 101.5, clock=1.5), False)):  # fmt: skip
        bot.on_state(current, 102.0)
        assert bot.is_new is news


def test_a_state_that_takes_the_whole_reaction_is_not_too_late() -> None:
    bot = player()
    bot.on_state(state(1, 100.0, clock=6.0), 100.2 + 1e-7)
    assert bot.on_timer(100.2 + 1e-7) == Word("bot", "bot_c2b", 1)


@pytest.mark.parametrize("status", ["won", "lost", "stopped"])
def test_after_the_end_nothing_is_ordered(status: str) -> None:
    bot = player()
    bot.on_state(state(1, 100.0, bot="b", clock=0.5), 100.0)
    assert bot.on_state(state(2, 101.0, bot="b", event="catch", status=status, orders=[CATCH]), 101.0) == []


def test_a_command_waits_until_its_robot_may_begin() -> None:
    bot = player()
    bot.on_state(state(1, 100.0, bot="b", clock=2.0), 100.0)
    asked: List[str] = []

    def may_begin(command: Command) -> bool:
        asked.append(command.event)
        return len(asked) > 2

    assert bot.on_timer(100.0, may_begin) is None and bot.next_wakeup() == (None, UNREADY)
    assert bot.on_timer(100.01, may_begin) is None and bot.counts["sent"] == 0
    assert bot.on_timer(100.02, may_begin) == Word("bot", "catch", 1) and asked == ["catch"] * 3
