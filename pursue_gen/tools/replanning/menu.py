"""Which orders of people could be promised at the start of a mission: for who writes the scenario."""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, Iterator, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import DISTRIBUTED
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.replanning.replan import answer_to
from pursue_gen.tools.replanning.request import Request
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.model import Model
from pursue_runtime.observer.ordering import PersonOrder, effect
from pursue_runtime.sentences import in_words

_AT = 2.0
"""Time units after the start at which an order comes, nothing else having happened: everybody has rested. Not
measured."""

_STATES = 12_000
"""The states that a search may take, the same on every machine; simulated missions have as many. Not measured."""


def at_start(scenario: Scenario, won: Solution) -> Iterator[Tuple[str, str]]:
    """Each order with why it would be refused at the start, alone; "": it would be accepted."""
    model = Model(model_data(won.network, won.objective, scenario, won.reaction))
    for event in scenario.orders:
        here = model.initial().aged(_AT)
        done = effect(model, here, PersonOrder(event.name, None, 0.0, event.name))
        there = done.after(here, 0.0)
        request = Request(
            scenario=scenario,
            rules=won.rules,
            controllers=DISTRIBUTED,
            reach_obj="dedicated",
            locations=there.locations,
            values=there.values,
            clocks=_exact(there.clocks),
            ahead=Fraction(0),
            excused=frozenset(),
            blocked=frozenset(),
            turning=frozenset(),
            awaited={},
            seconds=0.0,
            window=Fraction(1),
            sooner=_exact(done.clocks),
            shares=tuple(won.strategy.shared_out()),
        )
        answer = answer_to(request, _STATES)
        yield event.name, "" if answer["won"] else in_words(str(answer["why"]))


def _exact(clocks: Dict[str, float]) -> Dict[str, Fraction]:
    return {name: Fraction(value) for name, value in clocks.items()}
