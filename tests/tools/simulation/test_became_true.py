"""When what a returning observer publishes has become true, and what words are junk while it returns."""

from __future__ import annotations

import random
from typing import Any

import pytest

from pursue_gen.tools.simulation.faults import JUNK, junk_word
from pursue_gen.tools.simulation.recorder import BecameTrue
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import SystemState
from tests.tools.simulation.stages import stage

REPORT = "bot1_inbDONE#4"


def shown(seq: int, stamp: float, event: str = "") -> Any:
    """A state that shows the event."""
    return SystemState(seq, stamp, {}, {}, {}, event, "bot1" if event else "", "running")


def test_what_was_reported_became_true_then_and_not_before_the_state_that_was_known() -> None:
    known = BecameTrue()
    known.note("bot1", REPORT, 7.0)
    known.note("bot1", f"{REPORT}~7.0", 9.0)
    assert known.moment(shown(5, 7.02, "bot1_inbDONE"), shown(4, 5.0), 12.0) == 7.0
    assert known.moment(shown(5, 7.5, "bot1_inbDONE"), shown(4, 7.4), 12.0) == 7.4


def test_a_report_without_a_time_may_count_when_it_comes() -> None:
    known = BecameTrue()
    known.note("bot1", REPORT, 7.0)
    known.hear(REPORT, 8.0)
    known.hear(f"{REPORT}~7.0", 11.0)
    assert known.moment(shown(5, 8.0, "bot1_inbDONE"), shown(4, 5.0), 12.0) == 8.0
    assert known.moment(shown(5, 11.0, "bot1_inbDONE"), shown(4, 5.0), 12.0) != 11.0


def test_a_state_that_shows_nothing_new_may_be_from_before_what_nobody_whom_it_reaches_has_seen() -> None:
    assert BecameTrue().moment(shown(4, 5.0), shown(4, 6.0), 12.0) == 5.0
    assert BecameTrue().moment(shown(4, 13.0), shown(4, 6.0), 12.0) == 12.0


@pytest.mark.parametrize("is_returning", [False, True])
def test_what_cannot_happen_is_junk_unless_the_observer_has_yet_to_hear_what_happened(is_returning: bool) -> None:
    on = stage("thesis/scenario_1")
    mission = Mission(on.model, on.cover, lambda level, text: None)
    mission.on_word("_start_", 0.0)
    draw = random.Random(1)
    drawn = {junk_word(draw, mission, ["bot1:bot1_ina@0"], 0.0, is_returning) for _ in range(2000)} - {None}
    meaningless = {*JUNK, "bot1:bot1_ina@0"} - {"_plan_@1"}  # it has the number of this state
    assert meaningless <= drawn
    assert (drawn == meaningless) is is_returning
