"""The stories that are measured: ordinary tasks, which the solver decides in the default game."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from benchmarks.synthesis import STORIES, scenario_cases
from pursue_gen.language import load
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import ends_reported, scenario_objective, translate

pytestmark = pytest.mark.benchmark

FILES = sorted(STORIES.glob("*.pur"))


def test_there_are_a_hotel_an_airport_and_a_museum() -> None:
    assert [file.stem for file in FILES] == ["airport", "hotel", "museum"]
    measured = [case.name for case in scenario_cases() if case.group == "story"]
    assert measured == [f"{file.stem} story" for file in FILES for _ in ("ideal", "default")]


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.stem))
def test_a_story_has_five_places_four_agents_and_two_rules(file: Path) -> None:
    scenario = load(file)
    assert (len(scenario.pois), len(scenario.agents), len(scenario.rules)) == (5, 4, 2)
    assert any(not agent.controllable for agent in scenario.agents)


@pytest.mark.parametrize("name", ["hotel", "airport"])
def test_a_story_is_won_in_the_default_game(name: str) -> None:
    (file,) = (file for file in FILES if file.stem == name)
    network = ends_reported(translate(load(file)), {})
    found = solve(network, scenario_objective(load(file)), Fraction(1, 10))
    assert found.won and found.strategy is not None
    assert 0 < len(found.strategy.blocks) < found.stats.discrete_states, "what no play comes to is left out"
