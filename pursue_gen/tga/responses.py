"""`if … then … within`: automata that see when something has to be answered, and when it is.

An event has a channel. A condition comes to hold by a move, so the automaton listens to the moves that change one of
its parts: who sets off and arrives, what begins and ends, which events set a state. A receiver's guard is evaluated
before the move; it says what has to hold there so that the condition holds afterwards. Where states are not known, a
condition comes to hold when it is known that it does.
"""

from __future__ import annotations

from typing import Dict, Iterable, Iterator, List, Optional, Tuple, Union

from pursue_gen.language import network_names as names
from pursue_gen.language.clauses import Clauses, Domains, clauses_of, holds_at_start, possibly, unless_placed
from pursue_gen.language.conditions import At, Condition, Doing, Holds, OnWay, atoms
from pursue_gen.language.network_names import AT_RISK, IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.scenario import Escort, Ref, Respond, Scenario
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.conditions import Change, arriving, found_out, happening, placed, setting_off
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Sync

_Moves = Dict[str, Change]


def awaited_by(condition: Condition, scenario: Scenario, domains: Domains) -> Iterator[Tuple[str, str]]:
    """The agents with the POIs at which their arrival changes the condition."""
    for atom in atoms(condition):
        if isinstance(atom, (At, OnWay)):
            named = (atom.place,) if isinstance(atom, At) else atom.ends
            places = [ref.name for ref in named] or [poi.name for poi in scenario.pois]
            yield from ((agent, place) for agent in domains.among(atom.who) for place in places)


def respond_automaton(respond: Union[Respond, Escort], around: Surroundings, number: int) -> Automaton:
    """The automaton of a duty to answer within a deadline: it is at risk from what is to be answered to the answer."""
    scenario, conditions, clock = around.scenario, around.conditions, names.safety_clock(number)
    domains = conditions.domains
    trigger, response = respond.trigger, respond.response
    due, answered = _moves(trigger, scenario, domains), _moves(response, scenario, domains)
    edges: List[Edge] = []
    for channel, move in {**due, **answered}.items():
        sync = Sync(channel, sends=False)
        answers = _comes(response, move, domains) if channel in answered else None
        at_once = isinstance(response, Ref) and channel in answered
        if channel in due and not at_once:
            parts = [] if isinstance(response, Ref) else [move.before(_fails(response, domains), domains)]
            if not isinstance(trigger, Ref):
                parts.append(_fails(trigger, domains))
                parts.append(move.before(clauses_of(trigger, domains), domains))
            guard = move.guard(parts, domains)
            if guard is not None:
                edges.append(Edge(IDLE, AT_RISK, Guard(integers=conditions.tests(guard)), sync, resets=(clock,)))
        if answers is not None:
            edges.append(Edge(AT_RISK, IDLE, Guard(integers=conditions.tests(answers)), sync))
    # The deadline is the invariant of atRisk; this is what remains to do when it is reached.
    edges.append(Edge(AT_RISK, LOSE))
    locations = (Location(IDLE), Location(LOSE), Location(AT_RISK, (ClockBound(clock, "<=", exact(respond.deadline)),)))
    waits = _holds_first(trigger, scenario, domains) and not _holds_first(response, scenario, domains)
    return Automaton(names.safety_objective(number), locations, AT_RISK if waits else IDLE, tuple(edges))


def _fails(condition: Condition, domains: Domains) -> Clauses:
    """What has to hold where it is not known that a condition does: it may not."""
    return unless_placed(possibly(clauses_of(condition, domains, False), domains), domains)


def _comes(what: Union[Ref, Condition], move: Change, domains: Domains) -> Optional[Clauses]:
    """What has to hold before the move so that the event happens, or the condition holds, with it; None: it cannot."""
    return () if isinstance(what, Ref) else move.guard([move.before(clauses_of(what, domains), domains)], domains)


def _holds_first(what: Union[Ref, Condition], scenario: Scenario, domains: Domains) -> bool:
    """True for a condition that holds at the start."""
    return not isinstance(what, Ref) and holds_at_start(what, scenario, domains)


def _moves(what: Union[Ref, Condition], scenario: Scenario, domains: Domains) -> _Moves:
    """The channels of the moves with which the event happens, or which can change the condition."""
    events = {event.name: event for event in scenario.events}
    found: _Moves = {}
    if isinstance(what, Ref):
        happened = names.has_happened(events[what.name])
        return {happened: happening(happened, scenario, domains)}
    for atom in atoms(what):
        if isinstance(atom, (At, OnWay, Doing)):
            for agent in (agent for agent in scenario.agents if agent.name in domains.among(atom.who)):
                for ref in agent.starts if agent.is_somewhere else ():
                    found[names.starts(agent.name, ref.name)] = placed(agent.name, ref.name)
        if isinstance(atom, (At, OnWay)):
            for agent in (agent for agent in scenario.agents if agent.name in domains.among(atom.who)):
                found.update(_movements(atom, agent.name, scenario.movements(agent)))
        elif isinstance(atom, Holds):
            (state,) = (state for state in scenario.states if state.name == atom.state.name)
            for ref in (*state.true_if, *state.false_if):
                found[names.event(ref.name)] = happening(ref.name, scenario, domains)
            for value in (True, False) if state.is_found_out else ():
                found[names.found(state.name, value)] = found_out(state.name, value)
        elif isinstance(atom, Doing):
            name = atom.event.name
            for channel in (names.event(name), names.done(name), *names.leaves_off(events[name])):
                found[channel] = happening(channel, scenario, domains)
    return found


def _movements(atom: Union[At, OnWay], agent: str, ways: Iterable[Tuple[str, str]]) -> Iterator[Tuple[str, Change]]:
    """The agent's moves that can change whether it is there, or on its way."""
    for a, b in ways:
        if atom.includes(a, b) if isinstance(atom, OnWay) else atom.place.name == a:
            yield names.movement(agent, a, b), setting_off(agent, a, b)
        if atom.includes(a, b) if isinstance(atom, OnWay) else atom.place.name == b:
            yield names.arrival(agent, a, b), arriving(agent, a, b)
