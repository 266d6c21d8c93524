"""Which game a scenario is for a person: against its strategy, or against a counter-strategy."""

from __future__ import annotations

from typing import Optional

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import Scenario
from pursue_gen.play.advice import Advisor
from pursue_gen.play.counter import robots_game
from pursue_gen.play.session import GameOf, Session
from pursue_gen.play.table import Board, beginning, board_of
from pursue_gen.play.words import words_of
from pursue_gen.play.world import World
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import is_lost, solve_scenario
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener


def session_of(
    scenario: Scenario,
    rules: Rules,
    seed: int = 1,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
) -> Session:
    """A new game of a scenario. Raises PursueError with exit status 5 where a limit is hit before it is decided."""
    board = board_of(scenario, rules)
    return Session(game_of(board, seed, limits, progress), words_of(scenario, board.network), beginning(board))


def game_of(board: Board, seed: int, limits: Limits, progress: Optional[Listener] = None) -> GameOf:
    """The person plays the others where the objective can be met, else the robots."""
    try:
        won = solve_scenario(board.scenario, board.rules, SolveOptions(limits, progress=progress))
    except PursueError as problem:
        if not is_lost(problem):
            raise
        return robots_game(board, limits.memory, progress)
    return World(board, Advisor(board, won.strategy), seed)
