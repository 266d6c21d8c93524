"""The second recorder tells what was never published from what one recorder has missed."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.second_recorder import READY, SAME, merged, read_second, topics_of
from pursue_gen.replay.record import MissionRecord, RobotOrder, read_word
from pursue_runtime.state import SystemState, format_state

STATE = SystemState(3, 100.0, {"bot1": "a"}, {"Pbot1": 1}, {"Cbot1": 2.0}, status="running")
ORDER = RobotOrder(100.0, "bot1", "controller_bot1", action="clean")
WORD = read_word(99.9, "bot1:clean@2", "controller_bot1")


def record(*received: Any, states: Tuple[SystemState, ...] = (STATE,)) -> MissionRecord:
    """A recording of these words and orders."""
    words = tuple(each for each in received if not isinstance(each, RobotOrder))
    return MissionRecord(states, words, tuple(each for each in received if isinstance(each, RobotOrder)))


@pytest.mark.parametrize("what", [ORDER, WORD])
def test_what_the_second_recorder_alone_has_was_published(what: Any) -> None:
    assert merged(record(), record(what)) == record(what)


@pytest.mark.parametrize("what", [ORDER, WORD])
def test_what_neither_has_stays_missing(what: Any) -> None:
    other = replace(what, node="rviz")
    assert merged(record(other), record(other)) == record(other)


@pytest.mark.parametrize("what", [ORDER, WORD])
def test_what_both_have_is_one_message(what: Any) -> None:
    for apart in (-0.9 * SAME, 0.0, 0.9 * SAME):
        assert merged(record(what), record(replace(what, at=what.at + apart))) == record(what)


@pytest.mark.parametrize("what", [ORDER, WORD])
def test_what_was_published_twice_counts_twice(what: Any) -> None:
    again = replace(what, at=what.at + 0.1)
    assert merged(record(again), record(what, again)) == record(what, again)
    later = replace(what, at=what.at + 2 * SAME)
    assert merged(record(what), record(later)) == record(what, later)


@pytest.mark.parametrize("change", [{"robot": "bot2"}, {"node": "rviz"}, {"action": "paint"}])
def test_another_order_is_another_order(change: Any) -> None:
    other = replace(ORDER, **change)
    assert set(merged(record(ORDER), record(other)).orders) == {ORDER, other}


def test_states_come_by_number_and_a_state_that_both_have_comes_once() -> None:
    before, end = STATE._replace(seq=2, stamp=99.0), STATE._replace(stamp=101.0, status="won")
    found = merged(record(states=(STATE, end)), record(states=(before, STATE)))
    assert found.states == (before, STATE, end)


moments = st.lists(st.floats(0.0, 50.0), max_size=8)


@given(moments, moments)
def test_nothing_that_either_has_is_lost_and_nothing_is_added(first: Any, second: Any) -> None:
    one, two = (record(*(replace(ORDER, at=at) for at in sorted(times))) for times in (first, second))
    found = merged(one, two).orders
    assert not set(one.orders) - set(found) and set(found) <= {*one.orders, *two.orders}
    assert max(len(first), len(second)) <= len(found) <= len(first) + len(second)
    assert merged(one, one).orders == one.orders


def test_what_is_written_is_read_as_far_as_it_goes(tmp_path: Path) -> None:
    def line(topic: str, text: str) -> str:
        data = struct.pack("<L", len(text)) + text.encode()
        return json.dumps([topic, "std_msgs/String", "observer", 100.0, base64.b64encode(data).decode()]) + "\n"

    path = tmp_path / "second.jsonl"
    lines = line("/pursue/system_state", format_state(STATE)), line("/bot1/pursue/actions", "clean")
    path.write_text(json.dumps(READY) + "\n" + "".join(lines) + lines[1][:30])
    found = read_second(path)
    assert [state.seq for state in found.states] == [3]
    assert found.orders == (RobotOrder(100.0, "bot1", "observer", action="clean"),)


def test_it_listens_to_words_states_and_the_orders_of_each_robot() -> None:
    wanted = {"/pursue/events", "/pursue/system_state", "/bot2/pursue/actions", "/bot1/move_base_simple/goal"}
    assert wanted <= {*topics_of(["bot1", "bot2"])}
