"""What can happen in a scenario at all: where agents can get, which events can take place, which rules can turn."""

from __future__ import annotations

from dataclasses import replace
from typing import Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Set, Tuple, TypeVar

from pursue_gen.diagnostics import Diagnostic, error, warning
from pursue_gen.language.names import events_used
from pursue_gen.language.refs import twice
from pursue_gen.language.scenario import Agent, Dependency, Event, Ref, Rule, Scenario
from pursue_gen.language.statements.rule import Earlier, can_turn, has_both, locations_of, predecessors

Node = TypeVar("Node")

_SOME = 5  # events that a message lists

MOST_LOCATIONS = 600
"""Of the automaton of a rule: `and` of nine events has 511, and the guard of each event tests half of them."""


def _from(start: Node, following: Mapping[Node, Iterable[Node]]) -> FrozenSet[Node]:
    """All that is reached from a start, itself included."""
    found, open_ = {start}, [start]
    while open_:
        for other in following.get(open_.pop(), ()):
            if other not in found:
                found.add(other)
                open_.append(other)
    return frozenset(found)


def components(scenario: Scenario) -> Dict[str, FrozenSet[str]]:
    """For each POI those that are connected with it, itself included; connected ones share one set."""
    near: Dict[str, List[str]] = {poi.name: [] for poi in scenario.pois}
    for way in scenario.connections:
        near.setdefault(way.a, []).append(way.b)
        near.setdefault(way.b, []).append(way.a)
    connected: Dict[str, FrozenSet[str]] = {}
    for start in near:
        if start in connected:
            continue
        shared = _from(start, near)
        connected.update((name, shared) for name in shared)
    return connected


def destinations(scenario: Scenario) -> Dict[str, FrozenSet[str]]:
    """For each POI those that can be reached from it, itself included; connected ones share one set where they can."""
    one_ways = [way for way in scenario.connections if way.one_way]
    if not one_ways:
        return components(scenario)
    both = tuple(way for way in scenario.connections if not way.one_way)
    parts = components(replace(scenario, connections=both))  # within these one can go anywhere and back
    alone = {name: frozenset({name}) for way in one_ways for name in (way.a, way.b)}
    parts = {**alone, **parts}
    onward: Dict[FrozenSet[str], List[FrozenSet[str]]] = {}
    for way in one_ways:
        onward.setdefault(parts[way.a], []).append(parts[way.b])
    reached: Dict[FrozenSet[str], FrozenSet[str]] = {}
    for start in set(parts.values()):
        reached[start] = frozenset().union(*_from(start, onward))
    return {name: reached[part] for name, part in parts.items()}


def destinations_from(scenario: Scenario, start: str, agent: str) -> FrozenSet[str]:
    """The POIs that the agent of this name would reach from one of them, itself included."""
    ways = scenario.ways_of(agent)
    return destinations(replace(scenario, connections=ways)).get(start, frozenset({start}))


def places_of(scenario: Scenario) -> Dict[str, FrozenSet[str]]:
    """For each agent the POIs where it can be: those that a start leads to; its starts alone if it is not mobile."""
    leads: Dict[Tuple[object, ...], Dict[str, FrozenSet[str]]] = {}  # by what is closed to agents
    found = {}
    for agent in scenario.agents:
        closed, starts = scenario.closed_to(agent.name), frozenset(ref.name for ref in agent.starts)
        if closed not in leads:
            leads[closed] = destinations(replace(scenario, connections=scenario.ways_of(agent.name)))
        onward = (leads[closed].get(start, starts) for start in starts)
        found[agent.name] = starts.union(*onward) if agent.mobile is not None else starts
    return found


def robots_at(scenario: Scenario) -> Dict[str, Tuple[str, ...]]:
    """For each POI the robots that may be there, in the order of their declaration."""
    places = places_of(scenario)
    where = {agent.name: places[agent.name] for agent in scenario.agents if agent.is_robot}
    return {poi.name: tuple(name for name, places in where.items() if poi.name in places) for poi in scenario.pois}


_Part = Tuple[Agent, Ref]
"""An agent, and where it names an event."""


def check_events(scenario: Scenario) -> Iterator[Diagnostic]:
    """Events that nothing uses, that nobody can do, that lack a partner, or that are out of an agent's reach."""
    where = places_of(scenario)
    able, reacting = _parts(scenario, "can_do"), _parts(scenario, "reacts_to")
    used = events_used(scenario)
    for event in scenario.events:
        if event.name not in used:
            hint = f"let an agent do it: can_do {event.name}, or delete the event"
            message = f"nothing uses {event.name}: no agent, rule, state or objective names it"
            yield warning("PML157", message, event.span, hint)
            continue
        doers, partners = able.get(event.name, []), reacting.get(event.name, [])
        if event.on_order:
            yield from _ordered(event, [ref for _, ref in (*doers, *partners)], scenario)
            continue
        if not doers:
            hint = f"give it to an agent: can_do {event.name}, or delete the event"
            yield error("PML150", f"nobody can do {event.name}", event.span, hint)
        for agent, ref in doers:
            way = "way that it may take" if scenario.closed_to(agent.name) else "way"
            yield from _reach(agent, ref, event, where[agent.name], way)
        yield from _togetherness(event, [a.name for a, _ in doers])
        if event.collaborative:
            yield from _partners(event, [a for a, _ in doers], [a for a, _ in partners], where)
        else:
            for agent, ref in partners:
                message = f"{event.name} is not collaborative: it does not wait for {agent.name} to react to it"
                hint = f'write event "{event.name}" collaborative …, or delete it behind reacts_to'
                yield warning("PML152", message, ref.span, hint)


def _ordered(event: Event, parts: List[Ref], scenario: Scenario) -> Iterator[Diagnostic]:
    """An event that people order, which agents do or which waits for a state."""
    for ref in parts:
        message = f"{event.name} is ordered by people, so no agent does it"
        yield error("PML451", message, ref.span, f"delete {event.name} here, or on_order behind event \"{event.name}\"")
    for dependency in scenario.dependencies:
        if dependency.event.name == event.name:
            message = f"{event.name} is ordered by people: it waits for no state"
            hint = "let what answers it wait; orders that cannot be kept are refused"
            yield error("PML451", message, dependency.event.span, hint)


def _togetherness(event: Event, doers: List[str]) -> Iterator[Diagnostic]:
    """`together` where it changes nothing or cannot be meant, and a lasting event of two that ends for one alone."""
    name = event.name
    if event.together and not event.collaborative:
        message = f"{name} is together, but not collaborative: nobody takes part in it but the one who does it"
        hint = f'write event "{name}" collaborative together …, or delete together'
        yield error("PML159", message, event.span, hint)
    elif event.together and event.duration is None:
        message = f"{name} is together, but has no duration: what is done at once is done together anyway"
        yield error("PML159", message, event.span, "delete together, or write how long it takes: duration 4")
    elif event.together and event.location is None and len(doers) > 1:
        message = f"{name} can be done anywhere by {' and by '.join(doers[:_SOME])}: with whom its partner is, is open"
        hint = f"write where it happens (location …), or give each of them an event of its own instead of {name}"
        yield error("PML163", message, event.span, hint)
    elif event.collaborative and event.duration is not None and not event.together:
        message = f"whoever reacts to {name} may leave as soon as it has begun: only the one who does it is busy"
        hint = f'write event "{name}" collaborative together … where both are busy until it ends'
        yield warning("PML158", message, event.span, hint)


def _parts(scenario: Scenario, field: str) -> Dict[str, List[_Part]]:
    """For each event the agents that name it behind can_do (or reacts_to), each once."""
    parts: Dict[str, List[_Part]] = {}
    for agent in scenario.agents:
        for name, ref in {ref.name: ref for ref in reversed(getattr(agent, field))}.items():
            parts.setdefault(name, []).append((agent, ref))
    return parts


def _reach(agent: Agent, ref: Ref, event: Event, where: FrozenSet[str], way: str) -> Iterator[Diagnostic]:
    if event.location is None or event.location.name in where:
        return
    place, start = event.location.name, agent.starts_text
    if agent.mobile is None:
        message = f"{agent.name} stays in {start} and can never do {event.name} in {place}"
        hint = f"make it mobile (mobile 1), let it start in {place}, or take {event.name} away from it"
    else:
        message = f"{agent.name} can never do {event.name}: no {way} leads from {start} to {place}"
        hint = f"connect them, or take {event.name} away from {agent.name}"
    yield error("PML153", message, ref.span, hint)


def _partners(
    event: Event, doers: List[Agent], partners: List[Agent], where: Mapping[str, FrozenSet[str]]
) -> Iterator[Diagnostic]:
    names = {agent.name for agent in partners}
    alone = len(doers) == 1 and names == {doers[0].name}
    if not partners or alone:
        message = f"{event.name} is collaborative, but nobody {'else ' if partners else ''}reacts to it"
        hint = f"give another agent reacts_to {event.name}, or delete collaborative"
        yield error("PML151", message, event.span, hint)
        return
    both = [agent for agent in doers if agent.name in names]
    for agent in both:
        message = f"{agent.name} both does {event.name} and reacts to it: it would be its own partner"
        hint = f"delete {event.name} behind its can_do or its reacts_to"
        yield error("PML155", message, agent.span, hint)
    if both or not doers:
        return  # who meets whom is clear only when that is mended
    theirs, others = _places(doers, where), _places(partners, where)
    place = event.location.name if event.location is not None else None
    meet = not theirs.isdisjoint(others) if place is None else place in theirs and place in others
    if not meet:
        message = f"{event.name} can never happen: those who do it and those who react to it never get to one place"
        yield error("PML154", message, event.span, "connect their places, or let them start where they can meet")


def _places(agents: List[Agent], where: Mapping[str, FrozenSet[str]]) -> FrozenSet[str]:
    """The POIs where one of the agents can be."""
    places = {where[agent.name] for agent in agents}  # most often one set, which is large
    return frozenset().union(*places) if len(places) > 1 else next(iter(places))


class _Course:
    """What the rules and dependencies of a scenario say of each event, looked up by its name."""

    def __init__(self, scenario: Scenario) -> None:
        self.able = {ref.name for agent in scenario.agents for ref in agent.can_do}
        self.able |= {event.name for event in scenario.events if event.on_order}
        self.waits: Dict[str, List[Tuple[Rule, Earlier]]] = {}
        """For each event the rules that name it, with the events after which it is its turn; none: at the start."""
        for rule in scenario.rules:
            if rule.each:
                continue  # who is bound by it waits for what it does itself; others may not be bound
            for name, before in predecessors(rule).items():
                self.waits.setdefault(name, []).append((rule, before))
        self.needs: Dict[str, List[Dependency]] = {}
        for dependency in scenario.dependencies:
            self.needs.setdefault(dependency.event.name, []).append(dependency)
        self.states = {state.name: state for state in reversed(scenario.states)}

    def setters(self, dependency: Dependency) -> Optional[FrozenSet[str]]:
        """The events that give the state the value that is needed; None: it has it at the start, or may be found to
        have it, or there is no such state."""
        state = self.states.get(dependency.state.name)
        if state is None or state.is_found_out or state.initially == dependency.value:
            return None
        return frozenset(ref.name for ref in (state.true_if if dependency.value else state.false_if))

    def conditions(self, name: str) -> List[FrozenSet[str]]:
        """Of each of these sets, one event has to happen before this one can."""
        needed = [self.setters(dependency) for dependency in self.needs.get(name, ())]
        return [some for _, earlier in self.waits.get(name, ()) for some in earlier] + [
            some for some in needed if some is not None
        ]

    def possible(self) -> FrozenSet[str]:
        """The events that may happen if whatever once was possible stays possible: those missing never can."""
        found: Set[str] = set()
        waiting = {name: self.conditions(name) for name in self.able}
        wakes: Dict[str, List[str]] = {}
        for name, conditions in waiting.items():
            for event in frozenset().union(*conditions):
                wakes.setdefault(event, []).append(name)
        open_ = list(waiting)
        while open_:
            name = open_.pop()
            if name not in found and all(not condition.isdisjoint(found) for condition in waiting[name]):
                found.add(name)
                open_ += wakes.get(name, ())
        return frozenset(found)

    def why_not(self, name: str, possible: FrozenSet[str]) -> str:
        """Why an event is not possible, in half a sentence."""
        if name not in self.able:
            return f"nobody can do {name}"
        for rule, earlier in self.waits.get(name, ()):
            missing = next((some for some in earlier if some.isdisjoint(possible)), None)
            if missing is not None:
                names = " or ".join(sorted(missing)[:_SOME])
                return f"{name} waits for {names} in the rule {rule.name}, and that can never happen before it"
        return f"{name} waits for a state that never has the value it needs"


def _each(scenario: Scenario) -> Iterator[Diagnostic]:
    """Rules for each robot or agent that bind none, or one who cannot do what comes next."""
    for rule in scenario.rules:
        bound = scenario.bound_by(rule)
        if rule.each and not bound:
            who = rule.each
            message = f"the rule {rule.name} is for each {who}, but no {who} can do one of its events"
            yield error("PML205", message, rule.span, f"let one do its events, or delete for each {who}")
        for agent in bound:
            own = frozenset(ref.name for ref in agent.can_do)
            if not can_turn(rule.body, own):
                missing = ", ".join(ref.name for ref in rule.events if ref.name not in own)
                message = f"{agent.name} cannot end a round of the rule {rule.name}: it cannot do {missing}"
                yield warning("PML206", message, agent.span, f"add {missing} behind its can_do, if it is to go on")


def check_rules(scenario: Scenario) -> Iterator[Diagnostic]:
    """Rules that name an event twice or can never turn, and dependencies that can never hold."""
    sound = True
    lasting = {event.name for event in scenario.events if event.duration is not None}
    for rule in scenario.rules:
        count = locations_of(rule.body, lasting) + 1
        if count > MOST_LOCATIONS and has_both(rule.body):
            number = f"{count:,}" if count < 10**9 else "more than a billion"
            why = f"has {number} positions, because its parts come in any order"
            hint = "join fewer events with and, or put some of them in order with before"
            yield error("PML203", f"the rule {rule.name} {why}: expected at most {MOST_LOCATIONS}", rule.span, hint)
        for ref in twice(rule.events):
            sound = False
            message = f"the rule {rule.name} names {ref.name} twice: it could not tell whose turn it is"
            yield error("PML160", message, ref.span, "name each event once; use two events or two rules")
    if not sound:
        return
    yield from _each(scenario)
    course = _Course(scenario)
    possible = course.possible()
    for rule in scenario.rules:
        if not can_turn(rule.body, possible):
            stuck = next(ref for ref in rule.events if ref.name not in possible)
            message = f"the rule {rule.name} can never turn: {course.why_not(stuck.name, possible)}"
            yield error("PML161", message, stuck.span, "change the order, or take the event out of the rule")
    for dependency in scenario.dependencies:
        setters = course.setters(dependency)
        if setters is not None and setters.isdisjoint(possible):
            value = "true" if dependency.value else "false"
            message = f"{dependency.event.name} can never happen: {dependency.state.name} never becomes {value}"
            hint = f"name an event that can happen behind {value}_if of {dependency.state.name}, or start it as {value}"
            yield error("PML162", message, dependency.span, hint)
