"""Whether the observer answers: at once where its process has ended, and never a false alarm."""

from __future__ import annotations

from typing import List, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.links import LOOKS, Presence


def looked(presence: Presence, *looks: Tuple[bool, int]) -> List[bool]:
    """What each of the looks has changed."""
    return [presence.look(is_open, count) for is_open, count in looks]


def test_a_process_that_has_ended_is_seen_at_the_next_look_and_its_return_too() -> None:
    presence = Presence()
    assert looked(presence, (True, 1), (True, 3)) == [False, False] and presence.answers
    assert looked(presence, (False, 3), (False, 3)) == [True, False] and not presence.answers
    assert looked(presence, (True, 3), (True, 0)) == [False, False], "a connection that brings nothing is none"
    assert looked(presence, (True, 1)) == [True] and presence.answers, "another process, with other connections"


def test_one_that_stands_still_or_is_cut_off_is_seen_after_some_looks() -> None:
    presence = Presence()
    presence.look(True, 5)
    changes = looked(presence, *[(True, 5)] * (LOOKS + 2))
    assert changes.index(True) == LOOKS - 1 and changes.count(True) == 1 and not presence.answers
    assert looked(presence, (True, 6)) == [True] and presence.answers


@given(st.lists(st.integers(0, LOOKS - 1), max_size=30))
def test_while_messages_come_it_answers_however_irregularly(pauses: List[int]) -> None:
    presence = Presence()
    for count, pause in enumerate(pauses, start=1):
        looked(presence, *[(True, count)] * (pause + 1))
        assert presence.answers
