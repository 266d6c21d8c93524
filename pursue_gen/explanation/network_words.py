"""The network in the words of its scenario: where an agent is, what it does, how long ago an event was."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterator, Mapping, Optional, Tuple

from pursue_gen.diagnostics import listed, units
from pursue_gen.language import network_names as names
from pursue_gen.language.numbers import decimal_text
from pursue_gen.language.objectives.base import STATUSES
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.language.symbols import Role, Symbol, role_of
from pursue_gen.synthesis.plan_text import constraint_texts
from pursue_gen.synthesis.strategy import Constraint, Zone
from pursue_gen.tga.counts import counted
from pursue_gen.tga.network import Edge, Network
from pursue_gen.tga.objectives import clock_of, stated
from pursue_gen.tga.own_turns import own_turns
from pursue_gen.tga.status_words import own_words, turn_words

_PLACES = {Role.WAY: "on the way from {} to {}", Role.WORK: "doing {} at {}"}
_MOVES = {
    Role.SETTING_OFF: "sets off from {1} to {2}",
    Role.ARRIVAL: "arrives at {2} from {1}",
    Role.WAY: "arrives at {1} from {0}",
    Role.EVENT: "does {}",
    Role.WORK: "begins {}",
    Role.END: "has finished {}",
}
"""What an agent does, by the role of its channel; of the location that it leaves or enters where that says more."""


@dataclass(frozen=True)
class Words:
    """What to call things. `clocks`: clock → the moment since which it counts; `turns`: (rule, location) → its words.
    """

    scenario: Scenario
    clocks: Dict[str, str]
    turns: Dict[Tuple[str, str], str]
    objectives: Mapping[str, StatedObjective]

    def place(self, automaton: str, location: str) -> str:
        """Where it is, as in "at c", "on the way from c to b", "doing catch at b", "next: load or wait"."""
        objective = self.objectives.get(automaton)
        if objective is not None:
            done = [ref.shown for ref in objective.done_in(location)]
            return f"{listed(done)} done" if done else STATUSES.get(role_of(location), location)
        return self.turns.get((automaton, location)) or place_words(self.scenario, location)

    def move(self, automaton: str, edge: Edge) -> str:
        """What it does by that edge, as in "sets off from c to b"."""
        said = self.deed(automaton, edge, _MOVES) or (edge.sync and edge.sync.channel)
        if said:
            return said
        objective = self.objectives.get(automaton)
        if objective is not None and edge.target == names.LATE:
            return f"the deadline of {objective.words.due} has passed"
        if objective is not None and objective.once:
            return "begins to count"
        if objective is not None and edge.target == names.LOSE:
            return "the objective is broken" if len(self.objectives) == 1 else f"broken: {objective.text}"
        return f"goes from {edge.source} to {edge.target}"

    def deed(self, automaton: str, edge: Edge, words: Mapping[Role, str]) -> str:
        """What an agent does by that edge, in these words for roles; "" where they have none, or it is no agent."""
        if all(agent.name != automaton for agent in self.scenario.agents):
            return ""
        name = edge.sync.channel if edge.sync else edge.source
        symbol = Symbol.of(name)
        role = Role.WORK if symbol.role is Role.EVENT and edge.enters is Role.WORK else symbol.role
        return words.get(role, "").format(*map(self.scenario.shown, symbol.parts))

    def when(self, zone: Zone) -> str:
        """The zone in words; "at any time" for the one without constraints."""
        return ", and ".join(self._phrases(zone)) or "at any time"

    def _phrases(self, zone: Zone) -> Iterator[str]:
        """Bounds of each clock, then differences of clocks."""
        for clock, since in self.clocks.items():
            lower = next((c for c in zone if c.right == clock and c.left is None), None)
            upper = next((c for c in zone if c.left == clock and c.right is None), None)
            if lower or upper:
                yield f"{_span(lower, upper)} after {since}"
        done = set()
        for c in zone:
            if c.left is None or c.right is None or (c.right, c.left) in done:
                continue
            done.add((c.left, c.right))
            back = next((o for o in zone if (o.left, o.right) == (c.right, c.left)), None)
            yield self._between(c, back)

    def _between(self, c: Constraint, back: Optional[Constraint]) -> str:
        """`left - right` within a bound: how much earlier the left clock's moment was."""
        assert c.left is not None and c.right is not None
        left, right = self.clocks.get(c.left, c.left), self.clocks.get(c.right, c.right)
        if back is not None and back.bound == -c.bound:
            if c.bound == 0:
                return f"{left} and {right} were at the same moment"
            early, late = (left, right) if c.bound > 0 else (right, left)
            return f"{early} was exactly {units(decimal_text(abs(c.bound)))} before {late}"
        phrase = self._bounded(c, left, right)
        return phrase if back is None else f"{phrase}, and {self._bounded(back, right, left)}"

    @staticmethod
    def _bounded(c: Constraint, left: str, right: str) -> str:
        if c.bound == 0:
            return f"{left} was {'later than' if c.strict else 'no earlier than'} {right}"
        amount = units(decimal_text(abs(c.bound)))
        if c.bound > 0:
            return f"{left} was {'less than' if c.strict else 'at most'} {amount} before {right}"
        return f"{right} was {'more than' if c.strict else 'at least'} {amount} before {left}"


def words_of(scenario: Scenario, network: Network) -> Words:
    """The words for a scenario and its network."""
    clocks: Dict[str, str] = {names.agent_clock(each.name): f"{each.shown}'s last step" for each in scenario.agents}
    objectives = stated(scenario)
    clocks.update((clock_of(name), each.words.since) for name, each in objectives.items())
    for number, assumption in enumerate(scenario.assumptions, start=1):
        clocks[names.assumption_clock(number)] = assumption.since
    clocks = {clock: clocks.get(clock, "the start") for clock in network.clocks}
    turns = {}
    for own in own_turns(scenario):
        for location in own.order.locations:
            turns[own.name, location.name] = turn_words(scenario, own.order, location.name)
    for rule in (rule for rule in scenario.rules if not rule.each):
        automaton = network.automaton(rule.name)
        for location in automaton.locations:
            turns[rule.name, location.name] = turn_words(scenario, automaton, location.name)
    for event, most in counted(scenario):
        automaton = network.automaton(names.count(event.name))
        for number, location in enumerate(automaton.locations):
            turns[automaton.name, location.name] = f"{number} of {most} {scenario.shown(event.name)}"
    turns.update(((own, place), text) for own, texts in own_words(network).items() for place, text in texts.items())
    return Words(scenario, clocks, turns, objectives)


def zone_texts(zone: Zone) -> str:
    """The zone exactly, as plans and strategy files have it."""
    return " && ".join(constraint_texts(zone, space=" ")) or "always"


def place_words(scenario: Scenario, location: str) -> str:
    """Where an agent is, as in "at c", "on the way from c to b", "doing catch at b"."""
    symbol = Symbol.of(location)
    words = _PLACES.get(symbol.role)
    return words.format(*map(scenario.shown, symbol.parts)) if words else f"at {scenario.shown(location)}"


def _span(lower: Optional[Constraint], upper: Optional[Constraint]) -> str:
    """`more than 1 and at most 5 units`."""
    parts, amount = [], ""
    if lower is not None and upper is not None and lower.bound == -upper.bound:
        return f"exactly {units(decimal_text(upper.bound))}" if upper.bound else "right"
    if lower is not None and upper is None and lower.bound == 0:
        return "some time"
    if lower is not None:
        amount = decimal_text(-lower.bound)
        parts.append(f"{'more than' if lower.strict else 'at least'} {amount}")
    if upper is not None:
        amount = decimal_text(upper.bound)
        if upper.bound == 0:
            return "right"
        parts.append(f"{'less than' if upper.strict else 'at most'} {amount}")
    return f"{' and '.join(parts)} {'unit' if amount == '1' else 'units'}"
