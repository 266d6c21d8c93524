"""Simulated time: small steps, never backwards, and a pause after each message."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.simulator.clock import MAX_FILES, ClockFile, Pace, SimClock, read_pace, send_whole
from tests.waiting import PATIENCE


def test_it_starts_after_zero_and_goes_in_steps() -> None:
    clock = SimClock(Pace(speed=5, step=0.02))
    assert clock.now > 0
    first = clock.now
    assert clock.tick(10.0) == pytest.approx(first + 0.02)
    assert clock.tick(99.0) == pytest.approx(first + 0.04), "it does not catch up"


def test_it_holds_after_a_message_and_goes_on() -> None:
    clock = SimClock(Pace(hold=0.03))
    clock.on_message(10.0)
    held = clock.tick(10.01)
    clock.on_message(10.02)
    assert clock.tick(10.04) == held, "each message starts the pause anew"
    assert clock.tick(10.06) > held


def test_a_clock_that_holds_is_published_seldom() -> None:
    clock = SimClock(Pace(step=0.02, hold=1.0))
    first = clock.message(10.0)
    assert first is not None
    clock.on_message(10.0)
    told = [clock.message(10.0 + milliseconds / 1000) for milliseconds in range(1, 1000)]
    published = [moment for moment in told if moment is not None]
    assert set(published) == {first} and 15 < len(published) < 25
    assert clock.message(11.0) == pytest.approx(first + 0.02), "at once when it goes on"


def test_a_subscriber_that_does_not_read_holds_nothing_up_and_gets_whole_messages() -> None:
    ours, its = socket.socketpair()
    message = bytes(range(16))
    with ours, its:
        its.settimeout(PATIENCE)
        sent = 0
        while send_whole(ours, message):
            sent += 1
        assert not send_whole(ours, message), "it does not wait"
        received = b"".join(its.recv(len(message), socket.MSG_WAITALL) for _ in range(sent))
        assert received == message * sent and sent > 10
        assert send_whole(ours, message) and its.recv(100) == message


def test_a_subscriber_that_has_gone_is_an_error() -> None:
    ours, its = socket.socketpair()
    with ours:
        its.close()
        with pytest.raises(OSError):
            send_whole(ours, b"1234")


def test_the_period_makes_the_speed_which_is_that_of_real_time_until_the_first_word() -> None:
    clock = SimClock(Pace(speed=5, step=0.02))
    clock.on_message(10.0)
    assert clock.period == pytest.approx(0.02)
    clock.on_word(11.0)
    assert clock.period == pytest.approx(0.004)
    held = clock.tick(11.01)
    assert clock.tick(11.05) == held < clock.tick(11.2), "a word is a message too"


def test_a_slow_clock_is_slow_before_the_first_word_too() -> None:
    assert SimClock(Pace(speed=0.5, step=0.02)).period == pytest.approx(0.04)


def test_a_clock_of_a_mission_that_is_under_way_goes_at_its_speed_at_once() -> None:
    assert SimClock(Pace(speed=5, step=0.02), 7.5, has_begun=True).period == pytest.approx(0.004)


def test_a_step_is_a_share_of_the_time_unit() -> None:
    assert read_pace({}) == Pace()
    assert read_pace({"time_unit": 0.5, "speed": 10}) == Pace(speed=10.0, step=0.01)
    assert read_pace({"time_unit": 0.5, "step": 2, "hold": 0}) == Pace(step=2.0, hold=0.0)


@given(st.lists(st.tuples(st.booleans(), st.floats(0, 100))))
def test_it_never_goes_back_nor_jumps(happenings: list) -> None:
    clock = SimClock(Pace(step=0.02))
    before = clock.now
    for message, real in happenings:
        if message:
            clock.on_message(real)
        else:
            after = clock.tick(real)
            assert before <= after <= before + 0.02 + 1e-9
            before = after


def test_it_goes_on_where_a_killed_one_was(tmp_path: Path) -> None:
    path = str(tmp_path / "pursue" / "example" / "clock-1")
    memory = ClockFile(path)
    assert memory.last is None
    for moment in (1.02, 123456789.25, 7.5):
        memory.save(moment)
        assert ClockFile(path).last == moment, "a shorter number leaves nothing of a longer one"
    again = SimClock(Pace(step=0.02), ClockFile(path).last)
    assert again.tick(0.0) == pytest.approx(7.52)


def test_old_clocks_are_forgotten(tmp_path: Path) -> None:
    for number in range(MAX_FILES + 5):
        ClockFile(str(tmp_path / f"clock-{number}"))
    assert len(list(tmp_path.iterdir())) == MAX_FILES
