"""Which game a scenario is for a person: against its strategy, or against a counter-strategy."""

from __future__ import annotations

from typing import Optional

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import Scenario
from pursue_gen.play.advice import Advisor
from pursue_gen.play.counter import counter_game
from pursue_gen.play.session import GameOf, Session
from pursue_gen.play.state import Setup, beginning, setup_of
from pursue_gen.play.texts import event_texts
from pursue_gen.play.world import StrategyPlay
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
    setup = setup_of(scenario, rules)
    return Session(game_of(setup, seed, limits, progress), event_texts(scenario, setup.network), beginning(setup))


def game_of(setup: Setup, seed: int, limits: Limits, progress: Optional[Listener] = None) -> GameOf:
    """The person plays the others where the objective can be met, else the robots."""
    try:
        won = solve_scenario(setup.scenario, setup.rules, SolveOptions(limits, progress=progress))
    except PursueError as problem:
        if not is_lost(problem):
            raise
        return counter_game(setup, limits.memory, progress)
    return StrategyPlay(setup, Advisor(setup, won.strategy), seed)
