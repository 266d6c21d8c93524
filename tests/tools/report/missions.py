"""Recorded missions for tests: simulated ones, and one that is made up."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Dict, List, Tuple

from pursue_gen.language import load
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tga import translate
from pursue_gen.tools.report.recording import Recording, Step, simulated
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import case_of
from pursue_gen.workspace import Options

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"


@functools.lru_cache(maxsize=None)
def mission(name: str, opponent: str = "random", seed: int = 3, until: float = 150.0) -> Recording:
    """A simulated mission of a scenario."""
    scenario = load(SCENARIOS / f"{name}.pur")
    won = solve_scenario(scenario, Rules())
    case, _ = case_of(scenario, won, Options(reaction=won.reaction), Settings(opponent, (), until))
    return simulated(case, seed)


def made_up(*changes: Tuple[float, str, str, Dict[str, str], str], end: float = 20.0) -> Recording:
    """A mission of scenario 1: time, agent, event, new locations from then on, status."""
    scenario = load(SCENARIOS / "thesis" / "scenario_1.pur")
    network = played(translate(scenario), Rules())
    places = {automaton.name: automaton.initial for automaton in network.automata}
    values = dict(network.variables)
    steps: List[Step] = [Step(0.0, dict(places), values)]
    for at, agent, event, moved, status in changes:
        places = {**places, **moved}
        steps.append(Step(at, dict(places), values, agent, event, status))
    return Recording(scenario, network, tuple(steps), end, "made up")
