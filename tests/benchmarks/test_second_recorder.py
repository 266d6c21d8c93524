"""The second recorder tells what was never published from what one recorder has missed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rospy", reason="the names of recorders are the run time's, which needs ROS")

from benchmarks.second_recorder import HEARD, NAME, SAME, bag_of, command, heard_in, merged, topics_of, with_heard
from pursue_gen.tools.replay.record import MissionRecord, RobotOrder, read_word
from pursue_runtime.nodes.publishing import is_recorder
from pursue_runtime.observer.records import format_record
from pursue_runtime.state import SystemState

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


def test_what_one_recorder_could_not_read_is_a_problem_of_the_record() -> None:
    damaged = replace(record(), problems=("the bag was not closed",))
    assert merged(damaged, damaged).problems == ("the bag was not closed", "second recorder: the bag was not closed")


def test_a_recorder_that_came_late_excuses_nothing_as_the_second_is_always_there() -> None:
    assert merged(replace(record(), whole_from=105.0), record()).whole_from < STATE.stamp


def test_a_word_that_the_observer_alone_has_was_published_by_an_unknown_node() -> None:
    heard = replace(WORD, node="")
    assert with_heard(record(), [heard]) == (record(heard), (heard,))
    for apart in (-0.9 * HEARD, 0.0, 0.9 * HEARD):
        assert with_heard(record(WORD), [replace(heard, at=heard.at + apart)]) == (record(WORD), ())
    again = replace(heard, at=heard.at + 0.1)
    assert with_heard(record(WORD), [heard, again]) == (record(WORD, again), (again,))
    other = replace(heard, text="bot1:clean@3", seq=3)
    assert with_heard(record(WORD), [other])[1] == (other,)


def test_what_the_observer_did_by_itself_is_no_word_that_it_has_heard(tmp_path: Path) -> None:
    entries = [
        {"at": 100.0, "call": "hear", "args": ["_start_"], "seq": 1, "status": "running"},
        {"at": 102.0, "call": "tick", "args": [], "seq": 2, "status": "running"},
        {"at": 101.0, "call": "hear", "args": ["bot1:clean@2"], "seq": 3, "status": "running"},
    ]
    head = {"format": 2, "scenario": "scenario_1", "model": "0", "settings": {"time_unit": 0.5}}
    whole, empty, other = (tmp_path / name for name in ("journal-1.jsonl", "journal-2.jsonl", "journal-3.jsonl"))
    whole.write_bytes(b"".join(format_record(number, each) for number, each in enumerate([head, *entries])))
    empty.write_bytes(format_record(0, head))
    other.write_text("nonsense")
    found = [(word.at, word.text) for word in heard_in([empty, whole, other])]
    assert found == [(100.0, "_start_"), (101.0, "bot1:clean@2")]


def test_no_controller_takes_it_for_the_side_of_a_robot() -> None:
    assert is_recorder(NAME)
    given = command(Path("second.bag"), ["/pursue/events"])
    assert f"__name:={NAME}" in given and "/pursue/events" in given and "second.bag" in given


def test_a_bag_that_was_not_closed_is_found(tmp_path: Path) -> None:
    path, active = tmp_path / "second.bag", tmp_path / "second.bag.active"
    assert bag_of(path) == path
    active.touch()
    assert bag_of(path) == active
    path.touch()
    assert bag_of(path) == path


def test_it_listens_to_words_states_and_the_orders_of_each_robot() -> None:
    wanted = {"/pursue/events", "/pursue/system_state", "/bot2/pursue/actions", "/bot1/move_base_simple/goal"}
    assert wanted <= {*topics_of(["bot1", "bot2"])}
