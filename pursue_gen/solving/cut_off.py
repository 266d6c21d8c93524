"""Promises that are lost where somebody stays in the way: "no robot at the lift while the bed is there".

An agent whom nobody controls goes to a place and stays there for ever. Where a robot must not be with it, it never is
from then on, so in the end each robot goes round among places with ways between them that lead past no such place. A
caller who can ask again and again is answered so often only if all that has to come before the answer can be done so
often, too, by the robots that are there. No times are looked at, and no game is played.
"""

from __future__ import annotations

from itertools import combinations, product
from math import prod
from typing import (
    AbstractSet,
    Collection,
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
)

from pursue_gen.solving.contradictions import excluded_by_a_stay
from pursue_gen.solving.duties import Duties, Duty, Standing
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
    for standing, arrival in standings(network) if robots else ():
        duties = [duty for duty in all_duties.at(standing) if duty.ends]
        for agent, known in _values_of_others(network, standing, arrival) if duties else ():
            closed = _closed(network, objective, known, robots)
            some = _unanswered(network, duties, robots, closed) if closed else ()
            if some:
                promises = {*_needed(network, some, robots, closed), *(duty.promise for duty in some)}
                bad = tuple(place for place in objective.bad if place in promises)
                return LostToAStay(Objective(Kind.SAFETY, bad=bad), agent, standing[agent])
    return None


_Values = Dict[str, AbstractSet[int]]
"""Of some variables the values that they may have."""

_Closed = Mapping[Place, AbstractSet[Tuple[str, str]]]
"""For each place to be avoided the robots, each with a location at which it comes to that."""


def _values_of_others(
    network: Network, standing: Standing, arrival: Optional[Edge]
) -> Iterator[Tuple[str, _Values]]:
    """Each agent that stays where it begins, or the one that an edge has led elsewhere, with the values of the
    variables that only it sets."""
    for name in standing:
        if (arrival is None) == (standing[name] == network.automaton(name).initial):
            now = network.variables if arrival is None else arrival.assign
            yield name, {each: {value} for each, value in now if network.setters[each] == {name}}


def _closed(network: Network, objective: Objective, known: _Values, robots: Sequence[str]) -> _Closed:
    """Where robots must not be while variables of somebody else have these values."""
    found: Dict[Place, Set[Tuple[str, str]]] = {}
    for robot in robots if known else ():
        for location, values in _values(network, network.automaton(robot)).items():
            for place in objective.bad:
                if is_reached(network, place, {**known, **values}) and not is_reached(network, place, known):
                    found.setdefault(place, set()).add((robot, location))
    return found


def _unanswered(
    network: Network, duties: Sequence[Duty], robots: Sequence[str], closed: _Closed
) -> Sequence[Duty]:
    """Duties that robots which are at none of these places cannot meet again and again, one or two where it is no more;
    () where they can meet all."""
    if not _can_be_answered(network, duties, robots, closed):
        for size in (1, 2):
            for some in combinations(duties, size):
                if not _can_be_answered(network, some, robots, closed):
                    return some
        return duties
    return ()


def _values(network: Network, robot: Automaton) -> Dict[str, _Values]:
    """For each location of a robot the values of the variables that only it sets, and sets whenever it comes there."""
    found: Dict[str, _Values] = {}
    for name in robot.assigned:
        if network.setters[name] == {robot.name}:
            for location in robot.locations:
                entering = [dict(edge.assign).get(name) for edge in robot.edges if edge.target == location.name]
                values = {value for value in entering if value is not None}
                if entering and None not in entering:
                    found.setdefault(location.name, {})[name] = values
    return found


def _needed(network: Network, duties: Sequence[Duty], robots: Sequence[str], closed: _Closed) -> List[Place]:
    """Those of the places to be avoided without which the duties could be met."""
    needed = dict(closed)
    for place in closed:
        fewer = {each: where for each, where in needed.items() if each != place}
        if not _can_be_answered(network, duties, robots, fewer):
            needed = fewer
    return list(needed)


def _can_be_answered(network: Network, duties: Sequence[Duty], robots: Sequence[str], closed: _Closed) -> bool:
    """False if robots that are at none of these places cannot meet the duties again and again."""
    gone = frozenset(each for where in closed.values() for each in where)
    rounds = [list(_rounds(network, network.automaton(robot), gone)) for robot in robots]
    if prod(map(len, rounds)) > _MOST:
        return True
    return any(_answers(network, duties, robots, some) for some in product(*rounds))


def _rounds(network: Network, robot: Automaton, gone: FrozenSet[Tuple[str, str]]) -> Iterator[_Round]:
    """What a robot may do again and again among some places; where it is of use anywhere, only where it is."""
    edges = [e for e in robot.edges if not gone.intersection(((robot.name, e.source), (robot.name, e.target)))]
    heard = {channel for each in network.automata if not is_agent(each) for channel in each.channels}
    parts = [[e for e in edges if {e.source, e.target} <= part] for part in _parts(edges)]
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
    return [edge for edge in some if any({edge.source, edge.target} <= part for part in _parts(some))]


def _parts(edges: Collection[Edge]) -> List[Set[str]]:
    """Locations in sets between which the edges lead to and fro (strongly connected components)."""
    led: Dict[str, Set[str]] = {}
    for edge in edges:
        led.setdefault(edge.source, set()).add(edge.target)
    reached = {place: _reached(led, place) for place in led}
    parts = {frozenset(b for b in reached[a] if a in reached.get(b, ())) for a in led}
    return sorted((set(part) for part in parts if part), key=sorted)


def _reached(led: Mapping[str, Set[str]], start: str) -> Set[str]:
    met: Set[str] = set()
    waiting = [start]
    while waiting:
        new = led.get(waiting.pop(), set()) - met
        met |= new
        waiting += new
    return met
