"""Stages for tests: solved scenarios with their workspaces in memory, as they are or sabotaged."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path
from typing import Dict, Optional, Tuple

from pursue_gen.language import load
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.margin import USUAL, strategy_margin
from pursue_gen.solving.solution import Rules, Solution, solve_scenario
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import Outcome, Settings
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import Stage, stage_from
from pursue_gen.workspace import Options, generate

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
THESIS = ("scenario_1", "scenario_2", "scenario_3", "scenario_4", "catch_the_thief")
THIEF = "thesis/catch_the_thief"


@functools.lru_cache(maxsize=None)
def solved(name: str) -> Tuple[Scenario, Solution]:
    """The scenario (a path below scenarios/, without .pur) and its strategy in the default game."""
    scenario = load(SCENARIOS / f"{name}.pur")
    return scenario, solve_scenario(scenario, Rules())


@functools.lru_cache(maxsize=None)
def remaining(name: str) -> Remaining:
    """How long its strategy may need."""
    return Remaining(solved(name)[1])


@functools.lru_cache(maxsize=None)
def margin(name: str) -> float:
    """The margin of its strategy, in time units."""
    won = solved(name)[1]
    return float(strategy_margin(won.network, won.objective, won.strategy, won.reaction, USUAL).wins)


def files(name: str) -> Dict[str, bytes]:
    """Its workspace."""
    scenario, won = solved(name)
    options = Options(reaction=won.reaction)
    return generate(scenario, won.network, won.objective, won.strategy, options)


@functools.lru_cache(maxsize=None)
def stage(name: str) -> Stage:
    """Its stage."""
    return stage_from(files(name), *solved(name))


def sabotaged(name: str, path: str, old: str, new: str) -> Stage:
    """Its stage, with something else in one data file of the workspace."""
    found = files(name)
    text = found[path].decode()
    assert old in text, f"{path} does not hold {old!r}"
    return stage_from({**found, path: text.replace(old, new).encode()}, *solved(name))


def missions(name: str, number: int, settings: Settings, on: Optional[Stage] = None) -> Tuple[Outcome, ...]:
    """The first so many missions; those on the scenario's own stage are played once in a session."""
    return _first(name, number, settings) if on is None else _played(name, number, settings, on)


@functools.lru_cache(maxsize=None)
def _first(name: str, number: int, settings: Settings) -> Tuple[Outcome, ...]:
    return _played(name, number, settings, stage(name))


def _played(name: str, number: int, settings: Settings, on: Stage) -> Tuple[Outcome, ...]:
    times = remaining(name)
    bound = times.bound()
    settings = replace(settings, bound=bound, span=0.6 * bound if bound else settings.span, margin=margin(name))
    return tuple(simulate_mission(on, settings, seed, times) for seed in range(1, number + 1))
