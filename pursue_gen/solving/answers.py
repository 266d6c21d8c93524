"""How late the promises of a scenario are kept at worst: its calls answered, its places visited again."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any, Dict, List, Union

from pursue_gen.language.numbers import Number, at_most, decimal_text
from pursue_gen.language.scenario import Patrol, Respond, Scenario
from pursue_gen.language.wording import objective_text
from pursue_gen.proof.worst_case import answer_times
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.tga.objectives import stated

_STATES = 2_000
"""Symbolic states of the checker that the time of a promise may take: the same on every machine."""


@dataclass(frozen=True)
class Answer:
    """How late a promise is kept at worst, and its deadline, in time units."""

    promise: Union[Respond, Patrol]
    worst: Fraction
    deadline: Number

    def in_words(self) -> str:
        """A line for people, in tenths that hold."""
        kept = "answered" if isinstance(self.promise, Respond) else "visited again"
        worst = at_most(self.worst) if ceil(10 * self.worst) <= 10 * self.deadline else decimal_text(self.deadline)
        return f"{objective_text(self.promise)}: {kept} within {worst} of {decimal_text(self.deadline)}, at worst."

    def as_json(self) -> Dict[str, Any]:
        """For programs: numbers of time units."""
        worst, deadline = float(self.worst), float(self.deadline)
        return {"objective": objective_text(self.promise), "worst": worst, "deadline": deadline}


def answers(scenario: Scenario, won: Solution, limits: Limits = NO_LIMITS) -> List[Answer]:
    """Those of the promises with a deadline whose time a fixed amount of work tells, in the order of the scenario."""
    took = answer_times(won.network, won.objective, won.strategy, won.reaction, _STATES, limits)
    return [
        Answer(promise, took[name], promise.deadline if isinstance(promise, Respond) else promise.period)
        for name, promise in stated(scenario).items()
        if name in took and isinstance(promise, (Respond, Patrol))
    ]
