"""The network in the words of its scenario: where its automata are, what they do, how long ago an event was."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import Dict, Iterator, Mapping, Optional

from pursue_gen.language import network_names as names
from pursue_gen.language.numbers import Number, decimal_text
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.language.times import in_unit
from pursue_gen.synthesis.strategy import Constraint, Zone
from pursue_gen.tga.network import Edge, Network
from pursue_gen.tga.objectives import clock_of, stated
from pursue_gen.vocabulary.agents import deed, place
from pursue_gen.vocabulary.statuses import statuses


@dataclass(frozen=True)
class Words:
    """What to call things. `clocks`: clock → the moment since which it counts; `texts`: what each location of each
    automaton but agents means."""

    scenario: Scenario
    clocks: Mapping[str, str]
    texts: Mapping[str, Mapping[str, str]]
    objectives: Mapping[str, StatedObjective]

    def place(self, automaton: str, location: str) -> str:
        """Where it is, as in "at c", "on its way from c to b", "doing catch at b", "next: load or wait", "unknown"."""
        return self.texts.get(automaton, {}).get(location) or place(self.scenario, location)

    def move(self, automaton: str, edge: Edge) -> str:
        """What it does by that edge, as in "sets off from c to b"."""
        done, objective = deed(self.scenario, automaton, edge), self.objectives.get(automaton)
        if done is not None:
            return done.does
        if edge.sync is not None:
            return edge.sync.channel
        if objective is not None and edge.target == names.LATE:
            return f"the deadline of {objective.words.due} has passed"
        if objective is not None and objective.once:
            return "begins to count"
        if objective is not None and edge.target == names.LOSE:
            return "the objective is broken" if len(self.objectives) == 1 else f"broken: {objective.text}"
        return f"goes from {edge.source} to {edge.target}"

    def sentence(self, automaton: str, edge: Edge) -> str:
        """Who does what by that edge, as in "bot1 sets off from c to b"; what no agent does has no name before it."""
        return self._who(automaton, " ") + self.move(automaton, edge)

    def command(self, automaton: str, edge: Edge) -> str:
        """The command for that edge, as in "bot1: go to b"."""
        done = deed(self.scenario, automaton, edge)
        return self._who(automaton, ": ") + (self.move(automaton, edge) if done is None else done.do)

    def _who(self, automaton: str, behind: str) -> str:
        agents = (each.shown + behind for each in self.scenario.agents if each.name == automaton)
        facts = (each.name + behind for each in self.scenario.states if each.is_found_out and each.name == automaton)
        return next(chain(agents, facts), "")

    def when(self, zone: Zone) -> str:
        """The zone in words; "at any time" for the one without constraints."""
        return ", and ".join(self._phrases(zone)) or "at any time"

    def _phrases(self, zone: Zone) -> Iterator[str]:
        """Bounds of each clock, then differences of clocks."""
        for clock, since in self.clocks.items():
            lower = next((c for c in zone if c.right == clock and c.left is None), None)
            upper = next((c for c in zone if c.left == clock and c.right is None), None)
            if lower or upper:
                yield f"{_span(lower, upper, self.scenario.unit)} after {since}"
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
            return f"{early} was exactly {in_unit(decimal_text(abs(c.bound)), self.scenario.unit)} before {late}"
        phrase = self._bounded(c, left, right)
        return phrase if back is None else f"{phrase}, and {self._bounded(back, right, left)}"

    def _bounded(self, c: Constraint, left: str, right: str) -> str:
        if c.bound == 0:
            return f"{left} was {'later than' if c.strict else 'no earlier than'} {right}"
        amount = in_unit(decimal_text(abs(c.bound)), self.scenario.unit)
        if c.bound > 0:
            return f"{left} was {'less than' if c.strict else 'at most'} {amount} before {right}"
        return f"{right} was {'more than' if c.strict else 'at least'} {amount} before {left}"


def words_of(scenario: Scenario, network: Network) -> Words:
    """The words for a scenario and its network."""
    clocks: Dict[str, str] = {names.agent_clock(each.name): f"{each.shown}'s last step" for each in scenario.agents}
    objectives = stated(scenario)
    clocks.update((clock_of(name), each.words.since) for name, each in objectives.items())
    for number, assumption in enumerate(scenario.assumed, start=1):
        clocks[names.assumption_clock(number)] = assumption.since
    clocks = {clock: clocks.get(clock, "the start") for clock in network.clocks}
    texts = {each.of: each.texts for each in statuses(scenario, network)}
    for state in (each for each in scenario.states if each.is_found_out):
        said = ((names.UNKNOWN, "unknown"), (names.FINDING, "being found out"), (names.KNOWN, "known"))
        texts[names.finding(state.name)] = {str(here): text for here, text in said}
    for watcher in (Symbol.of(automaton.name) for automaton in network.automata):
        if watcher.role is Role.WATCHER:
            texts[watcher] = texts[watcher.parts[0]]
    return Words(scenario, clocks, texts, objectives)


def _span(lower: Optional[Constraint], upper: Optional[Constraint], unit: Optional[Number]) -> str:
    """`more than 1 and at most 5 units`."""
    parts, amount = [], ""
    if lower is not None and upper is not None and lower.bound == -upper.bound:
        return f"exactly {in_unit(decimal_text(upper.bound), unit)}" if upper.bound else "right"
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
    return " and ".join([*parts[:-1], f"{parts[-1][: -len(amount)]}{in_unit(amount, unit)}"])
