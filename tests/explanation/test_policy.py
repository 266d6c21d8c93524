"""What the controller does in a counter-play: it follows a strategy as far as that knows what to do."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Set

import pytest

from benchmarks.families import deliver_by_robots
from pursue_gen.explanation.policy import Controller
from pursue_gen.explanation.position import Position
from pursue_gen.language import parse
from pursue_gen.solving.decomposition import won_by_some
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import initial_state, joint_moves
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective

SCENARIO = parse(deliver_by_robots(3), "crowd.pur", "crowd")
NETWORK, OBJECTIVE = played(translate(SCENARIO), Rules()), scenario_objective(SCENARIO)


@pytest.fixture(scope="module", name="strategy")
def in_stages() -> Strategy:
    """Three robots work at the same time: three blocks hold at the start."""
    found = won_by_some(NETWORK, OBJECTIVE, Fraction(1, 10), SolveOptions())
    assert found is not None and len(found.strategy.stages[0]) == 3
    return found.strategy


def begins(strategy: Strategy, network: Network, objective: Objective) -> str:
    """Who is the first to get a command."""
    game = compile_game(network, objective)
    start = Position(initial_state(game), (Fraction(0),) * len(game.clocks))
    mine = [move for move in joint_moves(game, start.state) if move.controllable]
    choice = Controller(game, [strategy]).decide(start, mine)
    return "" if choice is None else game.automata[game.edges[choice[0].edges[0]].automaton].name


@pytest.mark.parametrize("waiting", [set(), {"bot1"}, {"bot1", "bot2"}, {"bot2", "bot3"}, {"bot1", "bot2", "bot3"}])
def test_each_part_that_is_played_at_the_same_time_counts(strategy: Strategy, waiting: Set[str]) -> None:
    blocks = [
        replace(block, wait=((),), commands=())
        if any(command.moves[0].automaton in waiting for command in block.commands)
        else block
        for block in strategy.blocks
    ]
    first = begins(replace(strategy, blocks=tuple(blocks)), NETWORK, OBJECTIVE)
    assert first == next((name for name in ("bot1", "bot2", "bot3") if name not in waiting), "")
