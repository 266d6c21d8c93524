"""Simulated people keep to what is assumed of them, also those who stand still."""

from __future__ import annotations

import pytest

from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, case_of
from pursue_gen.workspace import Options
from tests.assumptions import AWAY, GOODBYE, LEAVES, MUSEUM, PLAYROOM, SPACED, TWICE, scenario, solved

STORIES = {
    "leaves": MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"),
    "twice": PLAYROOM.format(TWICE),
    "spaced": PLAYROOM.format(SPACED),
}


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
@pytest.mark.parametrize("name", sorted(STORIES))
def test_everybody_keeps_to_what_is_assumed(name: str, kind: str) -> None:
    text = STORIES[name]
    case, _ = case_of(scenario(text), solved(text), Options(), Settings(kind))
    runner = MissionRunner(case)
    outcomes = [runner.run(seed) for seed in range(40)]
    assert {outcome.end for outcome in outcomes} == {GOAL}, [o.reason for o in outcomes if o.end != GOAL][:3]
