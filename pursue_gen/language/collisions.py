"""Names that are fine alone, but from which the generator would make one word twice.

The words of one agent differ from those of another in the agent's name only, so they are looked at once for all.
"""

from __future__ import annotations

from typing import Dict, Iterable, Iterator, List, Mapping, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import conditions_of
from pursue_gen.language.scenario import Patrol, Scenario, StatedObjective

Word = Tuple[str, str, Span]
"""A word, what it means, and where the name stands that it is made of."""


def check_collisions(scenario: Scenario) -> Iterator[Diagnostic]:
    """An error for each space of names in which a word would mean two things; one pair often collides in many words."""
    for clash in (_in_network(scenario), _among_locations(scenario), _first_twice(_package_words(scenario))):
        if clash is not None:
            word, first, second, span = clash
            message = f"{word} would mean both {first} and {second}"
            yield error("PML105", message, span, "rename one of them so that the two words differ")


_Clash = Tuple[str, str, str, Span]


def _first_twice(words: Iterable[Word]) -> Optional[_Clash]:
    seen: Dict[str, str] = {}
    for word, meaning, span in words:
        if seen.setdefault(word, meaning) != meaning:
            return word, seen[word], meaning, span
    return None


def _splits(word: str, sign: str) -> Iterator[Tuple[str, str]]:
    """The word cut at each place where `sign` stands in it."""
    place = word.find(sign)
    while place >= 0:
        yield word[:place], word[place + len(sign) :]
        place = word.find(sign, place + 1)


def _between(suffixes: Mapping[str, str], sign: str) -> Dict[str, Tuple[str, str]]:
    """What may stand between two words such that (short, between + sign + suffix) and (long, suffix) are the same."""
    found: Dict[str, Tuple[str, str]] = {}
    for suffix in suffixes:
        for between, rest in _splits(suffix, sign):
            if rest in suffixes:
                found.setdefault(between, (suffix, rest))
    return found


def _in_network(scenario: Scenario) -> Optional[_Clash]:
    """Whatever shares the names of the network's declarations and of the system state."""
    plain = list(_plain_words(scenario))
    clash = _first_twice(plain)
    agents = {agent.name: agent.span for agent in scenario.agents if agent.mobile is not None}
    if clash or not agents:
        return clash
    moves = list(_moves(scenario))
    name, span = next(iter(agents.items()))
    within = _first_twice((f"{name}_{suffix}", f"{name} {meaning}", span) for suffix, meaning in moves)
    if within:
        return within
    suffixes = dict(moves)
    for word, meaning, span in plain:
        for agent, suffix in _splits(word, "_"):
            if agent in agents and suffix in suffixes:
                return word, f"{agent} {suffixes[suffix]}", meaning, span
    between = _between(suffixes, "_")
    for long, span in agents.items():
        for short, rest in _splits(long, "_"):
            if short in agents and rest in between:
                longer, shorter = between[rest]
                return f"{long}_{shorter}", f"{short} {suffixes[longer]}", f"{long} {suffixes[shorter]}", span
    return None


def _plain_words(scenario: Scenario) -> Iterator[Word]:
    """All of them but those of movements; first those in which no name of the scenario is, which cannot be renamed."""
    yield from _numbered_words(scenario)
    has_conditions = any(conditions_of(scenario))
    for poi in scenario.pois:
        yield poi.name, f"the POI {poi.name}", poi.span
    for event in scenario.events:
        yield event.name, f"the event {event.name}", event.span
        yield names.done(event.name), f"the end of {event.name}", event.span
        if event.is_shared:
            yield names.busy(event.name), f"that {event.name} goes on", event.span
        if event.at_most is not None:
            yield names.count(event.name), f"the count of {event.name}", event.span
            yield names.rule_turn(names.count(event.name)), f"how often {event.name} has happened", event.span
    for rule in scenario.rules:
        yield rule.name, f"the rule {rule.name}", rule.span
        yield names.rule_turn(rule.name), f"the position of the rule {rule.name}", rule.span
        yield names.automaton_clock(rule.name), f"the clock of the rule {rule.name}", rule.span
        for agent in scenario.bound_by(rule):
            yield names.own_turn(rule.name, agent.name), f"the turn of {agent.name} in the rule {rule.name}", rule.span
    for state in scenario.states:
        yield state.name, f"the state {state.name}", state.span
        yield names.state_value(state.name), f"the value of the state {state.name}", state.span
    for agent in scenario.agents:
        yield agent.name, f"the agent {agent.name}", agent.span
        yield names.agent_position(agent.name), f"the position of {agent.name}", agent.span
        yield names.agent_clock(agent.name), f"the clock of {agent.name}", agent.span
        if has_conditions:
            yield names.busy_with(agent.name), f"with what {agent.name} is busy", agent.span
    for battery in scenario.batteries:
        yield names.level(battery.agent.name), f"the level of {battery.agent.name}'s battery", battery.span


def _numbered_words(scenario: Scenario) -> Iterator[Word]:
    """The words for objectives and assumptions, which have numbers and no names."""
    words: List[Tuple[StatedObjective, str]] = []
    for number, safety in enumerate(scenario.safety):
        automaton = names.safety_objective(number)
        words += [(safety, word) for word in (automaton, names.safety_clock(number))]
        words += [(safety, names.rule_turn(automaton))] if isinstance(safety, Patrol) and safety.order else []
    for number, reach in enumerate(scenario.reach):
        automaton = names.reach_objective(number)
        words += [(reach, word) for word in (automaton, names.reach_clock(number), names.unlocking(number))]
    for objective, word in words:
        yield word, "a part of an objective", objective.span
    for number, assumption in enumerate(scenario.assumptions, start=1):
        made = [names.assumption(number), names.assumption_count(number), names.assumption_clock(number)]
        yield from ((word, "a part of an assumption", assumption.span) for word in made)


def _ways(scenario: Scenario) -> Iterator[Tuple[str, str, Span]]:
    for way in scenario.connections:
        for a, b in way.directions:
            yield a, b, way.span


def _moves(scenario: Scenario) -> Iterator[Tuple[str, str]]:
    """What stands behind a mobile agent's name and `_` in the words for its movements, and what that means."""
    for a, b, _ in _ways(scenario):
        yield f"{a}2{b}", f"leaving {a} for {b}"
        yield f"{names.going(a, b)}2{b}", f"arriving at {b} from {a}"


def _among_locations(scenario: Scenario) -> Optional[_Clash]:
    """The names of an agent's locations, with which its commands are found."""
    ways = [(names.going(a, b), f"the way from {a} to {b}", span) for a, b, span in _ways(scenario)]
    clash = _first_twice(ways)
    if clash:
        return clash
    events = {event.name: event.span for event in scenario.events if event.duration is not None}
    between = _between({poi.name: "" for poi in scenario.pois}, "_in_") if events else {}
    for long, span in events.items():
        for short, rest in _splits(long, "_in_"):
            if short in events and rest in between:
                longer, shorter = between[rest]
                return names.doing(long, shorter), f"{short} in {longer}", f"{long} in {shorter}", span
    return None


def _package_words(scenario: Scenario) -> List[Word]:
    bringup = f"{scenario.name}_bringup"
    words = [(f"controller_{agent.name}", f"the package of {agent.name}", agent.span) for agent in scenario.agents]
    return words + [(bringup, "the package that starts the mission", agent.span) for agent in scenario.agents[:1]]
