"""A node that has seen a mission under way does not follow it back, and says so; what is legitimate still counts."""

from __future__ import annotations

from typing import Any, List, Tuple

import pytest

from pursue_runtime.state import SystemState, rewinds
from pursue_runtime.state_checks import OLD, OTHER, OURS, REFUSED, StateFilter

OWN = "a" * 12


def state(
    seq: int, stamp: float, status: str = "running", bot: str = "a", event: str = "e", **more: Any
) -> SystemState:
    return SystemState(seq, stamp, {"bot": bot}, {"P": 1}, {"C": 1.0}, event, status=status, mission=OWN, **more)


class Node:
    """A filter and its clock."""

    def __init__(self) -> None:
        self.real = 0.0
        self.filter = StateFilter(OWN, OWN, clock=lambda: self.real)

    def see(self, *states: SystemState) -> List[str]:
        return [self.filter.classify(each) for each in states]


KNOWN = state(9, 100.0)


@pytest.mark.parametrize("strange", [
    state(0, 101.0, "waiting"), state(1, 101.0), state(8, 101.0), state(8, 5000.0, "holding"), state(3, 101.0, "won"),
    state(9, 101.0, bot="b"), state(9, 101.0, event="f"), state(9, 100.0, bot="b"), state(9, 101.0)._replace(values={}),
])
def test_a_mission_is_not_followed_back(strange: SystemState) -> None:
    node = Node()
    assert node.see(KNOWN, strange, strange) == [OURS, REFUSED, REFUSED]
    assert node.filter.newest == KNOWN and "state 9" in node.filter.refused and not node.filter.clock_set_back
    assert node.see(state(9, 102.0), state(10, 103.0)) == [OURS, OURS] and node.filter.refused == ""


@pytest.mark.parametrize("usual", [
    state(9, 101.0), state(9, 101.0, late=("bot",)), state(10, 101.0), state(12, 101.0, "holding", event=""),
    state(9, 101.0, "stopped", event=""), state(9, 101.0, "won", event=""), state(10, 101.0, "won"),
    state(0, 101.0, "stopped", event=""), state(4, 101.0, "lost", event=""),
])
def test_what_comes_next_counts_and_so_does_a_stop_of_any_number(usual: SystemState) -> None:
    assert Node().see(KNOWN, usual) == [OURS, OURS]


@pytest.mark.parametrize("late", [state(0, 10.0, "waiting"), state(8, 99.0), state(8, 100.0), state(9, 99.0, bot="b")])
def test_what_a_cut_link_brings_late_is_dropped(late: SystemState) -> None:
    node = Node()
    assert node.see(KNOWN, late) == [OURS, OLD] and node.filter.refused == ""


@pytest.mark.parametrize("end", ["won", "lost", "stopped"])
def test_the_next_mission_begins_after_an_end(end: str) -> None:
    run = state(9, 101.0, end, event=""), state(0, 102.0, "waiting"), state(1, 103.0), state(2, 104.0)
    assert Node().see(KNOWN, *run) == [OURS] * 5
    assert Node().see(KNOWN, run[0], *run[2:]) == [OURS] * 4, "also where it is joined later"


def test_another_mission_is_none_of_ours() -> None:
    assert Node().see(KNOWN, state(1, 101.0)._replace(mission="b" * 12)) == [OURS, OTHER]


def test_a_node_that_was_cut_off_at_the_end_joins_the_next_mission_after_a_minute() -> None:
    node = Node()
    node.see(KNOWN)
    for node.real in (1.0, 30.0, 59.0):
        assert node.see(state(0, 200.0 + node.real, "waiting")) == [REFUSED]
        assert node.see(state(1, 200.0 + node.real)) == [REFUSED]
    node.real = 61.0
    assert node.see(state(1, 261.0)) == [REFUSED], "never one that is under way"
    assert node.see(state(0, 261.0, "waiting")) == [OURS] and node.filter.clock_set_back
    assert node.see(state(1, 262.0)) == [OURS] and not node.filter.clock_set_back


def test_a_state_of_another_model_changes_nothing() -> None:
    node = Node()
    node.filter.check = lambda each: "" if each.values else "it has no variables"
    assert node.see(KNOWN, state(10, 101.0)._replace(values={})) == [OURS, REFUSED]
    assert node.filter.newest == KNOWN and "it has no variables" in node.filter.refused
    assert node.see(state(1, 101.0)._replace(mission="b" * 12, values={})) == [OTHER], "that one is not ours to judge"


def test_nothing_rewinds_before_a_mission_is_under_way() -> None:
    ends: Tuple[str, ...] = ("waiting", "won", "lost", "stopped")
    assert not any(rewinds(state(0, 101.0, "waiting"), state(9, 100.0, status)) for status in ends)
