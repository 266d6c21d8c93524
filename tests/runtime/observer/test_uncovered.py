"""Why a mission holds where the strategy has no decision: in words, for people; names of clocks go to the log."""

from __future__ import annotations

import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model, Position
from pursue_runtime.observer.off_plan import uncovered_reason
from pursue_runtime.sentences import in_words
from pursue_runtime.strategy import read_cover
from tests.runtime.models import model_data, worker
from tests.runtime.observer.test_holding import EVERYWHERE, planned
from tests.runtime.observer.test_mission import CHASE, Journey
from tests.runtime.texts import read

COVER = """
format: 1
cover:
- state: {bot: a}
  wait: [Cbot <= 20]
- state: {bot: going_a_to_b}
  wait: [Cbot <= 4]
- state: {bot: b, thief: b}
  wait: [Cbot - Creach <= -5 && Cbot <= 20]
"""

ANYWHERE = "format: 1\ncover: [{state: {}, wait: [always]}]\n"

TECHNICAL = re.compile(r"=|\b[CPS](bot|thief|reach|rule|open)\b|_")
"""What no sentence for people has: values, names of clocks and variables, locations of automata."""


def journey(cover: str = COVER, **options: Any) -> Journey:
    """A mission that holds where the strategy has no decision, at its start at moment 0."""
    made = Journey(CHASE, cover, **{"on_uncovered": "plan", "controllers": ("one",), "lost_after": 8.0, **options})
    made.hear("_start_", 0.0)
    return made


def test_who_is_late_is_named_with_what_it_does() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    moment, state = made.tick_from(2.0)
    while state is None or state.status == "running":
        moment, state = made.tick_from(moment)
    assert state.reason == (
        "{bot} is late on its way from {a} to {b}, and the strategy does not say what to do then; "
        "looking for another plan"
    )
    for _ in ("without it", "with it"):
        made.mission.on_no_plan(made.mission.plan_request.number, "'do catch' cannot be guaranteed from here", moment)
    state = made.hear("_ping_", moment)
    why = "{bot} is late on its way from {a} to {b}, and the strategy does not say what to do then"
    assert state.reason == f"{why}; no other plan: 'do catch' cannot be guaranteed from here; waiting for {{bot}}"


def test_the_log_has_each_part_of_a_reason_once_while_the_mission_holds() -> None:
    made = journey(lost_after=100.0, controllers=("one", "two"))
    made.hear("bot_a2b", 2.0)
    moment, state = made.tick_from(2.0)
    while state is None or state.status == "running":
        moment, state = made.tick_from(moment)
    for word in ("thief_leaves", "going_a_to_b:_blocked_", "_ping_"):  # with each there are other searches, in vain
        while made.mission.plan_request is not None:
            made.mission.on_no_plan(made.mission.plan_request.number, "it cannot be guaranteed from here", 11.0)
        assert made.hear(word, 11.0).status == "holding"
    assert [text for level, text in made.logs if "the mission holds" in text and level == "warn"] == [
        "the mission holds: bot is late on its way from a to b, and the strategy does not say what to do then;"
        " looking for another plan",
        "the mission holds: no other plan: it cannot be guaranteed from here; waiting for bot",
        "the mission holds: the way between a and b is blocked",
    ]
    made.hear("going_a_to_b:_free_", 12.0)
    made.hear("bot_going_a_to_b2b", 12.5)
    planned(made, EVERYWHERE, 12.6)
    assert made.mission.status == "running"
    made.hear("going_a_to_b:_blocked_", 13.0)
    assert made.logs[-1] == ("warn", "the mission holds: the way between a and b is blocked; looking for another plan")


def test_who_is_late_and_what_happens_too_early_or_too_late_is_said_as_people_would() -> None:
    made = journey(ANYWHERE)
    made.hear("bot_a2b", 2.0)
    made.hear("bot_going_a_to_b2b", 3.5)
    assert made.logs[-2] == ("warn", "bot arrives at b 1.5 time units too early; the mission goes on from there")
    made = journey(ANYWHERE)
    made.hear("bot_a2b", 2.0)
    made.mission.on_time(6.5)
    assert ("warn", "bot is late: it is still on its way from a to b") in made.logs
    made.hear("bot_going_a_to_b2b", 7.0)
    assert not [text for _, text in made.logs if "too" in text], "it was late: that is said already"


@pytest.mark.parametrize(("words", "reason"), [
    ((), "the moment at which the strategy goes on has passed; {bot} is at {a} and {thief} is at {b}"),
    ((("bot_a2b", 2.0), ("bot_going_a_to_b2b", 3.0)),
     "this happened at another time than the strategy expects; {bot} is at {b} and {thief} is at {b}"),
    ((("thief_leaves", 11.0), ("bot_a2b", 12.0), ("bot_going_a_to_b2b", 15.5)),
     "the strategy does not say what to do now that {bot} is at {b} and {thief} is at {gone}"),
])
def test_where_nobody_is_late_it_says_what_is_unexpected_and_where_everybody_is(words: Any, reason: str) -> None:
    made = journey()
    state, moment = None, 0.0
    for word, moment in words:
        state = made.hear(word, moment)
    while state is None or state.status == "running":
        moment, state = made.tick_from(moment)
    assert state.reason == f"{reason}; looking for another plan"


@pytest.mark.parametrize(("agents", "rest"), [
    (3, "a1 is at s and a2 is at s"),
    (5, "a1 is at s, a2 is at s, a3 is at s and a4 is at s"),
    (6, "a1 is at s, a2 is at s, a3 is at s and 2 others are elsewhere"),
])
def test_of_many_agents_the_first_are_named(agents: int, rest: str) -> None:
    model = Model(model_data(*(worker(f"a{number}", "robot") for number in range(agents))))
    reason = uncovered_reason(model, read_cover({"format": 1, "cover": []}), model.initial(), 0.1, set())
    assert in_words(reason) == f"the strategy does not say what to do now that a0 is at s, {rest}"


def test_the_names_of_automata_and_clocks_are_in_the_log() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    made.hear("bot_going_a_to_b2b", 3.0)
    technical = [text for level, text in made.logs if level == "debug"]
    assert len(technical) == 1 and " Pbot=2 " in technical[0] and "Creach=3.000" in technical[0]
    holds = [text for level, text in made.logs if level == "warn"]
    assert holds and not [text for text in holds if "Creach" in text or "{" in text]


@given(
    here=st.sampled_from(("a", "going_a_to_b", "b")), thief=st.sampled_from(("b", "gone")),
    clocks=st.lists(st.floats(0, 60), min_size=8, max_size=8), late=st.sets(st.sampled_from(("bot", "thief"))),
    passed=st.floats(0, 50),
)
def test_no_sentence_has_a_name_of_the_automata_and_time_alone_changes_none(
    here: str, thief: str, clocks: Any, late: Any, passed: float
) -> None:
    model, cover = Model(read(CHASE)), read_cover(read(COVER))
    start = model.initial()
    locations = {**start.locations, "bot": here, "thief": thief}
    position = Position(locations, start.values, dict(zip(start.clocks, clocks)))
    reason = uncovered_reason(model, cover, position, 0.1, late)
    assert not TECHNICAL.search(reason)
    assert uncovered_reason(model, cover, position.aged(passed), 0.1, late) == reason
