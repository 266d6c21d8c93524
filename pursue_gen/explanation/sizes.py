"""What the statement of an objective costs: the discrete states of its own game, which those of others multiply.

Times are left aside, so a game has no more states than are counted here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Tuple

from pursue_gen.diagnostics import Span
from pursue_gen.explanation.decided import each_statement
from pursue_gen.explanation.part import part_of_scenario, rules_for
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.game import Game, initial_state, is_bad, joint_moves
from pursue_gen.tga import scenario_objective, translate

_STATES, _OF_ALL = 2_000, 16_000
"""So many states are counted of a statement, and of all: a quarter of a second. Measured on lab scenarios."""


@dataclass(frozen=True)
class Size:
    """A statement, and how many discrete states its own game has; `more`: that many, and more."""

    span: Span
    states: int
    more: bool

    def in_words(self) -> str:
        """What stands beside the statement."""
        return f"{'over ' if self.more else ''}{self.states:,} states"


def sizes(scenario: Scenario) -> Tuple[Size, ...]:
    """The sizes of the objectives' statements in the default game, in their order, as far as so many states tell."""
    found: List[Size] = []
    left = _OF_ALL
    for _, statement in each_statement(scenario):
        if left < _STATES:
            break
        part = part_of_scenario(scenario, statement, DEFAULT)
        objective = scenario_objective(part)
        network = cone_of_influence(played(translate(part), rules_for(part, DEFAULT)), objective)
        states = _count(compile_game(network, objective))
        found.append(Size(statement[0].span, states, states == _STATES))
        left -= states
    return tuple(found)


def _count(game: Game) -> int:
    """The discrete states that moves lead to, whatever the clocks are; _STATES where there are that many or more."""
    start = initial_state(game)
    seen, waiting = {start}, [start]
    while waiting:
        state = waiting.pop()
        for move in () if is_bad(game, state) else joint_moves(game, state):
            if move.target not in seen:
                if len(seen) == _STATES:
                    return _STATES
                seen.add(move.target)
                waiting.append(move.target)
    return len(seen)
