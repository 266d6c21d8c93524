"""Robots that have to stay near their duties: what they cannot begin without leaving duties that no other robot covers.

A person goes to a place and stays there, or all stay where they are. Where the duties that follow (see `duties`) cannot
all be covered while a robot does something, no winning strategy begins that, so a game in which it cannot be begun is
no harder. Nor does another robot begin what must not happen where a robot is that cannot leave its place. What is left
is lost for some robot alone, as in `one_robot`.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import AbstractSet, Dict, FrozenSet, Iterable, Iterator, List, Optional, Sequence, Set, Tuple

from pursue_gen.solving.duties import Duties, Duty, Standing, are_reported, begins, can_be_covered
from pursue_gen.solving.freer import standing as without_walks
from pursue_gen.solving.freer import without_turns
from pursue_gen.solving.lost_promises import watched
from pursue_gen.solving.one_robot import lost_for_one
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.stays import is_reached, standings
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, Edge, Kind, Network, Objective

_Pins = Dict[Tuple[str, Edge], Tuple[Duty, ...]]
"""What robots cannot begin, each with duties that nobody else can cover meanwhile."""


def lost_to_pins(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions, work: Sequence[int]
) -> Tuple[Objective, ...]:
    """Promises, places to be avoided, that are lost because robots have to stay near their duties; () where none are
    found with so much work for all games of one robot, and for one of them."""
    robots = commanded_agents(network)
    if objective.reaches or not are_reported(network, robots):
        return ()
    everywhere = {robot: network.automaton(robot).lasting for robot in robots}
    all_duties = Duties(network, objective.bad, robots)
    tried: Set[FrozenSet[Tuple[str, Edge]]] = set()
    for standing, stay in standings(network):
        duties = all_duties.at(standing)
        if not can_be_covered(duties, everywhere):
            return (_promises(objective, _fewest(duties, everywhere)),)
        pins = _pins(network, duties, everywhere)
        if stay is None:  # else a robot may have gone elsewhere before somebody came
            pins.update(_kept_away(network, objective, duties, everywhere))
        for duty in duties if pins else ():
            doers = [(r, e) for r in robots for e in begins(network.automaton(r), duty.ends)]
            if doers and all(each in pins for each in doers):
                return (_promises(objective, [duty, *(d for each in doers for d in pins[each])]),)
        if pins and frozenset(pins) not in tried:
            tried.add(frozenset(pins))
            game = _game(network, standing, stay, frozenset(pins))
            starts = () if stay is None else (_starts,)
            wanted = objective if stay is None else _promises(objective, (duty for duty in duties if duty.ends))
            lost = lost_for_one(game, wanted, reaction, options, work, *starts)
            if lost:
                heard = {channel for name in watched(lost[0]) for channel in network.automaton(name).channels}
                some = [d for (r, b), found in pins.items() if heard & _ended(network.automaton(r), b) for d in found]
                return (_promises(objective, some, lost[0].bad),)
    return ()


def _game(network: Network, standing: Standing, stay: Optional[Edge], pins: AbstractSet[Tuple[str, Edge]]) -> Network:
    """The network in which people do not walk and robots do not begin what they cannot. Where somebody has come to
    stay, rules are left out, too: nobody knows whose turn it is then."""
    automata = []
    for each in network.automata:
        edges = tuple(edge for edge in each.edges if (each.name, edge) not in pins)
        begun = {edge.target for edge in edges}
        edges = tuple(edge for edge in edges if edge.source in begun or edge.source == each.initial)
        automata.append(replace(each, initial=standing.get(each.name, each.initial), edges=edges))
    game = without_walks(replace(network, automata=tuple(automata), variables=_with(network, stay)))
    return game if stay is None else without_turns(game, ())


def _starts(game: Network, robot: str) -> Iterator[Network]:
    """The games that begin when somebody has come to stay, somebody has called and the robot has just answered: nobody
    waits for anything then. None where more could have changed."""
    automaton = game.automaton(robot)
    watching = [a for a in game.automata if a.name != robot and not is_agent(a)]
    if any(len(a.lasting) != 2 or a.initial in a.stays for a in watching):
        return
    heard = {channel for each in watching for channel in each.channels}
    for end in automaton.edges:
        if end.is_end and end.channel in heard:
            there = replace(automaton, initial=end.target)
            automata = tuple(there if a is automaton else a for a in game.automata)
            yield replace(game, automata=automata, variables=_with(game, end))


def _with(network: Network, edge: Optional[Edge]) -> Tuple[Tuple[str, int], ...]:
    """The variables with the values after an edge."""
    return tuple({**dict(network.variables), **dict(edge.assign if edge is not None else ())}.items())


def _ended(robot: Automaton, begin: Edge) -> AbstractSet[str]:
    """The channels of the ends of what a robot begins."""
    return {edge.sync.channel for edge in robot.edges if edge.source == begin.target and edge.sync is not None}


def _pins(network: Network, duties: Sequence[Duty], everywhere: Dict[str, List[str]]) -> _Pins:
    channels = frozenset(channel for duty in duties for channel in duty.ends)
    found: _Pins = {}
    for robot in everywhere:
        automaton = network.automaton(robot)
        others = {name: places for name, places in everywhere.items() if name != robot}
        for begin in begins(automaton, channels):
            left = [duty for duty in duties if _is_left(duty, automaton, begin)]
            if not can_be_covered(left, others):
                found[robot, begin] = _fewest(left, others)
    return found


def _kept_away(
    network: Network, objective: Objective, duties: Sequence[Duty], everywhere: Dict[str, List[str]]
) -> _Pins:
    """What robots cannot begin because it must not happen while another one is where it can never leave."""
    channels = frozenset(channel for duty in duties for channel in duty.ends)
    found: _Pins = {}
    for robot, duty in product(everywhere, duties):
        automaton = network.automaton(robot)
        values = _values(network, automaton) if _stays(automaton, duty, everywhere) else {}
        for other in (name for name in everywhere if values and name != robot):
            for begin in begins(network.automaton(other), channels - duty.ends):
                known = {**values, **{name: {value} for name, value in begin.assign}}
                for place in objective.bad:
                    if is_reached(network, place, known):
                        found[other, begin] = (duty, Duty(place, 0, {}))
    return found


def _is_left(duty: Duty, robot: Automaton, begin: Edge) -> bool:
    """True if a robot that begins this neither meets the duty by it nor covers the duty meanwhile."""
    return duty.ends.isdisjoint(_ended(robot, begin)) and not duty.covered_from(robot.name, begin.target)


def _stays(robot: Automaton, duty: Duty, everywhere: Dict[str, List[str]]) -> bool:
    """True if nobody else covers the duty, and the robot does not once it has set off from where it begins."""
    others = {name: places for name, places in everywhere.items() if name != robot.name}
    ways = [edge for edge in robot.edges if edge.source == robot.initial and edge.sets_off]
    return not can_be_covered([duty], others) and all(_is_left(duty, robot, edge) for edge in ways)


def _values(network: Network, robot: Automaton) -> Dict[str, Set[int]]:
    """The values of the variables that only a robot sets while it does not leave the place where it begins."""
    found = {name: {value} for name, value in network.variables if network.setters[name] == {robot.name}}
    here = {robot.initial, *(e.target for e in robot.edges if e.source == robot.initial and not e.sets_off)}
    for edge in robot.edges:
        for name, value in edge.assign if {edge.source, edge.target} <= here else ():
            if name in found:
                found[name].add(value)
    return found


def _fewest(duties: Sequence[Duty], robots: Dict[str, List[str]]) -> Tuple[Duty, ...]:
    """Some of these duties that cannot all be covered either; without any one of them the others could."""
    left = tuple(duties)
    for duty in duties:
        fewer = tuple(each for each in left if each is not duty)
        if not can_be_covered(fewer, robots):
            left = fewer
    return left


def _promises(objective: Objective, duties: Iterable[Duty], more: Sequence[Place] = ()) -> Objective:
    wanted = {*more, *(duty.promise for duty in duties)}
    return Objective(Kind.SAFETY, bad=tuple(place for place in objective.bad if place in wanted))
