"""When words without an answer and new states are published again."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.event_words import Word, parse_word
from pursue_runtime.resend import (
    LAST_TIMEOUT,
    REPEATS,
    SHORTEST,
    RepeatedReport,
    StateRepeats,
    resend_interval,
    resend_timeout,
)
from pursue_runtime.state import HOLDING, SystemState


def state(seq: int, stamp: float, **more: str) -> SystemState:
    return SystemState(seq, stamp, {}, {}, {}, **more)  # type: ignore[arg-type]


def test_the_first_resends_lie_within_the_reaction_and_leave_time_for_the_way() -> None:
    times = [sum(resend_timeout(sent, 0.1) for sent in range(1, n + 1)) for n in range(1, REPEATS + 1)]
    assert times == pytest.approx([0.02, 0.04, 0.06])


def test_later_resends_grow_to_twice_the_reaction_and_after_many_to_the_longest_timeout() -> None:
    assert [resend_timeout(sent, 0.1) for sent in range(4, 9)] == pytest.approx([0.04, 0.08, 0.16, 0.2, 0.2])
    assert resend_timeout(1000, 0.1) == LAST_TIMEOUT


def test_where_no_reaction_is_known_timeouts_double_from_half_a_second() -> None:
    assert [resend_timeout(sent) for sent in range(1, 7)] == [0.5, 1.0, 2.0, 4.0, 4.0, 4.0]


@given(st.floats(0.0, 1000.0), st.integers(1, 100))
def test_timeouts_never_shrink_and_stay_within_their_bounds(reaction: float, sent: int) -> None:
    assert SHORTEST <= resend_timeout(sent, reaction) <= resend_timeout(sent + 1, reaction) <= LAST_TIMEOUT


def test_a_new_state_is_published_again_unchanged_and_a_heartbeat_is_not() -> None:
    repeats = StateRepeats(0.1)
    assert repeats.next_moment() is None
    first = state(1, 100.0)
    repeats.on_publish(first, 5.0)
    assert repeats.due(5.019) is None
    found = []
    while repeats.next_moment() is not None:
        moment = repeats.next_moment()
        assert moment is not None
        assert repeats.due(moment) is first
        found.append(moment)
    assert found == pytest.approx([5.02, 5.04, 5.06])
    repeats.on_publish(state(1, 101.0), 6.0)
    assert repeats.next_moment() is None


def test_a_newer_state_takes_the_place_of_the_one_before() -> None:
    repeats = StateRepeats(0.1)
    repeats.on_publish(state(1, 100.0), 5.0)
    newer = state(1, 100.01, status=HOLDING)
    repeats.on_publish(newer, 5.01)
    assert repeats.next_moment() == pytest.approx(5.03)
    assert repeats.due(5.03) is newer


def test_a_state_that_was_published_again_meanwhile_is_repeated_as_it_was_then() -> None:
    """Else the one before it would bring a robot once more an order that it has acknowledged."""
    repeats = StateRepeats(0.1)
    repeats.on_publish(state(1, 100.0)._replace(orders=("bot:aboard@1/gate!",)), 5.0)
    newer = state(1, 100.01)
    repeats.on_publish(newer, 5.01)
    assert repeats.next_moment() == pytest.approx(5.02)
    assert repeats.due(5.02) is newer


def test_a_report_of_a_robot_is_repeated_within_the_reaction_until_the_state_shows_it() -> None:
    report = RepeatedReport(Word("bot", "bot_going_a_to_b2b", as_of=3), 0.1)
    assert report.due(100.0, 5.0) == "bot:bot_going_a_to_b2b#3"
    assert report.due(100.01, 5.01) is None
    assert report.next_moment() == pytest.approx(5.02)
    again = report.due(100.021, 5.021)
    assert again is not None and parse_word(again) == Word("bot", "bot_going_a_to_b2b", as_of=3, at=100.0)
    report.confirmed = True
    assert report.due(104.0, 9.0) is None and report.next_moment() is None


def test_the_interval_has_bounds() -> None:
    assert resend_interval(0.0) == resend_interval(1000.0) == 0.5
    assert resend_interval(0.001) == SHORTEST
