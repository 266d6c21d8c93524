"""How late the promises of a scenario are kept at worst: its calls answered, its places visited again."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Dict, List, Union

from pursue_gen.language.numbers import Number, decimal_text, tenths_above
from pursue_gen.language.scenario import Patrol, Respond, Scenario
from pursue_gen.language.wording import objective_text
from pursue_gen.proof.worst_case import answer_times
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.tga.objectives import stated

STATES = 2_000
"""Symbolic states of the checker that the time of a promise may take: the same on every machine."""


def told(worst: Fraction, promise: Union[Respond, Patrol]) -> Number:
    """The worst time of a promise in tenths that hold, and no later than its deadline."""
    return min(tenths_above(worst), _deadline(promise))


def _deadline(promise: Union[Respond, Patrol]) -> Number:
    return promise.deadline if isinstance(promise, Respond) else promise.period


@dataclass(frozen=True)
class Answer:
    """How late a promise is kept at worst, in time units."""

    promise: Union[Respond, Patrol]
    worst: Fraction

    def in_words(self) -> str:
        """A line for people, in tenths that hold."""
        kept = "answered" if isinstance(self.promise, Respond) else "visited again"
        worst, deadline = decimal_text(told(self.worst, self.promise)), decimal_text(_deadline(self.promise))
        return f"{objective_text(self.promise)}: {kept} within {worst} of {deadline}, at worst."

    def as_json(self) -> Dict[str, Any]:
        """For programs: numbers of time units."""
        worst, deadline = float(self.worst), float(_deadline(self.promise))
        return {"objective": objective_text(self.promise), "worst": worst, "deadline": deadline}


def answers(scenario: Scenario, won: Solution, limits: Limits = NO_LIMITS) -> List[Answer]:
    """Those of the promises with a deadline whose time a fixed amount of work tells, in the order of the scenario."""
    took = answer_times(won.network, won.objective, won.strategy, won.reaction, STATES, limits)
    return [
        Answer(promise, took[name])
        for name, promise in stated(scenario).items()
        if name in took and isinstance(promise, (Respond, Patrol))
    ]
