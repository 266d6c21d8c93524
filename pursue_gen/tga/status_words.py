"""What rules, counts, states, assumptions and objectives are at, in words: what a location or value of each means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterator, List, Mapping, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.batteries import levels
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, Symbol, role_of
from pursue_gen.tga.counts import counted
from pursue_gen.tga.network import Automaton, Network
from pursue_gen.tga.objectives import stated
from pursue_gen.tga.own_turns import own_turns


@dataclass(frozen=True)
class Status:
    """The words for one automaton or variable: what it is called, and a text for each location or value of it."""

    of: str
    label: str
    texts: Mapping[str, str]


def statuses(scenario: Scenario, network: Network) -> Tuple[Status, ...]:
    """The words for all of a scenario but its agents, in the order of the scenario's statements."""
    found: List[Status] = []
    for event, most in counted(scenario):
        automaton = network.automaton(names.count(event.name))
        left = {place.name: _left(most - number) for number, place in enumerate(automaton.locations)}
        found.append(Status(automaton.name, scenario.shown(event.name), left))
    for rule in (rule for rule in scenario.rules if not rule.each):
        automaton = network.automaton(rule.name)
        texts = {place.name: _turn(scenario, automaton, place.name) for place in automaton.locations}
        found.append(Status(rule.name, rule.name, texts))
    for own in own_turns(scenario):
        order = own.order
        texts = {str(k): _turn(scenario, order, place.name) for k, place in enumerate(order.locations)}
        found.append(Status(own.variable, own.name, texts))
    variables = {name for name, _ in network.variables}
    for state in scenario.states:
        if names.state_value(state.name) in variables:
            found.append(Status(names.state_value(state.name), state.name, {"0": "false", "1": "true"}))
    for battery in scenario.batteries:
        texts = {str(level): f"{level} of {battery.capacity}" for level in levels(scenario, battery)}
        found.append(Status(names.level(battery.agent.name), f"battery of {battery.agent.shown}", texts))
    found += [Status(name, _shown_of(scenario, name), texts) for name, texts in own_words(network).items()]
    found += _assumptions(scenario)
    for name, objective in stated(scenario).items():
        if objective.order and names.rule_turn(name) in variables:
            following = {str(k): f"next: {scenario.shown(place)}" for k, place in enumerate(objective.order)}
            found.append(Status(names.rule_turn(name), objective.text, following))
        texts = {place.name: objective.status(place.name) for place in network.automaton(name).locations}
        found.append(Status(name, objective.text + objective.words.which, texts))
    return tuple(found)


def own_words(network: Network) -> Dict[str, Dict[str, str]]:
    """What the locations of a strategy's own automata mean, orders of passage and tours, in words, by automaton."""
    own = (each for each in network.automata if role_of(each.name) in (Role.PASSAGE, Role.TOUR))
    return {each.name: {place.name: Symbol.of(place.name).meaning for place in each.locations} for each in own}


def _shown_of(scenario: Scenario, automaton: str) -> str:
    """What an automaton of a strategy's own is called: by the place of an order of passage, or the robot of a tour."""
    symbol = Symbol.of(automaton)
    return "tour of " * (symbol.role is Role.TOUR) + scenario.shown(symbol.parts[0])


def turn_words(scenario: Scenario, automaton: Automaton, location: str) -> str:
    """What a rule waits for in a location, as in `next: load or wait`."""
    channels = _channels(automaton, location, leaving=True)
    ends = (role_of(channel) is Role.END for channel in channels)
    shown = ("the end of " * is_end + _event(scenario, channel) for channel, is_end in zip(channels, ends))
    return "next: " + " or ".join(shown)


def _turn(scenario: Scenario, automaton: Automaton, location: str) -> str:
    """What has been done last, and what is next; or what goes on."""
    following = _channels(automaton, location, leaving=True)
    if following and all(role_of(channel) is Role.END for channel in following):
        return " and ".join(f"{_event(scenario, channel)} goes on" for channel in following)
    before = [_event(scenario, channel) for channel in _channels(automaton, location, leaving=False)]
    done = f"{before[0]} done, " if len(before) == 1 and location != automaton.initial else ""
    return done + turn_words(scenario, automaton, location)


def _channels(automaton: Automaton, location: str, leaving: bool) -> List[str]:
    """The channels of the edges that leave a location, or that lead to it, each once."""
    edges = (edge for edge in automaton.edges if (edge.source if leaving else edge.target) == location)
    return list(dict.fromkeys(edge.sync.channel for edge in edges if edge.sync))


def _event(scenario: Scenario, channel: str) -> str:
    """What people read for the event of a channel."""
    return scenario.shown(Symbol.of(channel).parts[0])


def _left(number: int) -> str:
    if not number:
        return "may not be done any more"
    return f"may be done {number} more time{'' if number == 1 else 's'}"


def _assumptions(scenario: Scenario) -> Iterator[Status]:
    for number, assumption in enumerate(scenario.assumptions, start=1):
        holds = {"1": "assumed", "0": "broken: not assumed any more"}
        yield Status(names.assumption(number), assumption.clause, holds)
        label, done = assumption.counted
        if done:
            yield Status(names.assumption_count(number), label, done)
