"""Simulated people keep to what is assumed of them, also those who stand still."""

from __future__ import annotations

import pytest

from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from tests.assumptions import AWAY, GOODBYE, LEAVES, MUSEUM, PLAYROOM, SPACED, TWICE, missions

STORIES = {
    "leaves": MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"),
    "twice": PLAYROOM.format(TWICE),
    "spaced": PLAYROOM.format(SPACED),
}


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
@pytest.mark.parametrize("name", sorted(STORIES))
def test_everybody_keeps_to_what_is_assumed(name: str, kind: str) -> None:
    outcomes = missions(STORIES[name], 40, Settings(kind))
    assert {outcome.end for outcome in outcomes} == {GOAL}, [o.reason for o in outcomes if o.end != GOAL][:3]
