"""Scenarios solved once for all the tests that need a strategy."""

from __future__ import annotations

import functools
from fractions import Fraction
from pathlib import Path
from typing import Dict, Tuple

from pursue_gen.language import load
from pursue_gen.language.scenario import Scenario
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_gen.workspace import Options, generate

SCENARIOS = Path(__file__).resolve().parent.parent.parent / "scenarios"
REACTION = Fraction(1, 10)
World = Tuple[Scenario, Network, Objective, Strategy]


@functools.lru_cache(maxsize=None)
def world(name: str, ideal: bool = False) -> World:
    """The scenario `scenarios/<name>.pur` in the default game (or the ideal one), and a strategy that wins it."""
    scenario = load(str(SCENARIOS / f"{name}.pur"))
    objective = scenario_objective(scenario)
    network = translate(scenario) if ideal else ends_reported(translate(scenario), {})
    verdict = solve(network, objective, Fraction(0) if ideal else REACTION)
    assert verdict.strategy is not None, f"{name} is lost"
    return scenario, network, objective, verdict.strategy


def made(name: str, controllers: str = "distributed", reach_obj: str = "dedicated") -> Dict[str, bytes]:
    """The workspace of the scenario, in memory; a general controller plays the ideal game, as the original's does."""
    ideal = controllers == "general"
    reaction = Fraction(0) if ideal else REACTION
    options = Options(controllers, reach_obj, reaction, "controllable" if ideal else "reported")
    return generate(*world(name, ideal), options)


files = functools.lru_cache(maxsize=None)(made)
"""The same, made once for all the tests that read it."""
