"""Which objectives of a lost scenario cannot be promised together: found by solving with fewer of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.part import with_objectives
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.tga import scenario_objective, translate

_SHARE = 0.5
"""The part of what is left of the budget that one game may take. Measured on the third ecobot."""


@dataclass(frozen=True)
class Conflict:
    """Objectives that cannot be promised together. `least`: without any one of them the others of these can."""

    objectives: Tuple[StatedObjective, ...]
    least: bool
    of: int

    def in_words(self) -> str:
        """A sentence or two."""
        texts = [f"'{objective.full_text}'" for objective in self.objectives]
        if len(texts) == 1:
            return f"{texts[0]} cannot be promised, even as the only objective."
        if self.least and len(texts) == self.of == 2:
            return f"Of {listed(texts)} each alone can be promised, both together cannot."
        rest = " Without any one of them the others of these can." if self.least else ""
        return f"{listed(texts)} cannot be promised together.{rest}"


def conflict(scenario: Scenario, rules: Rules, budget: Budget) -> Optional[Conflict]:
    """As few objectives of a lost scenario as still cannot be promised together; None where it has one alone.

    What must always hold is left out first: without anything to reach it would have to hold for ever.
    """
    statements = scenario.statements
    if len(statements) < 2:
        return None
    kept: List[StatedObjective] = list(scenario.objectives)
    least = True
    for statement in statements:
        fewer = [other for other in kept if not any(other is one for one in statement)]
        won = _won(scenario, fewer, rules, budget) if fewer else True
        if won is False:
            kept = fewer
        least = least and won is not None
    # Of a patrol in order the first place stands for all of them: they have one text.
    firsts = tuple(statement[0] for statement in statements if any(statement[0] is one for one in kept))
    return Conflict(firsts, least, len(statements))


def _won(scenario: Scenario, objectives: List[StatedObjective], rules: Rules, budget: Budget) -> Optional[bool]:
    """Whether these alone can be promised; None: not decided within the budget."""
    fewer = with_objectives(scenario, objectives)
    try:
        network = played(translate(fewer), rules)
        return verdict_of(budget, network, scenario_objective(fewer), rules.reaction, _SHARE).won
    except LimitHit:
        return None
