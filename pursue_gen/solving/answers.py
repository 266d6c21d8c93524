"""How late the promises of a scenario are kept at worst: its calls answered, its places visited again."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Dict, List

from pursue_gen.language import network_names as names
from pursue_gen.language.numbers import Number, tenths_above
from pursue_gen.language.scenario import Safety, Scenario, StatedObjective
from pursue_gen.language.times import like, written_time
from pursue_gen.proof.worst_case import answer_times
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import NO_LIMITS, Limits

STATES = 2_000
"""Symbolic states of the checker that the time of a promise may take: the same on every machine. Not measured."""


def told(worst: Fraction, promise: StatedObjective) -> Number:
    """The worst-case time of a promise, rounded up to tenths, but never above its limit."""
    return min(tenths_above(worst), promise.known_limit)


@dataclass(frozen=True)
class Answer:
    """How late a promise is kept at worst, in time units."""

    promise: Safety
    worst: Fraction

    def in_words(self) -> str:
        """A line for people, in tenths that hold."""
        limit = self.promise.known_limit
        worst, deadline = written_time(like(told(self.worst, self.promise), limit)), written_time(limit)
        return f"{self.promise.text}: {self.promise.words.kept} within {worst} of {deadline}, at worst."

    def as_json(self) -> Dict[str, Any]:
        """For programs: numbers of time units."""
        worst, deadline = float(self.worst), float(self.promise.known_limit)
        return {"objective": self.promise.text, "worst": worst, "deadline": deadline}


def answers(scenario: Scenario, won: Solution, limits: Limits = NO_LIMITS, states: int = STATES) -> List[Answer]:
    """The worst-case times of promises with a deadline, in order, as far as a fixed amount of work finds them; of those
    that are told together the latest, where all are known."""
    took = answer_times(won.network, won.objective, won.strategy, won.reaction, states, limits)
    stated = scenario.safety
    whole = [(names.safety_objective(k), each, each.told_with(stated)) for k, each in enumerate(stated)]
    worst = {id(each): took[name] for name, each, _ in whole if name in took and each.limit is not None}
    firsts = ((each, {id(one) for one in told}) for _, each, told in whole if told[0] is each)
    return [Answer(each, max(worst[one] for one in told)) for each, told in firsts if worst.keys() >= told]
