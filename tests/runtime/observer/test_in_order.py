"""With orders of passage others wait for who is late: it counts as lost only where all of them do."""

# ruff: noqa: E501 (automata, one edge per line)

from __future__ import annotations

from typing import Any

import pytest

from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.strategy import read_cover
from tests.runtime.observer.test_mission import CHASE, Journey
from tests.runtime.texts import read

WALKING = CHASE.replace("  locations: {b: []}\n", "  locations: {b: [], c: [], going_b_to_c: [Cdog <= 40]}\n").replace(
    "  - {from: b, to: b, word: catch, sync: send, when: [Cdog > 1], if: [[Pthief=2]], reset: [Cdog], controllable: true}",
    "  - {from: b, to: going_b_to_c, word: dog_b2c, sync: send, when: [Cdog > 1], reset: [Cdog], controllable: true}\n"
    "  - {from: going_b_to_c, to: c, word: dog_going_b_to_c2c, sync: own, when: [Cdog > 9], reset: [Cdog],"
    " controllable: false}",
)
"""The dog walks from b to c, in 9 to 40 time units."""
ENTRIES = """
cover:
- {state: {bot: a}, wait: [always]}
- {state: {bot: going_a_to_b}, wait: [always]}
- {state: {bot: b}, wait: [always]}
- {state: {dog: b}, wait: [always]}
- {state: {dog: going_b_to_c}, wait: [always]}
- {state: {dog: c}, wait: [always]}
"""
IN_ORDER = f"format: 4\nagents: [bot, dog]\n{ENTRIES}"


class Walk(Journey):
    """A mission in which nothing is commanded any more."""

    def __init__(self, cover: str = IN_ORDER) -> None:
        self.logs = []
        log = lambda level, message: self.logs.append((level, message))
        options: Any = {"on_uncovered": "plan", "controllers": ("one",), "lost_after": 8.0}
        self.mission = Mission(Model(read(WALKING)), read_cover(read(cover)), log, **options)


def journey(cover: str = IN_ORDER) -> Journey:
    """The bot is under way, to be there at 6; the dog is from 3 on, to be there at 43."""
    made = Walk(cover)
    made.hear("_start_", 0.0)
    made.hear("bot_a2b", 2.0)
    made.hear("dog_b2c", 3.0)
    return made


def until(made: Journey, end: float) -> Any:
    """The state at a moment; the mission is woken whenever it has asked for that."""
    now = 3.0
    for _ in range(20):
        moment = made.mission.next_moment(now)
        if moment is None or moment > end:
            break
        assert moment >= now
        made.mission.on_time(moment)
        now = moment
    else:
        raise AssertionError("it is woken again and again")
    return made.hear("_ping_", end)


def test_who_is_late_is_not_lost_as_long_as_others_have_something_to_do() -> None:
    state = until(journey(), 40.0)
    assert (state.status, state.late, state.lost) == ("running", ("bot",), ())
    state = until(journey(f"format: 1\n{ENTRIES}"), 40.0)
    assert (state.status, state.lost) == ("holding", ("bot",)), "as without orders of passage"


def test_it_goes_on_as_if_nothing_had_been_when_it_arrives() -> None:
    made = journey()
    until(made, 40.0)
    state = made.hear("bot_going_a_to_b2b", 41.0)
    assert (state.status, state.late, state.lost, state.locations["bot"]) == ("running", (), (), "b")
    assert made.mission.counts["taken"] == 3 and made.mission.plan_request is None


def test_where_all_others_wait_it_is_lost_and_waited_for_where_no_plan_does_without_it() -> None:
    made = journey()
    until(made, 20.0)
    made.hear("dog_going_b_to_c2c", 21.0)
    moment, state = made.tick_from(21.0)
    assert moment == pytest.approx(21.0) and (state.status, state.lost) == ("holding", ("bot",))
    wanted = made.mission.plan_request
    assert wanted.excused == ("bot",) and not wanted.awaited
    (state,) = made.mission.on_no_plan(wanted.number, "nobody else can", 22.0)
    assert state.status == "holding" and state.reason.endswith("no other plan: nobody else can; waiting for {bot}")
    state = made.hear("bot_going_a_to_b2b", 80.0)
    assert (state.status, state.lost, state.reason) == ("running", (), "")


def test_no_plan_is_looked_for_while_all_wait_for_one_that_is_not_lost() -> None:
    made = journey()
    made.hear("dog_going_b_to_c2c", 12.5)
    state = until(made, 13.9)
    assert (state.status, state.late, state.lost, made.mission.plan_request) == ("running", ("bot",), (), None)
    assert until(made, 14.1).lost == ("bot",)


def test_who_has_failed_is_lost_at_once_and_not_waited_for() -> None:
    made = journey()
    state = made.hear("bot:_failed_", 10.0)
    assert (state.status, state.lost) == ("holding", ("bot",))
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "nobody else can", 11.0)
    assert state.status == "stopped"


def test_an_observer_that_is_started_again_waits_on() -> None:
    made = journey()
    made.hear("dog_going_b_to_c2c", 12.5)
    until(made, 20.0)
    again = Walk()
    again.mission.adopt(made.hear("_ping_", 20.0)._asdict(), 21.0)
    (state,) = again.mission.on_no_plan(again.mission.plan_request.number, "nobody else can", 22.0)
    assert state.status == "holding" and "waiting for {bot}" in state.reason
