"""A restarted observer goes on from the newest state that it and the other nodes agree on, or stops and says why."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from pursue_runtime.observer.witnesses import Restart, contradicts, find_state, mission_seen
from pursue_runtime.state import SystemState

NOTHING = SystemState(0, 0.0, {}, {}, {}, status="waiting")
DAMAGE = "its first line cannot be read"


def state(seq: int, stamp: float = 100.0, status: str = "running", bot: str = "a", **more: Any) -> SystemState:
    """A state whose clock was reset at moment 90."""
    fields = {"event": "e" if status == "running" else "", "agent": "bot" if status == "running" else "", **more}
    return SystemState(seq, stamp, {"bot": bot}, {"Pbot": 1}, {"Cbot": stamp - 90.0}, status=status, **fields)


FRESH = state(0, status="waiting")


def found(own: SystemState, damage: str = "", after: float = 0.0, **seen: SystemState) -> Restart:
    return find_state(own, damage, after, seen)


@pytest.mark.parametrize("seen", [
    {}, {"UI": NOTHING}, {"UI": state(3)}, {"UI": state(7)}, {"UI": state(7, stamp=140.0), "simulator": state(2)},
])
def test_a_whole_journal_counts_where_nobody_has_seen_more(seen: Dict[str, SystemState]) -> None:
    assert found(state(7), **seen) == Restart()


@pytest.mark.parametrize("own, damage", [(state(6), ""), (state(6), "torn"), (FRESH, ""), (FRESH, DAMAGE)])
def test_the_newest_state_that_was_seen_is_adopted(own: SystemState, damage: str) -> None:
    seen = {"UI": state(9, bot="b"), "controller_bot": state(8), "simulator": state(9, stamp=130.0, bot="b")}
    assert found(own, damage, **seen, late=NOTHING).adopt in (seen["UI"], seen["simulator"])


def test_a_damaged_journal_and_a_state_of_the_same_number_is_enough() -> None:
    assert found(state(6), DAMAGE, UI=state(6)).adopt == state(6)


@pytest.mark.parametrize("seen", [
    {}, {"UI": NOTHING}, {"UI": state(9, mission="b" * 12)}, {"UI": state(9, stamp=99.0)},
])
def test_without_a_whole_journal_and_a_witness_it_stops_with_the_reason(seen: Dict[str, SystemState]) -> None:
    """Of another mission, or of the one before."""
    finding = found(FRESH, DAMAGE, after=99.0, **seen)
    assert finding.adopt is None and DAMAGE in finding.stop and "no other node" in finding.stop
    assert found(FRESH, after=99.0, **seen) == Restart(), "nothing has begun"


def test_where_the_damaged_journal_leads_further_it_stops() -> None:
    stop = found(state(6), DAMAGE, UI=state(5), simulator=state(4)).stop
    assert "it leads to state 6" in stop and "UI know of state 5" in stop


@pytest.mark.parametrize("other", [
    state(9, bot="b"), state(9, event="f"), state(9, status="holding"), state(9, plan=1), state(9, held=("bot",)),
    state(9)._replace(clocks={"Cbot": 3.0}), state(9, unit=2.0),
])
def test_where_witnesses_disagree_it_stops(other: SystemState) -> None:
    for own, damage in ((state(6), ""), (FRESH, DAMAGE)):
        finding = found(own, damage, UI=state(9), simulator=other)
        assert finding.adopt is None and "UI and simulator have seen different states 9" in finding.stop


@pytest.mark.parametrize("news", [
    {"orders": ("bot:e@9/b+",)}, {"orders": ()}, {"late": ("bot",)}, {"late": ("bot",), "lost": ("bot",)},
    {"finished": ("bot",)},
])
@pytest.mark.parametrize("own, damage", [(state(9), ""), (state(6), ""), (state(9), DAMAGE)])
def test_witnesses_agree_if_one_of_them_has_seen_sooner_what_changes_without_a_new_number(
    own: SystemState, damage: str, news: Dict[str, Any]
) -> None:
    """A state is published again under its number when an order is acknowledged, and when an agent becomes late."""
    before = state(9, orders=("bot:e@9/b",))
    after = before._replace(stamp=100.4, clocks={"Cbot": 10.4}, **news)
    finding = found(own, damage, controller_bot=before, UI=after)
    assert finding.stop == ""
    assert finding.adopt in (None, after)


def test_where_a_whole_journal_and_a_witness_disagree_it_stops() -> None:
    assert "UI knows of a state 6" in found(state(6), UI=state(6, bot="b")).stop


def test_a_mission_of_another_launch_is_not_taken_up() -> None:
    """Somebody starts another launch, while nodes of the first one still play the mission."""
    seen = {"controller_bot": state(5)}
    assert find_state(FRESH, "", 0.0, seen, begun=False).adopt is None
    assert "controller_bot knows of a state 5" in find_state(FRESH, "", 0.0, seen, begun=False).stop
    assert find_state(FRESH, "", 0.0, {"UI": state(5, status="won")}, begun=False) == Restart()
    for own, damage in ((state(4), ""), (FRESH, DAMAGE)):
        assert find_state(own, damage, 0.0, seen, begun=False).adopt == state(5), "there is a journal of this launch"


def test_an_end_counts_more_than_the_state_before_it() -> None:
    end = state(6, status="stopped")
    assert found(state(6), UI=end, simulator=state(6)).adopt == end
    assert found(end, UI=state(6), simulator=end) == Restart(), "it is published again"


def test_the_end_of_the_mission_before_is_no_obstacle() -> None:
    assert found(FRESH, after=105.0, UI=state(9, status="won", stamp=104.0)) == Restart()


def test_the_mission_is_that_of_the_newest_states() -> None:
    a, b = "a" * 12, "b" * 12
    seen = {"one": state(9, stamp=100.0, mission=a), "two": state(3, stamp=200.0, mission=b), "three": NOTHING}
    assert mission_seen(seen, 0.0) == b
    assert mission_seen(seen, 200.0) is None, "a node that stood still since the end of that mission"
    assert mission_seen({"three": NOTHING, "UI": state(9, status="won")}, 0.0) is None


def test_a_state_that_the_observer_cannot_have_published_is_found() -> None:
    own = state(6)
    for strange in (state(7), state(6, bot="b"), state(9, status="holding")):
        assert contradicts(own, 0.0, strange) and contradicts(FRESH, 0.0, strange)
        assert not contradicts(own, 150.0, strange), "of the mission before"
        assert not contradicts(state(6, status="stopped"), 0.0, strange), "it has ended anyway"
    for usual in (NOTHING, state(5), state(6, stamp=130.0), state(9, status="won"), state(9, mission="b" * 12)):
        assert not contradicts(own, 0.0, usual)
