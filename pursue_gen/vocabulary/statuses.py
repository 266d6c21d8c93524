"""What rules, counts, states, assumptions and objectives are at, in words: what a location or value of each means.

The workspace has these words as data, for the page of the UI.
"""

from __future__ import annotations

from typing import Iterator, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.batteries import levels, shown_level
from pursue_gen.language.loads import carriers, load_words
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.tga.network import Automaton, Network
from pursue_gen.tga.objectives import stated
from pursue_gen.tga.rules import counted, own_turns, split
from pursue_runtime.ui.statuses import Status


def statuses(scenario: Scenario, network: Network) -> Tuple[Status, ...]:
    """The words for all of a scenario but its agents, in the order of the scenario's statements."""
    return (
        *courses(scenario, network), *_own(scenario, network), *_assumptions(scenario), *_objectives(scenario, network)
    )  # fmt: skip


def courses(scenario: Scenario, network: Network) -> Tuple[Status, ...]:
    """The same for counts, rules, turns of agents, states, batteries and loads alone."""
    found: List[Status] = []
    for event, most in counted(scenario):
        count = network.automaton(names.count(event.name))
        done = {place.name: f"{number} of {most} times" for number, place in enumerate(count.locations)}
        found.append(Status(count.name, event.shown, done))
    for event, parts in split(scenario):
        count = network.automaton(names.parts(event.name))
        done = {place.name: f"{number} of {parts} parts" for number, place in enumerate(count.locations)}
        found.append(Status(count.name, event.shown, done))
    for rule in (rule for rule in scenario.rules if not rule.each):
        automaton = network.automaton(rule.name)
        texts = {place.name: _turn(scenario, automaton, place.name) for place in automaton.locations}
        found.append(Status(rule.name, rule.name, texts, inside=True))
    for own in own_turns(scenario):
        order = own.order
        texts = {str(k): _turn(scenario, order, place.name) for k, place in enumerate(order.locations)}
        found.append(Status(own.variable, own.name, texts, inside=True))
    variables = {name for name, _ in network.variables}
    for state in scenario.states:
        if names.state_value(state.name) in variables:
            unknown = {str(names.UNKNOWN_VALUE): "unknown"} if state.is_found_out else {}
            values = {"0": "false", "1": "true", **unknown}
            found.append(Status(names.state_value(state.name), state.name, values))
    for battery in scenario.batteries:
        of = f"of {battery.capacity}"
        texts = {str(level): f"{shown_level(scenario, battery, level)} {of}" for level in levels(scenario, battery)}
        found.append(Status(names.level(battery.agent.name), f"battery of {battery.agent.shown}", texts))
    for one in carriers(scenario):
        texts = {str(number): load_words(scenario, one, load) for number, load in enumerate(one.loads)}
        found.append(Status(names.load(one.agent.name), f"load of {one.agent.shown}", texts))
    return tuple(found)


def _turn(scenario: Scenario, automaton: Automaton, location: str) -> str:
    """What a rule waits for in a location, as in `next: load or wait`; or what goes on."""
    leaving = (edge.sync.channel for edge in automaton.edges if edge.source == location and edge.sync)
    channels = [Symbol.of(channel) for channel in dict.fromkeys(leaving)]
    ends = [channel for channel in channels if channel.role not in (Role.BROKEN_OFF, Role.PART_END)]
    if ends and all(channel.role is Role.END for channel in ends):
        return " and ".join(f"{scenario.shown(channel.parts[0])} goes on" for channel in ends)
    shown = ("the end of " * (each.role is Role.END) + scenario.shown(each.parts[0]) for each in ends)
    return "next: " + " or ".join(shown)


def _own(scenario: Scenario, network: Network) -> Iterator[Status]:
    """A strategy's own automata: orders of passage, called by their places, and tours of robots."""
    for automaton in network.automata:
        symbol = Symbol.of(automaton.name)
        if symbol.role in (Role.PASSAGE, Role.TOUR):
            places = [Symbol.of(place.name) for place in automaton.locations]
            texts = {str(each): each.role.meaning.format(*map(scenario.shown, each.parts)) for each in places}
            label = "tour of " * (symbol.role is Role.TOUR) + scenario.shown(symbol.parts[0])
            yield Status(automaton.name, label, texts)


def _assumptions(scenario: Scenario) -> Iterator[Status]:
    for number, assumption in enumerate(scenario.assumed, start=1):
        holds = {"1": "assumed", "0": "broken: not assumed any more"}
        yield Status(names.assumption(number), assumption.clause, holds, inside=True)
        label, done = assumption.counted
        if done:
            yield Status(names.assumption_count(number), label, dict(done), inside=True)


def _objectives(scenario: Scenario, network: Network) -> Iterator[Status]:
    variables = {name for name, _ in network.variables}
    for name, objective in stated(scenario).items():
        own = ((role(name), said) for role, said in objective.variables(scenario.shown))
        yield from (Status(one, objective.text, dict(said), inside=True) for one, said in own if one in variables)
        texts = {place.name: objective.status(place.name) for place in network.automaton(name).locations}
        yield Status(name, objective.text + objective.words.which, texts)
