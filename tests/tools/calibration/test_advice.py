"""Advice on the reaction: how late commands took effect in a recording, and what follows from that."""

from __future__ import annotations

from typing import List, Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.synthesis.plan_text import read_constraint
from pursue_gen.tools.calibration.advice import reaction_advice, rounded_up
from pursue_gen.tools.replay.check import check
from pursue_gen.tools.replay.orders import due_since
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord, read_word
from tests.tools.replay.recordings import PLAY, Play, game, mission


def delays(play: Play) -> List[float]:
    """How late the commands of a played mission took effect."""
    made = mission(play)
    words: Sequence[RecordedWord] = [read_word(at, str(what), node) for at, topic, node, what in made.heard
                                     if topic == "/pursue/events"]  # fmt: skip
    found = check(MissionRecord(tuple(made.states), tuple(words)), game())
    assert found.reaction == 0.1
    return [round(delay, 4) for delay in found.delays]


def test_a_command_is_late_by_the_time_since_it_was_due_or_decided() -> None:
    assert delays(PLAY) == [0.1, 0.1, 0.0, 0.1, 0.1]  # the third was decided anew when the second took effect
    sooner = tuple((at - 0.06 if at == 11.5 else at, word, node) for at, word, node in PLAY)
    assert delays(sooner) == [0.1, 0.1, 0.0, 0.04, 0.1]


def test_since_when_clocks_are_in_a_zone() -> None:
    zone = tuple(read_constraint("1<C") or ()) + tuple(read_constraint("C<=5") or ())
    assert due_since([zone], {"C": 3.0}, 10.0) == pytest.approx(2.0, abs=1e-5)
    assert due_since([zone], {"C": 3.0}, 0.5) == 0.5
    assert due_since([zone], {"C": 0.5}, 10.0) is None
    assert due_since([zone], {"C": 5.5}, 10.0) == pytest.approx(4.5, abs=1e-5)
    assert due_since([zone, ()], {"C": 0.5}, 3.0) == 3.0
    assert due_since([], {"C": 0.5}, 3.0) is None


def advice(*found: float, reaction: float = 0.1, unit: float = 1.0) -> str:
    return "\n".join(reaction_advice(found, reaction, unit))


def test_what_is_near_the_limit_or_beyond_it_gets_more_time() -> None:
    near = advice(0.01, 0.06)
    assert "0.060 at most (60 ms)" in near and "That is near the limit" in near
    assert "--reaction 0.2; or longer time units, time_unit:=2," in near and "tolerance" not in near
    late = advice(0.02, 0.13, 0.3, unit=0.5)
    assert "2 came too late" in late and "--reaction 0.6" in late and "time_unit:=3," in late
    assert "tolerance:=0.6" in late


def test_what_has_room_is_said_and_what_fits_is_left_alone() -> None:
    assert "--reaction 0.02 would be enough" in advice(0.01, 0.01)
    assert advice(0.03, 0.04).count("\n") == 0
    assert advice() == "" and advice(0.1, reaction=0.0) == ""


@given(st.floats(0.0, 1e4))
def test_numbers_are_rounded_up_to_one_digit(value: float) -> None:
    found = rounded_up(value)
    assert found >= value * (1 - 1e-3) and found <= max(0.001, 2 * value * (1 + 1e-6))
    assert len(f"{found:.10f}".strip("0").replace(".", "").strip("0")) == 1
