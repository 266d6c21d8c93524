"""The end of a mission in which nothing is to be reached: what is due is answered first, and what was kept is said."""

from __future__ import annotations

import pytest

from tests.runtime.observer.test_mission import DEADLINE, Journey

PROMISES = "promises: {obj: {says: if call then answer within 5, kept: answered, answered: true}}"


def mission(ends: str = "", **options: object) -> Journey:
    """A mission of one promise, which has begun at 0."""
    text = DEADLINE.replace("bad: [obj, lose]}", f"bad: [obj, lose], {PROMISES}}}")
    journey = Journey(f"{text}ends: {ends}\n" if ends else text, **options)
    journey.hear("_start_", 0.0)
    return journey


def test_an_operator_ends_it_at_once_where_nothing_is_due() -> None:
    state = mission().hear("Finish!", 3.0)
    assert (state.status, state.reason) == ("won", "kept: if call then answer within 5 (never answered)")


def test_what_is_due_is_answered_first_and_what_comes_then_is_not_waited_for() -> None:
    journey = mission()
    journey.hear("call", 1.0)
    before = journey.mission.seq
    state = journey.hear("Finish!", 2.0)
    assert (state.status, state.seq) == ("running", before), "nothing has changed for the strategy"
    assert state.reason == "the mission ends as soon as what is due is answered: if call then answer within 5"
    assert journey.hear("Finish!", 2.5).status == "running", "once more says nothing new"
    state = journey.hear("answer", 4.0)
    assert (state.status, state.event) == ("won", "answer")
    assert state.reason == "kept: if call then answer within 5 (answered once, after 3.0 at most)"
    assert journey.hear("call", 5.0) is None, "it has ended"


def test_a_promise_that_is_broken_meanwhile_loses_it() -> None:
    journey = mission()
    journey.hear("call", 1.0)
    journey.hear("Finish!", 2.0)
    moment, state = journey.tick_from(2.0)
    assert moment == pytest.approx(6.1) and state.status == "lost"


def test_how_often_and_how_late_at_most_is_counted() -> None:
    journey = mission()
    for moment, late in ((1.0, 0.5), (3.0, 2.0), (8.0, 1.0)):
        journey.hear("call", moment)
        journey.hear("answer", moment + late)
    assert "(answered 3 times, after 2.0 at most)" in journey.hear("Finish!", 10.0).reason


def test_after_its_time_it_ends_by_itself() -> None:
    journey = mission("{after: 20, answered: false}")
    moment, state = journey.tick_from(3.0)
    assert moment == pytest.approx(20.0) and state.status == "won"


def test_after_its_time_what_is_due_is_answered_first() -> None:
    journey = mission("{after: 20, answered: false}")
    journey.hear("call", 18.0)
    moment, state = journey.tick_from(18.0)
    assert moment == pytest.approx(20.0) and state.status == "running" and "as soon as" in state.reason
    assert journey.mission.next_moment(20.0) == pytest.approx(23.1), "the deadline"
    assert journey.hear("answer", 21.0).status == "won"


def test_it_may_end_as_soon_as_all_is_answered() -> None:
    journey = mission("{answered: true}")
    assert journey.mission.next_moment(0.0) is None and journey.hear("_ping_", 1.0).status == "running"
    journey.hear("call", 2.0)
    assert journey.hear("answer", 3.0).status == "won"


def test_after_its_time_it_may_wait_until_all_is_answered() -> None:
    journey = mission("{after: 20, answered: true}")
    journey.hear("call", 2.0)
    assert journey.hear("answer", 3.0).status == "running", "its time has not come"
    journey.hear("call", 19.0)
    state = journey.tick_from(19.0)[1]
    assert (state.status, state.reason) == ("running", "the mission ends as soon as all is answered")
    assert journey.hear("answer", 21.0).status == "won"


def test_an_operator_ends_it_before_its_time() -> None:
    journey = mission("{after: 20, answered: true}")
    assert journey.hear("Finish!", 4.0).status == "won"


def test_a_mission_that_is_taken_over_ends_no_sooner_and_gives_no_numbers() -> None:
    journey = mission("{after: 20, answered: false}")
    journey.hear("call", 2.0)
    seen = journey.hear("answer", 3.0)
    other = mission("{after: 20, answered: false}")
    other.mission.adopt(seen._asdict(), 10.0)
    moment, state = other.tick_from(10.0)
    assert moment >= 20.0 and state.reason == "kept: if call then answer within 5"
