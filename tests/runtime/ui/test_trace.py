"""A trace file says what happens when; a wrong one is refused with its place."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.ui.environment import TraceError, read_trace

WORDS = ["thief_a2b", "thief_b2a", "screw"]


def faults(text: str) -> str:
    with pytest.raises(TraceError) as caught:
        read_trace(text, "thief.yaml", WORDS)
    return str(caught.value)


def test_steps_are_read_in_order() -> None:
    steps = read_trace("- {at: 3.5, do: thief_a2b}\n- at: 30\n  do: human:screw\n- {at: 30, do: _stop_}\n",
                                "t.yaml", WORDS)
    assert [(step.at, step.word) for step in steps] == [(3.5, "thief_a2b"), (30.0, "human:screw"), (30.0, "_stop_")]


def test_an_empty_list_is_a_trace_where_nothing_happens() -> None:
    assert read_trace("[]", "t.yaml", WORDS) == ()


@pytest.mark.parametrize("text, place, expected", [
    ("at: 3\ndo: screw\n", "thief.yaml:1", "list of steps"),
    ("", "thief.yaml:1", "list of steps"),
    ("- {at: 1, do: screw}\n- {at: 2}\n", "thief.yaml:2: step 2", "do: <word>"),
    ("- {at: 1, do: screw, who: bot}\n", "thief.yaml:1: step 1", "do: <word>"),
    ("- screw\n", "thief.yaml:1: step 1", "do: <word>"),
    ("- {at: soon, do: screw}\n", "thief.yaml:1: step 1", "a number of time units"),
    ("- {at: true, do: screw}\n", "thief.yaml:1: step 1", "a number of time units"),
    ("- {at: -1, do: screw}\n", "thief.yaml:1: step 1", "0 or more"),
    ("- {at: .inf, do: screw}\n", "thief.yaml:1: step 1", "0 or more"),
    ("- {at: 1, do: 7}\n", "thief.yaml:1: step 1", "expected an event"),
    ("- {at: 2, do: screw}\n\n- {at: 1, do: screw}\n", "thief.yaml:3: step 2", "order of time"),
    ("- {at: 1, do: thief_a2bb}\n", "thief.yaml:1: step 1", "did you mean thief_a2b?"),
    ("- {at: 1, do: zzz}\n", "thief.yaml:1: step 1", "expected one of screw, thief_a2b, thief_b2a"),
    ("- {at: 1, do: screw}\n- {at: 2, do: [\n", "thief.yaml:", "not YAML"),
])
def test_a_wrong_trace_is_refused_with_its_place(text: str, place: str, expected: str) -> None:
    message = faults(text)
    assert message.startswith(place)
    assert expected in message


def test_all_faults_are_reported_at_once() -> None:
    assert len(faults("- {at: x, do: screw}\n- {at: 1, do: nothing}\n").splitlines()) == 2


@given(st.lists(st.tuples(st.floats(0, 1e6), st.sampled_from(WORDS))))
def test_what_yaml_writes_is_read_back(entries: list) -> None:
    entries.sort(key=lambda entry: entry[0])
    text = yaml.safe_dump([{"at": at, "do": word} for at, word in entries])
    assert [(step.at, step.word) for step in read_trace(text, "t.yaml", WORDS)] == entries


@given(st.text(max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        read_trace(text, "t.yaml", WORDS)
    except TraceError as error:
        assert "t.yaml:" in str(error)
