"""Patrols of many places: each robot gets places of its own, and goes round them, over and over.

Who visits what comes from `rounds`. A robot's round is a tour of the strategy (see `tga.tours`), and a share that names
nobody but the robot and its tour: what the robot does next depends on nothing else, and the checker looks at each place
alone (see `proof.apart`). So neither robots nor places multiply.

A robot waits as long as its places allow before it sets off, and where it has been at all of them: so it goes round
once in each period. A tenth of the period is left in reserve.
"""

from __future__ import annotations

import heapq
import math
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.language.network_names import LOSE
from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.solving.due_moves import Duty, duties, patrols
from pursue_gen.solving.found import Found
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rounds import Robot, Round, Visit, cost, least_wait, rounds
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.solve import Stats
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Place, Strategy
from pursue_gen.tga.network import Automaton, Edge, Guard, Kind, Network, Objective
from pursue_gen.tga.scale import common_denominator, least_common_multiple
from pursue_gen.tga.tours import Tour, tour_automaton, ways_of, with_tours
from pursue_gen.tga.watchers import Watcher, watched_by

PATROL = 6
"""A patrol of so many places is no easy game: tours are looked for first."""

_RESERVE = Fraction(1, 10)
"""The part of a period that a robot has to spare, where there is as much."""


_UNITS = 10
"""A command is due within a tenth of a time unit, or less: behind a strict bound there is no first instant."""


@dataclass(frozen=True)
class _Way:
    """A movement that can be commanded: its edge, the rest before it, how long it lasts at least and at most, and the
    edge of its end where that is commanded, too."""

    edge: Edge
    rest: Fraction
    least: Fraction
    lasts: Fraction
    end: Optional[Edge]


@dataclass(frozen=True)
class _Walker:
    """A robot: its ways by place and next place, and as `rounds` knows it; of each way around where it leads next."""

    automaton: Automaton
    clock: str
    ways: Mapping[str, Mapping[str, _Way]]
    robot: Robot
    following: Mapping[Tuple[str, str], str]

    def stops(self, places: Sequence[str]) -> List[str]:
        """All places on the way from one of these to the next, without the first of them."""
        found: List[str] = []
        for a, b in zip(places, places[1:]):
            while a != b:
                a = self.following[a, b]
                found.append(a)
        return found


@dataclass(frozen=True)
class _Patrol:
    """What tours are to keep: who walks them, the duties, and as `rounds` has these; for how long a command is due."""

    walkers: Tuple[_Walker, ...]
    duties: Tuple[Duty, ...]
    visits: Tuple[Visit, ...]
    unit: Fraction


def won_by_tours(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Optional[Found]:
    """A proven strategy with a tour for each robot, for an objective that asks for patrols alone; None where none is
    found."""
    start = options.limits.now()
    patrol = _patrol(network, objective, reaction)
    some = None if patrol is None else rounds(
        [walker.robot for walker in patrol.walkers], patrol.visits, float(1 - _RESERVE)
    )
    if patrol is None or some is None or _worst(patrol, some) >= 1:
        return None
    strategy = _strategy(network, patrol, some)
    if strategy is None:
        return None
    seconds = options.limits.now() - start
    with suppress(NotProven, LimitHit):
        proven = prove(network, objective, strategy, reaction, options=options.since(start))
        return Found(proven, Stats("tours", len(strategy.blocks), 0, seconds, 0, 0))
    return None


def period_of_tours(network: Network, objective: Objective, reaction: Fraction) -> Optional[int]:
    """A period, in whole time units, that tours keep if it is that of each of the objective's patrols; None where it
    asks for something else, or there are no tours. It is not proven."""
    patrol = _patrol(network, objective, reaction)
    if patrol is None:
        return None
    visits = tuple(replace(visit, period=1.0) for visit in patrol.visits)
    some = rounds([walker.robot for walker in patrol.walkers], visits)
    if some is None:
        return None
    return math.floor(_worst(replace(patrol, visits=visits), some) + 1e-6) + 1


def least_period_of_patrols(network: Network, objective: Objective, reaction: Fraction) -> int:
    """Nothing below this period, in whole time units, can be promised if it is that of each of the objective's patrols;
    0 where nothing is known."""
    patrol = _patrol(network, objective, reaction, prompt=True)
    if patrol is None:
        return 0
    wait = least_wait([walker.robot for walker in patrol.walkers], patrol.visits)
    return math.ceil(wait - 1e-6) if wait < float("inf") else 0


def _worst(patrol: _Patrol, some: Sequence[Round]) -> float:
    """The longest time that a place waits, as a part of its period."""
    return max(cost(each.robot, patrol.visits, mine).part for each, mine in zip(patrol.walkers, some))


def _patrol(network: Network, objective: Objective, reaction: Fraction, prompt: bool = False) -> Optional[_Patrol]:
    """The patrol that an objective asks for; None where it asks for something else, or a robot does not move as it is
    told, at any time. `prompt`: commands are given at the first instant."""
    bad = dict.fromkeys(name for name, _ in objective.bad)
    known = duties(network, objective, patrols(network)) if objective.kind is Kind.SAFETY else ()
    if not known or network.start or len(known) != len(bad) or any(place != LOSE for _, place in objective.bad):
        return None
    if any(len(places) != 1 for duty in known for places in duty.visits.values()) or _in_order(network, known):
        return None
    unit = Fraction(1, least_common_multiple((_UNITS, common_denominator([reaction, *network.times]))))
    late = reaction if prompt else reaction + unit
    robots = [network.automaton(name) for name in commanded_agents(network)]
    walkers = [_walker(robot, late) for robot in robots]
    able = [walker for walker in walkers if walker is not None]
    if len(able) < len(walkers) or not able:
        return None
    visits: List[Visit] = []
    for duty in known:
        where = {k: duty.visits[each.automaton.name][0] for k, each in enumerate(able)
                 if each.automaton.name in duty.visits}  # fmt: skip
        if len(set(where.values())) != 1:
            return None
        visits.append(Visit(next(iter(where.values())), frozenset(where), float(duty.deadline)))
    return _Patrol(tuple(able), known, tuple(visits), unit)


def _in_order(network: Network, known: Sequence[Duty]) -> bool:
    """True if a visit counts at some times only."""
    automata = (network.automaton(duty.name) for duty in known)
    return any(edge.assign for automaton in automata for edge in automaton.edges)


def _walker(robot: Automaton, late: Fraction) -> Optional[_Walker]:
    """The robot with the ways that depend on nothing but its rest; None where there are none, or it starts on one."""
    clocks = {bound.clock for place in robot.locations for bound in place.invariant}
    if len(clocks) != 1:
        return None
    bounds = {place.name: place.invariant for place in robot.locations}
    (clock,) = clocks
    ways: Dict[str, Dict[str, _Way]] = {}
    for place, led in ways_of(robot).items():
        for following, edge in led.items():
            ends = [other for other in robot.edges if other.source == edge.target and other.target == following]
            if any(each.guard.integers or clock not in each.resets for each in (edge, *ends)):
                continue
            if len(ends) != 1 or len(bounds[edge.target]) != 1:
                continue
            rest, least = (_since(each.guard, clock) for each in (edge, *ends))
            end = ends[0] if ends[0].controllable else None
            lasts = Fraction(bounds[edge.target][0].bound) if end is None else least + late
            ways.setdefault(place, {})[following] = _Way(edge, rest, least, lasts, end)
    if not ways or bounds[robot.initial]:
        return None
    steps = {a: {b: float(way.rest + late + way.lasts) for b, way in led.items()} for a, led in ways.items()}
    times, following_of = _all_ways(steps)
    stay = min(way.rest for led in ways.values() for way in led.values()) + late
    return _Walker(robot, clock, ways, Robot(robot.initial, times, float(stay)), following_of)


def _since(guard: Guard, clock: str) -> Fraction:
    """From when on a guard holds."""
    bounds = (Fraction(bound.bound) for bound in guard.clocks if bound.clock == clock and bound.op in (">", ">="))
    return max(bounds, default=Fraction(0))


def _all_ways(
    steps: Mapping[str, Mapping[str, float]]
) -> Tuple[Dict[str, Dict[str, float]], Dict[Tuple[str, str], str]]:
    """How long it takes from each place to each other one (Dijkstra), and where one goes first."""
    times: Dict[str, Dict[str, float]] = {}
    following: Dict[Tuple[str, str], str] = {}
    for start in steps:
        known: Dict[str, float] = {}
        queue: List[Tuple[float, str, str]] = [(0.0, start, "")]
        while queue:
            time, place, first = heapq.heappop(queue)
            if place in known:
                continue
            known[place] = time
            following[start, place] = first
            for other, step in steps.get(place, {}).items():
                if other not in known:
                    heapq.heappush(queue, (time + step, other, first or other))
        times[start] = known
    return times, following


def _strategy(network: Network, patrol: _Patrol, some: Sequence[Round]) -> Optional[Strategy]:
    """The strategy of these rounds, a share for each robot that has one."""
    tours = [_tour(walker, patrol, mine) for walker, mine in zip(patrol.walkers, some)]
    met = [set(tour.stops) if tour is not None else {walker.automaton.initial}
           for walker, tour in zip(patrol.walkers, tours)]  # fmt: skip
    blocks: List[Block] = []
    shares: List[Tuple[Place, ...]] = []
    watchers: List[Watcher] = []
    for number, (walker, tour, mine) in enumerate(zip(patrol.walkers, tours, some)):
        if tour is None:
            continue
        if tour_automaton(network, tour) is None:
            return None
        theirs: Set[str] = set().union(*(places for other, places in enumerate(met) if other != number))
        shared = (patrol.duties[k].name for k in mine if patrol.visits[k].place in theirs)
        alone = (Watcher(name, (walker.automaton.name,)) for name in shared)
        own = [watcher for watcher in alone if watched_by(network, watcher) is not None]
        kept = (tour.name, *(watcher.name for watcher in own), *(patrol.duties[k].name for k in mine))
        shares.append(tuple((name, LOSE) for name in kept))
        watchers += own
        at_stops = _blocks(with_tours(network, [tour]), walker, tour, patrol, mine)
        blocks += {block.state: block for block in at_stops}.values()  # two stops may lead to one on the same way
    return Strategy(tuple(blocks), shares=tuple(shares), watchers=tuple(watchers), tours=tuple(filter(None, tours)))


def _tour(walker: _Walker, patrol: _Patrol, mine: Round) -> Optional[Tour]:
    """The tour of a round; None for a robot that has none.

    It ends its way around where the last visit is: there it has been everywhere.
    """
    if not mine:
        return None
    places = [patrol.visits[k].place for k in mine]
    start = walker.automaton.initial
    stops = [start, *walker.stops([start, *places])]
    back = walker.stops([places[-1], places[0]])
    if not back:
        return Tour(walker.automaton.name, tuple(stops), len(stops))
    if places[0] == start:  # where it waits at first it does not in each round
        return Tour(walker.automaton.name, (*stops, *back), 1)
    return Tour(walker.automaton.name, (*stops, *back[:-1]), len(walker.stops([start, places[0]])))


def _pauses(walker: _Walker, patrol: _Patrol, mine: Round) -> Tuple[Fraction, Fraction]:
    """How much longer than they have to robots stay at first, and where they have been everywhere, in whole units."""
    some = cost(walker.robot, patrol.visits, mine)
    period = min(Fraction(patrol.duties[k].deadline) for k in mine) * (1 - _RESERVE)
    waits = (Fraction(takes).limit_denominator(1000) for takes in (some.first, some.length - walker.robot.stay))
    first, later = (max(Fraction(0), (period - takes) // patrol.unit * patrol.unit) for takes in waits)
    return first, later


def _blocks(network: Network, walker: _Walker, tour: Tour, patrol: _Patrol, mine: Round) -> Iterator[Block]:
    """What the robot does at each stop, and on each way to one: nothing there."""
    automaton, clock, name = network.automaton(tour.name), walker.clock, walker.automaton.name
    last = len(walker.stops([tour.stops[0], *(patrol.visits[k].place for k in mine)]))
    first, later = _pauses(walker, patrol, mine)
    for stop, place in enumerate(tour.stops):
        state, following = _state(walker, place, tour, stop, network), tour.after(stop)
        if following is None:
            yield Block(state, ((),), ())
            continue
        way = walker.ways[place][tour.stops[following]]
        rest = way.rest + (later if stop == last else 0 if stop else first)
        heard = next(e for e in automaton.edges if e.source == tour.at(stop) and e.target == tour.at(following))
        yield _due(state, clock, rest, patrol.unit, Move(name, way.edge), Move(tour.name, heard))
        under_way = _state(walker, way.edge.target, tour, following, network)
        end = way.end
        yield Block(under_way, ((),), ()) if end is None else _due(
            under_way, clock, way.least, patrol.unit, Move(name, end)
        )


def _due(state: DiscreteState, clock: str, since: Fraction, unit: Fraction, *moves: Move) -> Block:
    """What has to be done as soon as the clock is above this time."""
    zone = Constraint(None, clock, -since, True), Constraint(clock, None, since + unit, False)
    return Block(state, ((Constraint(clock, None, since, False),),), (Command((zone,), moves),))


def _state(walker: _Walker, location: str, tour: Tour, stop: int, network: Network) -> DiscreteState:
    """Where the robot and its tour are, and the variables that tell where the robot is."""
    entered = [edge for edge in walker.automaton.edges if edge.target == location != edge.source]
    told = {name: value for edge in entered for name, value in edge.assign}
    own = {name for edge in walker.automaton.edges for name, _ in edge.assign}
    values = tuple((name, told.get(name, value)) for name, value in network.variables if name in own)
    return DiscreteState(((walker.automaton.name, location), (tour.name, tour.at(stop))), values)
