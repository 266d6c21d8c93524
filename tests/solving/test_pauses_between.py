"""Pauses between events: what is won and lost because of them, what would help, and missions that keep them."""

from __future__ import annotations

from pathlib import Path

import pytest

from pursue_gen.explanation.explain import explain
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings
from tests.stories import missions, scenario, solved

GLUE = (Path(__file__).resolve().parents[2] / "scenarios" / "work_cell" / "glue.pur").read_text()
PAUSE = "at_least 20 between glue and pack"

INSPECTION = """\
poi "hall"
poi "gate"
connect hall and gate distance 2
event "look" location gate duration 2
event "photo" location gate
event "ring" location gate
agent "bot1" controllable mobile 1 location gate can_do look
agent "bot2" controllable mobile 1 location hall can_do look, photo
agent "guest" location gate can_do ring
objective: at_least 10 between {}
reach_objective: do photo after 8 within {}
reach_objective: do look
"""
"""Two robots who look; one of them takes a photo."""


def test_a_story_is_won_and_proven_and_lost_with_a_longer_pause() -> None:
    won = solved(GLUE)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    for changed in (GLUE.replace("at_least 20", "at_least 30"), GLUE.replace("within 60", "within 40")):
        with pytest.raises(Lost):
            solved(changed)
    assert solved(GLUE.replace("within 60", "within 40").replace(f"objective: {PAUSE}", ""))


def test_what_cannot_be_promised_alone_is_not_blamed_for_a_pause() -> None:
    with pytest.raises(Lost) as lost:
        solved(GLUE.replace("within 60", "within 50"))
    assert "cannot be promised, even if nothing else is" not in str(lost.value)
    with pytest.raises(Lost) as lost:
        solved(GLUE.replace("within 60", "within 25"))
    assert "cannot be promised, even if nothing else is" in str(lost.value)


def test_a_shorter_pause_is_proposed() -> None:
    changes = explain(scenario(GLUE.replace("within 60", "within 50")), Rules(), Limits(1200.0)).changes
    assert "a pause of 16 instead of 20 between glue and pack" in [each.sentence for each in changes]


def test_it_counts_who_ever_does_them() -> None:
    assert solved(INSPECTION.format("look and photo", 12)), "the photo first, or nobody looks before"
    with pytest.raises(Lost):
        solved(INSPECTION.format("look and photo", 12).replace("objective: do look", "objective: do look within 6"))


def test_others_break_it_unless_they_are_assumed_to_wait() -> None:
    story = INSPECTION.format("ring", 30)
    with pytest.raises(Lost):
        solved(story)
    assert solved(story.replace("objective: at", "assume: guest waits 10 between ring\nobjective: at"))
    assert solved(story.replace("objective: at", "assume: guest does ring at_most 1 times\nobjective: at"))


def test_it_is_given_up_where_it_is_optional() -> None:
    story = GLUE.replace("within 60", "within 40").replace("objective: at", "optional 1 objective: at")
    found = promised_of(scenario(story), SolveRequest())
    assert [one.objective.text for one in found.scenario.given_up] == [PAUSE]


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
@pytest.mark.parametrize("story", ["glue", "inspection"])
def test_simulated_missions_keep_it(story: str, kind: str) -> None:
    text = GLUE if story == "glue" else INSPECTION.format("look and look", 60)
    outcomes = missions(text, 4, Settings(kind, until=200.0))
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE} and not any(each.problems for each in outcomes)
