"""What is wrong with conditions: what an agent never is or does, what says nothing or too much, and what nobody need
find out."""

from __future__ import annotations

from math import comb
from typing import AbstractSet, Iterator, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.clauses import MOST_CLAUSES, Domains, TooMany, clauses_of, holds_at_start
from pursue_gen.language.conditions import (
    At,
    Atom,
    Condition,
    Doing,
    Has,
    Holds,
    Not,
    atoms,
    condition_text,
    condition_words,
    names_in,
    predicate_words,
)
from pursue_gen.language.lifts import is_said
from pursue_gen.language.objectives.holds import Holds as Room
from pursue_gen.language.objectives.holds import rooms_in
from pursue_gen.language.scenario import Ref, Safety, Scenario, State, StatedObjective

MOST_ROOM = 1_000
"""The ways in which more can be somewhere than there is room for: as many edges has its automaton. Not measured."""

MOST_ROOMS = 50_000
"""The same for all rooms of a statement. Measured on 20 robots in a building of 150 places."""


def check_conditions(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about the conditions of a scenario whose names are all declared."""
    domains = Domains(scenario)
    for condition, span in scenario.conditions():
        impossible = [finding for atom in atoms(condition) for finding in _impossible(scenario, domains, atom, span)]
        senseless = [] if impossible else list(_without_sense(condition, span, domains))
        yield from impossible or senseless
        for safety in scenario.safety:
            if any(each is condition for each in safety.conditions) and not (impossible or senseless):
                yield from _lost_at_start(scenario, safety.span, safety.breaks.condition, domains)
    for safety in scenario.safety:
        if safety.breaks.condition is None:
            yield from _heard(scenario, safety, domains)
        elif not safety.conditions:
            yield from (found for room in rooms_in([safety]) for found in _room(scenario, room, domains))
        for stands in safety.breaks.stands:
            yield from _impossible(scenario, domains, stands, safety.span)


def _heard(scenario: Scenario, safety: Safety, domains: Domains) -> Iterator[Diagnostic]:
    """Conditions of which no automaton could see when they come to hold, and those that are too large together."""
    events = {event.name: event for event in scenario.events}
    for atom in (atom for condition in safety.conditions for atom in atoms(condition)):
        if isinstance(atom, Has):
            message = f"it cannot be seen who begins to have {atom.thing.shown}: only events can be seen"
            hint = f"name the event that takes {atom.thing.name}, as in if load then …"
            yield error("PML262", message, atom.thing.span, hint)
        if not isinstance(atom, Doing):
            continue
        event, name = events[atom.event.name], atom.event.name
        if len(scenario.doers(name)) > 1 or (event.is_shared and event.location is None):
            message = f"it cannot be seen who begins {name}: several agents may be the one"
            hint = f"name the event itself (if {name} then …), a state that it sets, or give it to one agent only"
            yield error("PML262", message, atom.event.span, hint)
    try:
        size = sum(len(clauses_of(c, domains, value)) for c in safety.conditions for value in (True, False))
    except TooMany:
        return  # reported with the condition
    if size > MOST_CLAUSES:
        hint = "put what belongs together into states that events set, or split it into several statements"
        message = f"these conditions, written as clauses that all have to hold, have more than {MOST_CLAUSES} of them"
        yield error("PML233", message, safety.span, hint)


def _room(scenario: Scenario, safety: Room, domains: Domains) -> Iterator[Diagnostic]:
    """An objective on how many are somewhere: where nobody ever is, or no more, and one that is too large."""
    rooms = [(room, domains.counted(room)) for room in safety.rooms]
    said = is_said(scenario, safety)
    if said and not safety.in_one:
        named = (atom for room, counted in rooms for atom in room.parts if isinstance(atom, At) or not counted)
        impossible = [found for atom in named for found in _impossible(scenario, domains, atom, safety.span)]
        if impossible:
            yield from impossible
            return
    most, largest = safety.most, max((len(counted) for _, counted in rooms), default=0)
    sizes = [comb(len(counted), most + 1) for _, counted in rooms]
    if largest <= most and not said:
        return
    if largest <= most:
        message = f"this changes nothing: never are more than {largest} {safety.in_one or safety.where}"
        yield warning("PML232", message, safety.span, "write a smaller number, or delete it")
    elif max(sizes) > MOST_ROOM or sum(sizes) > MOST_ROOMS:
        ways = f"{MOST_ROOM} ways" if max(sizes) > MOST_ROOM else f"{MOST_ROOMS:,} ways in all"
        message = f"so many of {largest} can be there in more than {ways}"
        yield error("PML233", message, safety.span, "let it hold 1, or name fewer of them")
    else:
        for room, _ in rooms:
            yield from _lost_at_start(scenario, safety.span, Not(room), domains)


def _lost_at_start(
    scenario: Scenario, span: Span, broken: Optional[Condition], domains: Domains
) -> Iterator[Diagnostic]:
    """An objective that is broken before anything has happened; `broken`: while this holds."""
    if broken is not None and holds_at_start(broken, scenario, domains, any):
        message = f"the objective is lost before anything moves: {condition_words(broken)}"
        hint = "let agents start somewhere else, start the states with other values, or correct the condition"
        yield error("PML234", message, span, hint)


def _impossible(scenario: Scenario, domains: Domains, atom: Atom, span: Span) -> Iterator[Diagnostic]:
    """An agent where it never is, or at what it never does; `span`: the statement's."""
    if isinstance(atom, Holds) or domains.literals(atom):
        return
    who, kind = atom.who.agent, "robot" if atom.who.robots else "agent"
    is_never = f"no {kind} is ever" if who is None else f"{who.name} is never"
    if isinstance(atom, At):
        hint = "connect the place with where it starts, make it mobile, or name another place"
        yield error("PML230", f"{is_never} at {atom.place.name}", atom.place.span, hint)
    elif isinstance(atom, Has):
        message = f"no {kind} ever has {atom.thing.name}" if who is None else f"{who.name} never has {atom.thing.name}"
        hint = "let it do an event that takes or mounts it, or name another thing"
        yield error("PML231", message, atom.thing.span, hint)
    elif isinstance(atom, Doing):
        event = next(event for event in scenario.events if event.name == atom.event.name)
        message, hint = f"{is_never} doing {event.name}", f"give it to the agent: can_do {event.name}"
        hint += f", or reacts_to {event.name}" if event.is_shared else ""
        if event.duration is None:
            message = f"{event.name} takes no time: no agent is ever doing it"
            hint = f"give it a duration, or let {event.name} make a state true and name the state"
        yield error("PML231", message, atom.event.span, hint)
    elif atom.ends:
        hint = "connect {} with {}, make it mobile, or name another way".format(*(ref.name for ref in atom.ends))
        yield error("PML230", f"{is_never} {predicate_words(atom)}", atom.ends[0].span, hint)
    else:
        hint = "make it mobile (mobile 1), or delete this part of the condition"
        place = span if who is None else who.span
        yield error("PML230", f"{is_never} on its way: nothing there is mobile", place, hint)


def _without_sense(condition: Condition, span: Span, domains: Domains) -> Iterator[Diagnostic]:
    """A condition that always holds, one that never does, and one that is too long as a guard."""
    try:
        always, never = not clauses_of(condition, domains), not clauses_of(condition, domains, value=False)
    except TooMany:
        hint = "put what belongs together into states that events set, or split it into several statements"
        message = f"this condition, written as clauses that all have to hold, has more than {MOST_CLAUSES} of them"
        yield error("PML233", message, span, hint)
        return
    if always or never:
        message = f"this condition {'always' if always else 'never'} holds: {condition_text(condition)}"
        yield warning("PML232", message, span, "delete it, or correct what it says")


def check_unknown(scenario: Scenario) -> Iterator[Diagnostic]:
    """A warning where what has to be answered is found out by robots alone, and nothing has them do that: they keep
    such an objective if they never look."""
    unknown = {state.name: state for state in scenario.states if state.is_found_out}
    for each in scenario.safety if unknown else ():
        begins = each.breaks.begins
        if begins is None or isinstance(begins, Ref):
            continue
        asked = dict.fromkeys(atom.state.name for atom in atoms(begins) if isinstance(atom, Holds))
        others = {name for other in scenario.objectives if other is not each for name in _named(other)}
        places = (event.location for event in scenario.events if event.name in others)
        others |= {place.name for place in places if place is not None}
        for state in (unknown[name] for name in asked if name in unknown):
            if not _is_found_out(state, scenario, others):
                how, wanted = _how(state)
                message = f"nothing has the robots find out whether {state.name} is true: they need not {how}"
                yield warning("PML434", message, each.span, f"ask for that, too, as in objective: {wanted}")


def _how(state: State) -> Tuple[str, str]:
    """How robots find it out, and an objective that has them do that."""
    if state.seen_at is not None:
        return f"be at {state.seen_at.name}", f"patrol {state.seen_at.name} every 600 by any robot"
    shows = ", ".join(ref.name for ref in state.shown_by[:1])
    return f"do {shows}", f"if call then {shows} within 60"


def _is_found_out(state: State, scenario: Scenario, wanted: AbstractSet[str]) -> bool:
    """True where others than robots show what the state is, or set it, or where something of this is wanted that leads
    to it."""
    shows = {ref.name for ref in state.shown_by}
    events = shows.union(ref.name for ref in (*state.true_if, *state.false_if))
    others = {ref.name for agent in scenario.agents if not agent.controllable for ref in agent.can_do}
    place = "" if state.seen_at is None else state.seen_at.name
    starts = any(agent.is_robot and agent.location.name == place for agent in scenario.agents)
    return bool(events & others or shows & wanted) or starts or place in wanted


def _named(objective: StatedObjective) -> Iterator[str]:
    """The events, places and all else that an objective names."""
    yield from (ref.name for _, ref in objective.names())
    yield from (ref.name for one in objective.conditions for _, ref in names_in(one))
