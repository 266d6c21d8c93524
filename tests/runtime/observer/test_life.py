"""Which status of a mission may follow which: everything else is refused."""

from __future__ import annotations

import contextlib
from typing import List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st
from transitions import MachineError

from pursue_runtime.observer.life import ADOPT, GO_ON, HOLD, LOSE, START, STOP, WIN, Life
from pursue_runtime.state import ENDED, HOLDING, LIVE, LOST, RUNNING, STATUSES, STOPPED, WAITING, WON

ALLOWED = {
    START: ((WAITING,), RUNNING),
    HOLD: (LIVE, HOLDING),
    GO_ON: (LIVE, RUNNING),
    WIN: (LIVE, WON),
    LOSE: (LIVE, LOST),
    STOP: ((WAITING, *LIVE), STOPPED),
}


def life_in(status: str, may_win: bool = True, is_broken: bool = True) -> Life:
    """The life of a mission that has this status."""
    life = Life(lambda: may_win, lambda: is_broken)
    if status != WAITING:
        life.take(ADOPT, "as others have seen", status)
    return life


@pytest.mark.parametrize("status", STATUSES)
@pytest.mark.parametrize("trigger", ALLOWED)
def test_a_trigger_leads_where_it_may_and_is_refused_elsewhere(status: str, trigger: str) -> None:
    sources, target = ALLOWED[trigger]
    life = life_in(status)
    before = life.reason
    assert life.may(trigger) == (status in sources)
    if status in sources:
        life.take(trigger, "a reason")
        assert (life.state, life.reason) == (target, "a reason")
    else:
        with pytest.raises(MachineError):
            life.take(trigger, "a reason")
        assert (life.state, life.reason) == (status, before)


@pytest.mark.parametrize("status", STATUSES)
def test_no_trigger_leads_to_a_status_past_its_conditions(status: str) -> None:
    """The library can make one for each status, which any status could take."""
    with pytest.raises(KeyError):
        life_in(RUNNING).may(f"to_{status}")


@pytest.mark.parametrize(
    ("trigger", "may_win", "is_broken", "reason"),
    [
        (WIN, False, True, ""),
        (LOSE, True, False, "a deadline has passed"),
        (LOSE, True, True, ""),
        (HOLD, True, True, ""),
        (STOP, True, True, ""),
    ],
)
def test_a_trigger_whose_condition_does_not_hold_is_refused(
    trigger: str, may_win: bool, is_broken: bool, reason: str
) -> None:
    life = life_in(RUNNING, may_win, is_broken)
    with pytest.raises(AssertionError):
        life.take(trigger, reason)
    assert (life.state, life.reason) == (RUNNING, "as others have seen")


@pytest.mark.parametrize("status", STATUSES)
def test_what_others_have_seen_is_adopted_unless_nothing_has_begun(status: str) -> None:
    life = life_in(STOPPED)
    if status == WAITING:
        with pytest.raises(AssertionError):
            life.take(ADOPT, "", status)
    else:
        life.take(ADOPT, "", status)
        assert life.state == status


@given(st.lists(st.tuples(st.sampled_from(list(ALLOWED)), st.sampled_from(["", "a reason"])), max_size=20))
def test_no_trigger_but_adopt_leaves_the_end(triggers: List[Tuple[str, str]]) -> None:
    life, ended = life_in(WAITING), ""
    for trigger, reason in triggers:
        with contextlib.suppress(MachineError, AssertionError):
            life.take(trigger, reason)
        ended = ended or (life.state if life.state in ENDED else "")
        assert not ended or life.state == ended
        assert life.reason or life.state not in (HOLDING, LOST, STOPPED)


def test_missions_share_the_machine_and_nothing_else() -> None:
    one, other = life_in(WAITING), life_in(WAITING)
    one.take(START)
    assert (one.state, other.state) == (RUNNING, WAITING)
