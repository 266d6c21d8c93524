"""What controllers have for a state is what the strategy has there, whatever their files leave out."""

from __future__ import annotations

from typing import Set, Tuple

import pytest

from pursue_gen.language import load
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.state import SystemState
from tests.tools.simulation.stages import SCENARIOS

Known = Set[Tuple[str, str]]
"""Agents, and what they are to do."""


@pytest.mark.parametrize(
    "name",
    [
        "patterns/sequenced_patrolling",
        "patterns/ordered_patrolling",
        "patterns/strict_ordered_patrolling",
        "patterns/strict_ordered_visit",
        "museum/rounds",
        "industry/coffee",
        "thesis/scenario_1",
        "thesis/catch_the_thief",
    ],
)
def test_controllers_hold_the_commands_of_the_strategy(name: str) -> None:
    scenario = settled(load(SCENARIOS / f"{name}.pur"), SolveRequest())
    won = solve_scenario(scenario, Rules())
    stage = stage_of(scenario, won, Options(reaction=won.reaction))
    for block in won.strategy.blocks:
        state = SystemState(1, 0.0, dict(block.state.locations), dict(block.state.values), {})
        nodes = [*stage.strategies.values(), *([stage.people] if stage.people else [])]
        tables = [node.commands(state) for node in nodes]
        held: Known = {(command.agent, command.event) for table in tables for command in table}
        covered: Known = {key for entry in stage.cover.find(state) for key in entry.commands}
        meant = {(command.agent, command.event) for command in stage.game.orders.commands.find(block.state.facts)}
        assert held == covered == meant, state
