"""What tests need of the text of a small scenario: strategy, workspace, stage, model; each made once for each text."""

from __future__ import annotations

import functools
from typing import Dict, List

import yaml

from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import Outcome, Settings
from pursue_gen.tools.simulation.runs import case_of
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options, generate
from pursue_gen.workspace.model_file import render
from pursue_runtime.model import Model

CARE_HOME = """poi "station"
poi "corridor"
poi "room1"
poi "room3"
connect station and corridor distance 5
connect corridor and room1 distance 4
connect corridor and room3 distance 12
event "ring1"
event "ring3"
"""
"""The floor of a home, with the bells of two rooms."""


def scenario(text: str) -> Scenario:
    """The scenario of a text."""
    return parse(text, "story.pur", "story")


@functools.lru_cache(maxsize=None)
def solved(text: str) -> Solution:
    """Its strategy in the default game. Raises PursueError where it is lost."""
    return solve_scenario(scenario(text), Rules())


@functools.lru_cache(maxsize=None)
def files(text: str) -> Dict[str, bytes]:
    """Its workspace."""
    won = solved(text)
    return generate(scenario(text), won.network, won.objective, won.strategy, Options(reaction=won.reaction))


@functools.lru_cache(maxsize=None)
def _stage(text: str) -> Stage:
    return stage_of(scenario(text), solved(text), Options())


def missions(text: str, number: int, settings: Settings) -> List[Outcome]:
    """The outcomes of so many simulated missions, all on one stage."""
    case, _ = case_of(scenario(text), solved(text), Options(), settings)
    return [simulate_mission(_stage(text), case.settings, seed, case.worst_times()) for seed in range(number)]


@functools.lru_cache(maxsize=None)
def model(text: str) -> Model:
    """Its model, as the nodes have it."""
    return Model(yaml.safe_load(files(text)["src/observer/config/model.yaml"]))


@functools.lru_cache(maxsize=None)
def free_model(text: str) -> Model:
    """Its model with ends that are reported, whether or not it can be won."""
    story = scenario(text)
    rules = Rules()
    made = render(played(translate(story), rules), scenario_objective(story), story, rules.reaction, "test")
    return Model(yaml.safe_load(made))
