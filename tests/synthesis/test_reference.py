"""What only the reference engine has: one move first, and few states where that wins."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from pursue_gen.language import load
from pursue_gen.proof.checker import verify
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.solve import to_strategy
from pursue_gen.tga import ends_reported, scenario_objective, translate
from tests.conftest import thesis_scenario
from tests.oracle.engine import ReferenceEngine, followed
from tests.synthesis.test_engines import DEFAULT, published


@pytest.mark.parametrize("number", ["1", "2", "3", "4"])
@pytest.mark.parametrize("default", [False, True])
def test_the_thesis_scenarios_are_won_and_few_states_are_looked_at(number: str, default: bool) -> None:
    scenario = load(str(thesis_scenario(number)))
    network = translate(scenario)
    game = compile_game(
        ends_reported(network, {}) if default else network,
        scenario_objective(scenario),
        DEFAULT if default else Fraction(0),
    )
    outcome = ReferenceEngine().solve(game)
    assert outcome.won
    # Scenario 4 has 69,741 discrete states in the default game.
    assert outcome.stats.discrete_states < 150
    strategy = to_strategy(game, [outcome.blocks[k] for k in followed(game, outcome.blocks)])
    played = ends_reported(network, {}) if default else network
    report = verify(played, scenario_objective(scenario), strategy, DEFAULT if default else Fraction(0))
    assert report.ok, report.reason


def test_exhaustive_and_directed_agree_on_a_published_scenario(reference_dir: Path) -> None:
    game = compile_game(*published(reference_dir, "CT1", False))
    everything = ReferenceEngine(directed=False).solve(game)
    assert everything.won
    assert everything.stats.discrete_states == 300, "as many discrete states as other solvers count"
    assert ReferenceEngine().solve(game).stats.discrete_states < everything.stats.discrete_states
