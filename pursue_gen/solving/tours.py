"""Patrols of many places: each robot gets places of its own, and goes round them, over and over.

Who visits what comes from `rounds`. A robot's round is a tour of the strategy (see `tga.tours`), and a share that names
nobody but the robot and its tour: what the robot does next depends on nothing else, and the checker looks at each place
alone (see `proof.apart`). So neither robots nor places multiply.

A robot waits as long as its places allow (see `waits`). A tenth of the period is left in reserve.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import AbstractSet, Dict, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.language.network_names import LOSE
from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.solving.found import Found
from pursue_gen.solving.gaps import part_of_period, repeated, tour_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rounds import Round, least_wait, rounds
from pursue_gen.solving.waits import stays_of
from pursue_gen.solving.walkers import Patrol, Walker, patrol_of
from pursue_gen.synthesis.solve import Stats
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Place, Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.tours import Tour, tour_automaton, with_tours
from pursue_gen.tga.watchers import Watcher, watched_by

PATROL = 4
"""A patrol of so many places is no easy game: tours are looked for first. Not measured."""

RESERVE = Fraction(1, 10)
"""The part of a period that a robot has to spare, where there is as much. Measured on patrols of 12 to 140 places."""


def won_by_tours(network: Network, objective: Objective, reaction: Fraction, options: SolveOptions) -> Optional[Found]:
    """A proven strategy with a tour for each robot, for an objective that asks for patrols alone; None where none is
    found."""
    start = options.limits.now()
    strategy = tours_of(network, objective, reaction)
    return None if strategy is None else proven_tours(network, objective, strategy, reaction, options, start)


def proven_tours(
    network: Network, objective: Objective, strategy: Strategy, reaction: Fraction, options: SolveOptions, start: float
) -> Optional[Found]:
    """The strategy, found by work that began at `start` (of `limits.now`), if it is proven; else None."""
    stats = Stats("tours", len(strategy.blocks), 0, options.limits.now() - start)
    with suppress(NotProven, LimitHit):
        return Found(prove(network, objective, strategy, reaction, options=options.since(start)), stats)
    return None


def tours_of(
    network: Network, objective: Objective, reaction: Fraction, busy: AbstractSet[str] = frozenset()
) -> Optional[Strategy]:
    """The same, not proven yet. Robots that are `busy` have no tours, and may be anywhere."""
    patrol = None if network.start else patrol_of(network, objective, reaction, excused=busy)
    if patrol is None:
        return None
    some = rounds([walker.robot for walker in patrol.walkers], patrol.visits, float(1 - RESERVE))
    if some is None:
        return None
    some = tuple(repeated(walker, patrol, mine, 1 - RESERVE) for walker, mine in zip(patrol.walkers, some))
    if _worst(patrol, some) >= 1:
        return None
    return _strategy(network, patrol, some, busy)


def period_of_tours(network: Network, objective: Objective, reaction: Fraction) -> Optional[int]:
    """A period, in whole time units, that tours keep if it is that of each of the objective's patrols; None where it
    asks for something else, or there are no tours. It is not proven."""
    patrol = patrol_of(network, objective, reaction)
    if patrol is None:
        return None
    visits = tuple(replace(visit, period=1.0) for visit in patrol.visits)
    some = rounds([walker.robot for walker in patrol.walkers], visits)
    if some is None:
        return None
    return math.floor(_worst(replace(patrol, visits=visits), some)) + 1


def least_period_of_patrols(network: Network, objective: Objective, reaction: Fraction) -> int:
    """Nothing below this period, in whole time units, can be promised if it is that of each of the objective's patrols;
    0 where nothing is known."""
    patrol = patrol_of(network, objective, reaction, prompt=True)
    if patrol is None:
        return 0
    wait = least_wait([walker.robot for walker in patrol.walkers], patrol.visits)
    return math.ceil(wait - 1e-6) if wait < float("inf") else 0


def _worst(patrol: Patrol, some: Sequence[Round]) -> Fraction:
    """The longest time that a place waits, as a part of its period."""
    return max(part_of_period(each, patrol, mine) for each, mine in zip(patrol.walkers, some))


def _strategy(
    network: Network, patrol: Patrol, some: Sequence[Round], busy: AbstractSet[str] = frozenset()
) -> Optional[Strategy]:
    """The strategy of these rounds, a share for each robot that has one."""
    tours = [tour_of(walker, patrol, mine) for walker, mine in zip(patrol.walkers, some)]
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
        anybody = [not busy.isdisjoint(duty.visits) for duty in patrol.duties]
        shared = (patrol.duties[k].name for k in dict.fromkeys(mine) if anybody[k] or patrol.visits[k].place in theirs)
        alone = (Watcher(name, (walker.automaton.name,)) for name in shared)
        own = [watcher for watcher in alone if watched_by(network, watcher) is not None]
        kept = (tour.name, *(watcher.name for watcher in own), *(patrol.duties[k].name for k in dict.fromkeys(mine)))
        shares.append(tuple((name, LOSE) for name in kept))
        watchers += own
        stays = stays_of(walker, patrol, tour, mine, 1 - RESERVE)
        blocks += blocks_of(with_tours(network, [tour]), walker, tour, patrol.unit, stays)
    return Strategy(tuple(blocks), shares=tuple(shares), watchers=tuple(watchers), tours=tuple(filter(None, tours)))


class Opening(NamedTuple):
    """Where a robot and its tour are when a plan begins in the middle of a play, and between which values the robot's
    clock may be then."""

    state: DiscreteState
    least: Fraction
    most: Fraction


def blocks_of(
    network: Network,
    walker: Walker,
    tour: Tour,
    unit: Fraction,
    stays: Mapping[int, Fraction],
    opening: Optional[Opening] = None,
) -> Tuple[Block, ...]:
    """What the robot does at each stop, where it stays longer than it has to at these `stays`, and on each way to one:
    nothing there. A command is due for a `unit`, and also where the plan may begin after that.

    The network has the tour.
    """
    automaton, clock, name = network.automaton(tour.name), walker.clock, walker.automaton.name
    blocks: Dict[DiscreteState, Block] = {}  # two stops may lead to one on the same way
    for stop, place in enumerate(tour.stops):
        state, following = state_of(walker, place, tour, stop, network), tour.after(stop)
        if following is None:
            blocks[state] = Block(state, ((),), ())
            continue
        way = walker.ways[place][tour.stops[following]]
        heard = next(e for e in automaton.edges if e.source == tour.at(stop) and e.target == tour.at(following))
        moves = Move(name, way.edge), Move(tour.name, heard)
        blocks[state] = _due(state, clock, way.rest + stays.get(stop, 0), unit, moves, opening)
        under_way = state_of(walker, way.edge.target, tour, following, network)
        blocks[under_way] = Block(under_way, ((),), ())
        if way.end is not None:
            blocks[under_way] = _due(under_way, clock, way.least, unit, (Move(name, way.end),), opening)
    return tuple(blocks.values())


def _due(
    state: DiscreteState,
    clock: str,
    since: Fraction,
    unit: Fraction,
    moves: Tuple[Move, ...],
    opening: Optional[Opening],
) -> Block:
    """What has to be done as soon as the clock is above this time; where a play begins later than that, at once."""
    least, most = (opening.least, opening.most) if opening is not None and opening.state == state else (since, since)
    zones = [_between(clock, since, True, max(since + unit, most) if least <= since + unit else since + unit)]
    if least > since + unit:
        zones.append(_between(clock, least, False, most))
    return Block(state, ((Constraint(clock, None, since, False),),), (Command(tuple(zones), moves),))


def _between(clock: str, low: Fraction, strict: bool, high: Fraction) -> Tuple[Constraint, ...]:
    return Constraint(None, clock, -low, strict), Constraint(clock, None, high, False)


def state_of(walker: Walker, location: str, tour: Tour, stop: int, network: Network) -> DiscreteState:
    """Where the robot and its tour are, and the variables that tell where the robot is."""
    entered = [edge for edge in walker.automaton.edges if edge.target == location != edge.source]
    told = {name: value for edge in entered for name, value in edge.assign}
    own = {name for edge in walker.automaton.edges for name, _ in edge.assign}
    values = tuple((name, told.get(name, value)) for name, value in network.variables if name in own)
    return DiscreteState(((walker.automaton.name, location), (tour.name, tour.at(stop))), values)
