"""What can happen in a scenario at all: where agents can get, which events can take place, which rules can turn."""

from __future__ import annotations

from typing import Dict, FrozenSet, Iterator, List, Mapping, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, error, warning
from pursue_gen.language.names import refs_of
from pursue_gen.language.scenario import Agent, Choice, Event, Ref, Rule, RuleBody, Scenario


def reachable(scenario: Scenario, agent: Agent) -> FrozenSet[str]:
    """The POIs where an agent can be: those connected with its start; its start alone if it is not mobile."""
    start = agent.location.name
    return component(scenario, start) if agent.mobile is not None else frozenset({start})


def component(scenario: Scenario, start: str) -> FrozenSet[str]:
    """The POIs that are connected with one of them, itself included."""
    found, open_ = {start}, [start]
    while open_:
        here = open_.pop()
        for way in scenario.connections:
            for near, far in ((way.a, way.b), (way.b, way.a)):
                if near == here and far not in found:
                    found.add(far)
                    open_.append(far)
    return frozenset(found)


def check_events(scenario: Scenario) -> Iterator[Diagnostic]:
    """Events that nobody can do, that lack a partner, or that are out of an agent's reach."""
    where = {agent.name: reachable(scenario, agent) for agent in scenario.agents}
    for event in scenario.events:
        doers = _doers(scenario, event)
        partners = [agent for agent in scenario.agents if _names(agent.reacts_to, event)]
        if not doers:
            hint = f"give it to an agent: can_do {event.name}, or delete the event"
            yield error("PML150", f"nobody can do {event.name}", event.span, hint)
        for agent in doers:
            yield from _reach(agent, event, where[agent.name])
        if event.collaborative:
            yield from _partners(event, doers, partners, where)
        else:
            for agent in partners:
                ref = next(ref for ref in agent.reacts_to if ref.name == event.name)
                message = f"{event.name} is not collaborative: it does not wait for {agent.name} to react to it"
                hint = f'write event "{event.name}" collaborative …, or delete it behind reacts_to'
                yield warning("PML152", message, ref.span, hint)


def _names(refs: Tuple[Ref, ...], event: Event) -> bool:
    return any(ref.name == event.name for ref in refs)


def _doers(scenario: Scenario, event: Event) -> List[Agent]:
    return [agent for agent in scenario.agents if _names(agent.can_do, event)]


def _reach(agent: Agent, event: Event, where: FrozenSet[str]) -> Iterator[Diagnostic]:
    if event.location is None or event.location.name in where:
        return
    ref = next(ref for ref in agent.can_do if ref.name == event.name)
    place, start = event.location.name, agent.location.name
    if agent.mobile is None:
        message = f"{agent.name} stays in {start} and can never do {event.name} in {place}"
        hint = f"make it mobile (mobile 1), let it start in {place}, or take {event.name} away from it"
    else:
        message = f"{agent.name} can never do {event.name}: no way leads from {start} to {place}"
        hint = f"connect them, or take {event.name} away from {agent.name}"
    yield error("PML153", message, ref.span, hint)


def _partners(
    event: Event, doers: List[Agent], partners: List[Agent], where: Mapping[str, FrozenSet[str]]
) -> Iterator[Diagnostic]:
    pairs = [(doer, other) for doer in doers for other in partners if doer.name != other.name]
    if not partners or (doers and not pairs):
        message = f"{event.name} is collaborative, but nobody {'else ' if partners else ''}reacts to it"
        hint = f"give another agent reacts_to {event.name}, or delete collaborative"
        yield error("PML151", message, event.span, hint)
        return
    for doer in doers:
        if any(doer.name == other.name for other in partners):
            message = f"{doer.name} both does {event.name} and reacts to it: it would be its own partner"
            hint = f"delete {event.name} behind its can_do or its reacts_to"
            yield error("PML155", message, doer.span, hint)
    places = frozenset([event.location.name]) if event.location is not None else None
    for doer, other in pairs:
        common = where[doer.name] & where[other.name]
        if common if places is None else common & places:
            return
    if pairs:
        message = f"{event.name} can never happen: those who do it and those who react to it never get to one place"
        yield error("PML154", message, event.span, "connect their places, or let them start where they can meet")


def check_rules(scenario: Scenario) -> Iterator[Diagnostic]:
    """Rules that name an event twice or can never turn, and dependencies that can never hold."""
    sound = True
    for rule in scenario.rules:
        seen: Set[str] = set()
        for ref in refs_of(rule.body):
            if ref.name in seen:
                sound = False
                message = f"the rule {rule.name} names {ref.name} twice: it could not tell whose turn it is"
                yield error("PML160", message, ref.span, "name each event once; use two events or two rules")
            seen.add(ref.name)
    if not sound:
        return
    possible = possible_events(scenario)
    for rule in scenario.rules:
        if not _can_turn(rule.body, possible):
            stuck = next(ref for ref in refs_of(rule.body) if ref.name not in possible)
            message = f"the rule {rule.name} can never turn: {_why(scenario, stuck.name, possible)}"
            yield error("PML161", message, stuck.span, "change the order, or take the event out of the rule")
    for dependency in scenario.dependencies:
        if not _attainable(scenario, dependency.state.name, dependency.value, possible):
            value = "true" if dependency.value else "false"
            message = f"{dependency.event.name} can never happen: {dependency.state.name} never becomes {value}"
            hint = f"name an event that can happen behind {value}_if of {dependency.state.name}, or start it as {value}"
            yield error("PML162", message, dependency.span, hint)


def possible_events(scenario: Scenario) -> FrozenSet[str]:
    """The events that may happen if whatever once was possible stays possible: those that are missing never can."""
    turns = [predecessors(rule) for rule in scenario.rules]
    able = [event.name for event in scenario.events if _doers(scenario, event)]
    possible: Set[str] = set()
    while True:
        more = {
            name
            for name in able
            if name not in possible
            and all(name not in turn or not turn[name] or turn[name] & possible for turn in turns)
            and all(
                dependency.event.name != name
                or _attainable(scenario, dependency.state.name, dependency.value, frozenset(possible))
                for dependency in scenario.dependencies
            )
        }
        if not more:
            return frozenset(possible)
        possible |= more


def predecessors(rule: Rule) -> Dict[str, FrozenSet[str]]:
    """For each event of a rule those after which it is its turn; the empty set: it is its turn at the start."""
    before: Dict[str, Set[str]] = {ref.name: set() for ref in refs_of(rule.body)}

    def visit(body: RuleBody) -> Tuple[Set[str], Set[str]]:
        """Notes who follows whom in the body; its first and its last events."""
        if isinstance(body, Ref):
            return {body.name}, {body.name}
        first, last = visit(body.first)
        first_then, last_then = visit(body.second)
        if isinstance(body, Choice):
            return first | first_then, last | last_then
        for name in first_then:
            before[name] |= last
        return first, last_then

    starts, _ = visit(rule.body)
    return {name: frozenset() if name in starts else frozenset(names) for name, names in before.items()}


def _attainable(scenario: Scenario, state_name: str, value: bool, possible: FrozenSet[str]) -> bool:
    for state in scenario.states:
        if state.name == state_name:
            setters = state.true_if if value else state.false_if
            return state.initially == value or any(ref.name in possible for ref in setters)
    return True  # an unknown state is reported as that


def _can_turn(body: RuleBody, possible: FrozenSet[str]) -> bool:
    if isinstance(body, Ref):
        return body.name in possible
    first, second = _can_turn(body.first, possible), _can_turn(body.second, possible)
    return first or second if isinstance(body, Choice) else first and second


def _why(scenario: Scenario, name: str, possible: FrozenSet[str]) -> str:
    """Why an event is not possible, in half a sentence."""
    if not any(ref.name == name for agent in scenario.agents for ref in agent.can_do):
        return f"nobody can do {name}"
    for rule in scenario.rules:
        waits_for = predecessors(rule).get(name, frozenset())
        if waits_for and not waits_for & possible:
            names = " or ".join(sorted(waits_for))
            return f"{name} waits for {names} in the rule {rule.name}, and that can never happen before it"
    return f"{name} waits for a state that never has the value it needs"
