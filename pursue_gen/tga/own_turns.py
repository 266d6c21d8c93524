"""Rules for each robot: every agent that they bind has a turn of its own.

A channel does not say who sends on it, so such a rule is no automaton that listens: the agent's own edges test and set
the number of its turn, an edge for each turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Iterator, List, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Rule, Scenario
from pursue_gen.tga.network import Automaton, Edge, Test
from pursue_gen.tga.rules import rule_of


@dataclass(frozen=True)
class OwnTurn:
    """An agent's turn in a rule. `variable` holds the number of a location of `order`, which is no automaton of the
    network: it says what leads from one number to the next. `shown`: what people read for the agent.
    """

    rule: Rule
    agent: str
    shown: str
    variable: str
    order: Automaton

    @property
    def name(self) -> str:
        """What people call it."""
        return f"{self.rule.name} of {self.shown}"


def own_turns(scenario: Scenario) -> Iterator[OwnTurn]:
    """The turns of all agents in rules for each of them, in the order of the rules."""
    for rule in scenario.rules:
        for agent in scenario.bound_by(rule):
            order, _ = rule_of(rule, scenario.events)
            yield OwnTurn(rule, agent.name, agent.shown, names.own_turn(rule.name, agent.name), order)


def bound(automaton: Automaton, turns: Sequence[OwnTurn]) -> Automaton:
    """The automaton of an agent that keeps to its turns; those of other agents change nothing."""
    for turn in (turn for turn in turns if turn.agent == automaton.name):
        automaton = automaton.with_each(partial(_in_turn, turn))
    return automaton


def _in_turn(turn: OwnTurn, edge: Edge) -> List[Edge]:
    """The edge, once for each number at which it is its turn; alone where the rule does not name what it does."""
    steps = [] if edge.sent is None else _steps(turn, edge.sent)
    return [edge.plus((Test(turn.variable, now),), assign=((turn.variable, then),)) for now, then in steps] or [edge]


def _steps(turn: OwnTurn, channel: str) -> List[Tuple[int, int]]:
    """From which number to which one the channel leads."""
    numbers = {location.name: number for number, location in enumerate(turn.order.locations)}
    steps = (edge for edge in turn.order.edges if edge.channel == channel)
    return [(numbers[step.source], numbers[step.target]) for step in steps]
