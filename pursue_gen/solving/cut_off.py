"""Promises that are lost where somebody stays in the way: "no robot at the lift while the bed is there".

An agent whom nobody controls goes to a place and stays there for ever. Where a robot must not be with it, it never is
from then on. Nor does the robot set off for a place where the agent may be before the robot can have left it again. So
in the end each robot goes round among places with ways between them that lead past no such place. A caller who can ask
again and again is answered so often only if all that has to come before the answer can be done so often, too, by the
robots that are there. No game is played.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import (
    AbstractSet,
    Dict,
    FrozenSet,
    Iterable,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    Set,
    Tuple,
    Union,
)

from pursue_gen.language.numbers import Number
from pursue_gen.solving import due_moves
from pursue_gen.solving.components import components
from pursue_gen.solving.contradictions import excluded_by_a_stay
from pursue_gen.solving.distances import distances_to
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.duties import Duties, Duty, is_free
from pursue_gen.solving.stays import LostToAStay, is_reached, standings
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, Edge, Kind, Network, Objective

_MOST = 256
"""So many ways to be cut off are looked at: of each robot the places among which it goes round. Not measured."""

_Round = List[Edge]
"""What a robot may do again and again."""


def lost_to_a_stay(network: Network, objective: Objective) -> Optional[LostToAStay]:
    """Promises that cannot all be kept where somebody stays, as far as that is seen without a game; None where none
    are found."""
    return excluded_by_a_stay(network, objective) or cut_off_by_a_stay(network, objective)


def cut_off_by_a_stay(network: Network, objective: Objective) -> Optional[LostToAStay]:
    """Promises, places to be avoided, that cannot all be kept as somebody who stays cuts robots off; None where none
    are found."""
    robots = commanded_agents(network)
    all_duties = Duties(network, () if objective.reaches else objective.bad, robots)
    visited = () if objective.reaches else due_moves.duties(network, objective, patrols(network))
    meetings: Dict[str, Sequence[_Meeting]] = {}
    pasts = {name: _pasts(network.automaton(name)) for name in robots}
    for comes, (standing, arrival) in product((False, True), list(standings(network)) if robots else ()):
        duties = [duty for duty in all_duties.at(standing) if duty.ends]
        for name, at in standing.items() if duties or visited else ():
            agent = network.automaton(name)
            if (arrival is None) != (at == agent.initial):
                continue
            if name not in meetings:
                meetings[name] = tuple(_meetings(network, objective, agent, robots))
            closed = _closed(network, agent, at, meetings[name], comes, pasts)
            some = _unanswered(network, duties, robots, closed) if closed else ()
            promises = {*_needed(network, some, robots, closed), *(duty.promise for duty in some)} if some else set()
            promises = promises or next(_unvisited(network, objective, visited, closed), set())
            if promises:
                bad = tuple(place for place in objective.bad if place in promises)
                return LostToAStay(Objective(Kind.SAFETY, bad=bad), name, at, comes)
    return None


@dataclass(frozen=True)
class _Meeting:
    """Where a robot and an agent whom nobody controls must not be together: the location of each."""

    promise: Place
    robot: str
    location: str
    other: str


_Pasts = Mapping[str, Mapping[Edge, Number]]
"""For each location the edges on the way to it, with how long it may take from each on until a robot can leave it."""

_Closed = Mapping[Place, AbstractSet[Tuple[str, Edge]]]
"""For each place to be avoided the robots, each with an edge that it cannot take because of it."""


def _meetings(network: Network, objective: Objective, agent: Automaton, robots: Sequence[str]) -> Iterator[_Meeting]:
    """Where the agent must not be together with a robot."""
    others = _values(network, agent)
    for place in objective.bad:
        asked = {name for e in network.automaton(place[0]).edges if e.target == place[1] for name in e.tested}
        matters = [network.automaton(r) for r in robots] if asked.intersection(agent.assigned) else ()
        for robot in (each for each in matters if asked.intersection(each.assigned)):
            own = _values(network, robot)
            for (other, known), (location, values) in product(others.items(), own.items()):
                if is_reached(network, place, {**known, **values}) and not is_reached(network, place, known):
                    yield _Meeting(place, robot.name, location, other)


def _values(network: Network, agent: Automaton) -> Dict[str, Mapping[str, AbstractSet[int]]]:
    """For each location of an agent the values of the variables that only it sets, and sets whenever it comes there."""
    found: Dict[str, Dict[str, AbstractSet[int]]] = {}
    for name, initial in network.variables:
        for location in agent.locations if network.setters[name] == {agent.name} else ():
            coming = [(edge.source, dict(edge.assign)) for edge in agent.edges if edge.target == location.name]
            entering = [some.get(name) for source, some in coming if source != location.name or name in some]
            entering += [initial] if location.name == agent.initial else []
            values = {value for value in entering if value is not None}
            if entering and None not in entering:
                found.setdefault(location.name, {})[name] = values
    return {**found}


def _closed(
    network: Network, agent: Automaton, at: str, meetings: Sequence[_Meeting], comes: bool, pasts: Mapping[str, _Pasts]
) -> _Closed:
    """What robots cannot do any more while the agent stays there; `comes`: until one of them is too near."""
    found: Dict[Place, Set[Tuple[str, Edge]]] = {}
    soonest: Dict[str, Union[Number, float]] = {}
    kept_at = {edge.target for edge in agent.edges if edge.source == at and edge.received is not None} - {at}
    for each in meetings:
        robot = network.automaton(each.robot)
        if each.other == at and not all(replace(each, other=busy) in meetings for busy in kept_at):
            edges = []  # not while it takes part in what others do
        elif each.other == at:
            edges = [edge for edge in robot.edges if each.location in (edge.source, edge.target)]
        else:
            if each.other not in soonest:
                soonest[each.other] = _soonest(agent, at, each.other) if comes else math.inf
            past = pasts[each.robot].get(each.location, {})
            edges = [edge for edge, takes in past.items() if soonest[each.other] < takes]
            if edges and _keeps_out(agent, at, each, robot, past):
                edges = [edge for edge in robot.edges if each.location in (edge.source, edge.target)]
        found.setdefault(each.promise, set()).update((each.robot, edge) for edge in edges)
    return {promise: edges for promise, edges in found.items() if edges}


def _keeps_out(
    agent: Automaton, at: str, each: _Meeting, robot: Automaton, past: Mapping[Edge, Number]
) -> bool:
    """True if the robot is not where it must not meet the agent once that has been there, and has come from there:
    it would be back before a robot is gone that sets off for it meanwhile. (Where a robot sets off at its arrival,
    before it has rested, it stays.)"""
    there = 0 if each.other == agent.initial else _soonest(agent, agent.initial, each.other)
    back = _soonest(agent, each.other, at) + _rest(agent, at) + _soonest(agent, at, each.other)
    stays = agent.longest.get(each.other, math.inf) - _rest(agent, each.other)
    ends = {end.source for end in robot.edges if end.target == each.location and end.source in robot.stays}
    times = [past.get(e, 0) for e in robot.edges if e.target in ends and e.source != each.location]
    return there < math.inf and all(back < time <= stays for time in times)


def _rest(agent: Automaton, place: str) -> Number:
    """How long an agent rests at a place at most before it may do anything there."""
    return max((edge.guard.since for edge in agent.edges if edge.source == place), default=0)


def _soonest(agent: Automaton, start: str, goal: str) -> Union[Number, float]:
    """How long an agent takes at least from one location to another, where nobody can keep it, not even by something
    that both take part in. It has rested, unless it may have asked for something there just before."""
    back: Dict[str, List[Tuple[str, Number]]] = {}
    for edge in filter(is_free, agent.edges):
        back.setdefault(edge.target, []).append((edge.source, edge.guard.since))
    far = distances_to([goal], back)
    own = [edge for edge in agent.edges if edge.source == start]
    if any(edge.received is not None for edge in own):
        return math.inf
    asks = any(edge.sent is not None and not edge.sets_off for edge in own)
    led = [edge for edge in own if is_free(edge) and edge.target in far]
    return min((far[edge.target] + (edge.guard.since if asks else 0) for edge in led), default=math.inf)


def _pasts(robot: Automaton) -> _Pasts:
    """For each location the edges that begin a movement or an action that ends there and nowhere else, with how long it
    may take from each on until the robot can leave the location."""
    leaving: Dict[str, List[Edge]] = {}
    for edge in robot.edges:
        leaving.setdefault(edge.source, []).append(edge)
    found: Dict[str, Dict[Edge, Number]] = {}
    for edge in robot.edges:
        ends = leaving.get(edge.target, []) if edge.target in robot.stays and edge.source != edge.target else []
        if len({end.target for end in ends}) == 1:
            location, lasts = ends[0].target, robot.longest[edge.target]
            arrival = min(end.guard.since if end.controllable else lasts for end in ends)
            rest = min((each.guard.since for each in leaving.get(location, ())), default=0)
            found.setdefault(location, {})[edge] = arrival + rest
    return found


def _unanswered(network: Network, duties: Sequence[Duty], robots: Sequence[str], closed: _Closed) -> Sequence[Duty]:
    """Duties that robots which do none of this cannot meet again and again, one or two where it is no more;
    () where they can meet all."""
    if not _can_be_answered(network, duties, robots, closed):
        for size in (1, 2):
            for some in combinations(duties, size):
                if not _can_be_answered(network, some, robots, closed):
                    return some
        return duties
    return ()


def _unvisited(
    network: Network, objective: Objective, visited: Sequence[due_moves.Duty], closed: _Closed
) -> Iterator[Set[Place]]:
    """Patrols of places where none of their robots can be any more, each with what keeps these away."""
    for patrol in visited:
        edges = {
            (name, edge)
            for name, places in patrol.visits.items()
            for edge in network.automaton(name).edges
            if not {edge.source, edge.target}.isdisjoint(places)
        }
        if edges and all(any(each in some for some in closed.values()) for each in edges):
            needed = {promise for promise, some in closed.items() if not edges.isdisjoint(some)}
            yield needed | {place for place in objective.bad if place[0] == patrol.name}


def _needed(network: Network, duties: Sequence[Duty], robots: Sequence[str], closed: _Closed) -> List[Place]:
    """Those of the places to be avoided without which the duties could be met."""
    needed = dict(closed)
    for place in closed:
        fewer = {each: where for each, where in needed.items() if each != place}
        if not _can_be_answered(network, duties, robots, fewer):
            needed = fewer
    return list(needed)


def _can_be_answered(network: Network, duties: Sequence[Duty], robots: Sequence[str], closed: _Closed) -> bool:
    """False if robots that do none of this cannot meet the duties again and again."""
    gone = {each for edges in closed.values() for each in edges}
    rounds = [list(_rounds(network, network.automaton(robot), gone)) for robot in robots]
    if math.prod(map(len, rounds)) > _MOST:
        return True
    return any(_answers(network, duties, robots, some) for some in product(*rounds))


def _rounds(network: Network, robot: Automaton, gone: AbstractSet[Tuple[str, Edge]]) -> Iterator[_Round]:
    """What a robot may do again and again among some places; where it is of use anywhere, only where it is."""
    edges = [edge for edge in robot.edges if (robot.name, edge) not in gone]
    heard = {channel for each in network.automata if not is_agent(each) for channel in each.channels}
    places = components((edge.source, edge.target) for edge in edges)
    parts = [[e for e in edges if e.source in part and e.target in part] for part in places]
    useful = [part for part in parts if any(edge.channel in heard for edge in part)]
    yield from useful or [[]]


def _answers(network: Network, duties: Sequence[Duty], robots: Sequence[str], rounds: Sequence[_Round]) -> bool:
    """True if the duties may be met again and again where robots do no more than this.

    What can be done so often is what is left when all is taken away that cannot, as what has to come before it cannot.
    """
    doing = dict(zip(robots, rounds))
    others = {e.channel or "" for name, e in network.edges if name not in doing and e.received is None}
    kept: Optional[FrozenSet[str]] = None
    while True:
        now = frozenset(others | {edge.channel or "" for edges in doing.values() for edge in edges})
        if any(now.isdisjoint(duty.ends) for duty in duties):
            return False
        if now == kept:
            return True
        kept = now
        sent = {
            channel: [e for edges in doing.values() for e in edges if e.channel == channel] for channel in now - others
        }
        lasting = others | {each for each, edges in sent.items() if _comes_again(network, each, edges, now)}
        doing = {robot: _in_rounds(edges, lasting | {""}) for robot, edges in doing.items()}


def _comes_again(network: Network, channel: str, sent: Sequence[Edge], kept: AbstractSet[str]) -> bool:
    """False if some rule lets robots send on a channel so often only if others are sent on that are not."""
    for rule in network.automata:
        if is_agent(rule) or len(rule.assigned) != 1 or network.setters[rule.assigned[0]] != {rule.name}:
            continue
        values = _states(network, rule)
        asked = [
            [{t.value for t in c} for c in e.guard.integers if {t.variable for t in c} == {*rule.assigned}]
            for e in sent
        ]
        if not all(asked) or any(len(some) != 1 for some in values.values()):
            continue
        allowed = set().union(*(set.intersection(*clauses) for clauses in asked))
        at = {state for state, some in values.items() if some <= allowed}
        hearing = [e for e in rule.edges if e.source in at and e.received == channel]
        if {e.source for e in hearing if not e.guard.integers and not e.guard.clocks} != at:
            continue  # it may not notice
        again = _in_rounds(rule.edges, kept | {""})
        if not any(edge in again for edge in hearing):
            return False
    return True


def _states(network: Network, rule: Automaton) -> Dict[str, Set[int]]:
    """The values of a rule's variable in each of its locations."""
    (name,) = rule.assigned
    found: Dict[str, Set[int]] = {rule.initial: {dict(network.variables)[name]}}
    for edge in rule.edges:
        found.setdefault(edge.target, set()).add(dict(edge.assign).get(name, -1))
    return found


def _in_rounds(edges: Iterable[Edge], channels: AbstractSet[str]) -> List[Edge]:
    """Those of the edges on these channels after which what comes before them can come again."""
    some = [edge for edge in edges if (edge.channel or "") in channels]
    places = components((edge.source, edge.target) for edge in some)
    part = {place: number for number, part in enumerate(places) for place in part}
    return [edge for edge in some if edge.source in part and part[edge.source] == part.get(edge.target)]
