"""Escorts: a story that is won, one that is lost as the visitor is too quick, and missions that keep the promise."""

from __future__ import annotations

from pathlib import Path

import pytest

from pursue_gen.explanation.explain import explain
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from tests.stories import missions, scenario, solved

ESCORT = (Path(__file__).resolve().parents[2] / "scenarios" / "museum" / "escort.pur").read_text()
QUICK = ESCORT.replace("mobile 2", "mobile 1")


def test_a_story_is_won_and_proven_and_lost_where_she_is_quicker() -> None:
    won = solved(ESCORT)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    with pytest.raises(Lost):
        solved(QUICK)
    assert solved(QUICK.replace("within 3", "within 9"))


def test_a_later_escort_is_proposed_for_all_places_of_the_statement() -> None:
    changes = [each.sentence for each in explain(scenario(QUICK), Rules(), Limits(1200.0)).changes]
    assert any(each.startswith("an escort of visitor within ") and "instead of 3" in each for each in changes), changes


@pytest.mark.parametrize("text", [ESCORT, ESCORT.replace("gallery, vault", "gallery, vault, shop")])
@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_missions_keep_it(text: str, kind: str) -> None:
    outcomes = missions(text, 3, Settings(kind, until=150.0))
    assert {outcome.end for outcome in outcomes} == {SAFE} and not any(each.problems for each in outcomes)
