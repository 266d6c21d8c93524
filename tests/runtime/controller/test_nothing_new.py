"""What agents do that the strategy does not name leaves alone what a controller has decided."""

from __future__ import annotations

from typing import Any, Tuple

from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.event_words import Word
from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.environment import TraceEnvironment
from pursue_runtime.ui.mission_view import MissionView
from tests.runtime.models import model_data, mover
from tests.runtime.texts import read

STRATEGY = """
format: 1
controller: controller_bot
commands_agents: [bot]
reaction: 0.2
strategy:
- state: {bot: a, rule: first}
  commands:
  - {do: bot_a2b, agent: bot, from: a, to: going_a_to_b, when: ["5 <= Cbot && Cbot <= 5.05"]}
"""


def player() -> CommandScheduler:
    return CommandScheduler(Strategy(read(STRATEGY)))


def state(seq: int, stamp: float, event: str = "", agent: str = "", clocks: Tuple[float, float] = (0.0, 0.0),
          rule: str = "first", **fields: Any) -> SystemState:
    """A state of a bot in a, and of a guest of whom the strategy does not speak; `clocks`: theirs."""
    locations = {"bot": "a", "guest": "a" if seq % 2 else "going_a_to_b", "rule": rule}
    return SystemState(seq, stamp, locations, {}, {"Cbot": clocks[0], "Cguest": clocks[1]}, event, agent, **fields)


def test_a_command_that_waits_for_its_moment_names_the_newest_state() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_state(state(2, 102.0, "guest_a2b", "guest", (2.0, 0.0)), 102.0)
    assert bot.next_wakeup() == (105.0, None)
    assert bot.on_timer(105.0) == Word("bot", "bot_a2b", 2)


def test_a_word_that_is_on_its_way_is_sent_again_where_time_has_left_its_zone() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    assert bot.on_timer(105.0) == Word("bot", "bot_a2b", 1)
    patience = bot.next_wakeup()[1]
    bot.on_state(state(2, 105.1, "guest_a2b", "guest", (5.1, 0.0)), 105.1)
    assert not bot.is_new and bot.next_wakeup() == (None, patience)
    assert bot.on_timer(105.15) == Word("bot", "bot_a2b", 2)


def test_what_the_strategy_sees_is_decided_anew() -> None:
    late = {"event": "guest_a2b", "agent": "guest", "clocks": (5.1, 0.0)}
    for changed in (
        {"event": "bot_waves", "agent": "bot", "clocks": (0.0, 5.1)},
        {"rule": "second"},
        {"plan": 3},
        {"event": ""},
        {"status": "holding"},
    ):
        bot = player()
        bot.on_state(state(1, 100.0), 100.0)
        assert bot.on_timer(105.0) is not None
        after: Any = {**late, **changed}
        bot.on_state(state(2, 105.1, **after), 105.1)
        word = bot.on_timer(105.15)
        assert word is None, changed
    missed = player()
    missed.on_state(state(1, 100.0), 100.0)
    missed.on_state(state(4, 105.1, "guest_a2b", "guest", (5.1, 0.0)), 105.1)
    assert missed.on_timer(105.15) is None


def test_a_move_after_which_nothing_has_changed_is_none() -> None:
    bot = player()
    bot.on_state(state(1, 100.0), 100.0)
    assert bot.on_timer(105.0) == Word("bot", "bot_a2b", 1)
    same = state(1, 105.1, "wave", "bot", (5.1, 5.1))._replace(seq=2)
    bot.on_state(same, 105.1)
    assert bot.on_timer(105.15) == Word("bot", "bot_a2b", 2)


def test_instructions_of_people_stand_as_well() -> None:
    orders = Strategy(read(STRATEGY))
    model = Model(model_data(mover("bot", "human", 3), mover("guest", "agent", 3)))
    view = MissionView(model, TraceEnvironment(()), orders)
    view.on_state(state(1, 100.0, event="_start_"), 100.0)
    assert view.due(105.0, 0.0) == ["bot:bot_a2b@1"]
    view.on_state(state(2, 105.1, "guest_a2b", "guest", (5.1, 0.0)), 105.1)
    assert view.due(105.15, 0.05) == ["bot:bot_a2b@2"]
    view.on_state(state(3, 105.18, "bot_waves", "bot", (0.0, 0.08)), 105.18)
    assert view.due(105.19, 0.09) == []


STAGES = STRATEGY + """\
- state: {bot: a, guest: a, rule: second}
  commands:
  - {do: bot_a2c, agent: bot, from: a, to: going_a_to_c, when: ["2 <= Cguest"]}
"""


def test_a_later_stage_is_decided_at_its_beginning_and_by_what_it_names() -> None:
    bot = CommandScheduler(Strategy(read(STAGES)))
    bot.on_state(state(1, 100.0), 100.0)
    bot.on_state(state(2, 102.0, "guest_a2b", "guest", (2.0, 0.0)), 102.0)
    assert not bot.is_new and bot.next_wakeup() == (105.0, None)
    bot.on_state(state(3, 103.0, "done", "rule", (3.0, 1.0), "second"), 103.0)
    assert bot.is_new and bot.next_wakeup() == (104.0, None)
    bot.on_state(state(4, 103.5, "guest_a2b", "guest", (3.5, 0.0), "second"), 103.5)
    assert bot.is_new and bot.next_wakeup() == (None, None)


def test_a_clock_that_somebody_else_starts_again_is_new_where_its_agent_is_named() -> None:
    for clocks, stands in (((0.0, 5.1), False), ((5.1, 0.0), True)):
        bot = player()
        bot.on_state(state(1, 100.0), 100.0)
        assert bot.on_timer(105.0) == Word("bot", "bot_a2b", 1)
        bot.on_state(state(2, 105.1, "guest_a2b", "guest", clocks), 105.1)
        assert bot.is_new is not stands
        assert (bot.on_timer(105.15) == Word("bot", "bot_a2b", 2)) is stands


def test_instructions_follow_the_stage_that_has_begun() -> None:
    model = Model(model_data(mover("bot", "human", 3), mover("guest", "agent", 3)))
    view = MissionView(model, TraceEnvironment(()), Strategy(read(STAGES)))
    view.on_state(state(1, 100.0, event="_start_"), 100.0)
    view.on_state(state(2, 104.0, "guest_a2b", "guest", (4.0, 0.0)), 104.0)
    view.on_state(state(3, 104.9, "done", "rule", (4.9, 0.9), "second"), 104.9)
    assert view.due(105.0, 0.0) == [] and view.next_moments(105.0)[0] == 106.0
    assert view.due(106.0, 1.0) == ["bot:bot_a2c@3"]
