"""Which game a scenario is for a person: against its strategy, or against a counter-strategy."""

from __future__ import annotations

from typing import Optional

from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Lost
from pursue_gen.solving.optional import promised
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.tools.play.advice import Advisor
from pursue_gen.tools.play.counter import counter_game
from pursue_gen.tools.play.session import GameOf, Session
from pursue_gen.tools.play.state import setup_of
from pursue_gen.tools.play.world import StrategyPlay
from pursue_gen.vocabulary.words import words_of


def session_of(
    scenario: Scenario,
    rules: Rules,
    seed: int = 1,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
) -> Session:
    """A new game of a scenario: the person plays the others where its objectives can be met, else the robots.

    Raises LimitHit where a limit is hit before it is decided.
    """
    try:
        options = SolveOptions(limits, progress=progress)
        found = promised(scenario, options, lambda some, how: solve_scenario(some, rules, how))
    except Lost:
        setup = setup_of(scenario.giving_up(scenario.optional), rules)
        game: GameOf = counter_game(setup, limits.memory, progress)
    else:
        setup = setup_of(found.scenario, rules, found.solution.strategy)
        game = StrategyPlay(setup, Advisor(setup, found.solution.strategy), seed)
    return Session(game, words_of(setup.scenario, setup.network), setup.beginning())
