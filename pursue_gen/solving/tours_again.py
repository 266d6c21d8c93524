"""Patrols in the middle of a play: robots go on with their tours from where they are, while deadlines are running.

The network has the strategy's own automata (tours, and watchers), in the locations in which they are. Each place has to
be visited in what is left of its time; from then on the tour keeps it as before. So a robot stays where it has been
everywhere as long as the places allow that come behind it on its first way around, too.

When a plan comes into force is not known to the moment: what is proven holds from whenever that may be.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import AbstractSet, Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.language.network_names import AT_RISK, LOSE
from pursue_gen.solving.due_moves import Duty
from pursue_gen.solving.gaps import onward
from pursue_gen.solving.rounds import is_too_late, least_wait
from pursue_gen.solving.tours import RESERVE, Opening, blocks_of, state_of
from pursue_gen.solving.walkers import Patrol, Walker, patrol_of
from pursue_gen.synthesis.strategy import Block, Place, Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.tours import Tour
from pursue_gen.tga.watchers import Watcher


@dataclass(frozen=True)
class Now:
    """The clocks when a plan begins as it is to, and how much later, in time units, it may come into force."""

    clocks: Mapping[str, Fraction]
    late: Fraction


@dataclass(frozen=True)
class _Round:
    """A robot with its tour, the stop at which it is or to which it is on its way, what it is to keep: with a watcher,
    by that."""

    walker: Walker
    tour: Tour
    stop: int
    duties: Tuple[Duty, ...]
    watchers: Tuple[Watcher, ...]


def going_on(
    network: Network, objective: Objective, reaction: Fraction, own: Strategy, now: Now, excused: AbstractSet[str]
) -> Optional[Strategy]:
    """A strategy by which robots go on with their tours, for an objective that asks for patrols alone, not proven yet;
    None where that does not keep them any more, or a robot that is `excused` is needed.

    The network has the automata of `own` (its tours and watchers), and may start whenever the plan may begin.
    """
    patrol = patrol_of(network, objective, reaction, excused=excused)
    rounds = None if patrol is None else _rounds(network, patrol, own)
    if patrol is None or rounds is None:
        return None
    blocks: List[Block] = []
    shares: List[Tuple[Place, ...]] = []
    for some in rounds:
        stays = _stays(network, patrol, some, reaction, now)
        if stays is None:
            return None
        place = network.automaton(some.tour.robot).initial
        opening = Opening(state_of(some.walker, place, some.tour, some.stop, network), *_between(network, some.walker))
        blocks += blocks_of(network, some.walker, some.tour, patrol.unit, stays, opening)
        kept = (some.tour.name, *(w.name for w in some.watchers), *(duty.name for duty in some.duties))
        shares.append(tuple((name, LOSE) for name in kept))
    watchers = tuple(watcher for some in rounds for watcher in some.watchers)
    return Strategy(tuple(blocks), shares=tuple(shares), watchers=watchers, tours=tuple(r.tour for r in rounds))


def _between(network: Network, walker: Walker) -> Tuple[Fraction, Fraction]:
    """Between which values the clock of a robot is when the plan begins."""
    least = max((-each.bound for each in network.start if (each.left, each.right) == (None, walker.clock)), default=0)
    most = min(each.bound for each in network.start if (each.left, each.right) == (walker.clock, None))
    return Fraction(least), most


def is_too_much(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    clocks: Mapping[str, Fraction],
    excused: AbstractSet[str],
) -> bool:
    """True if it is known that the robots that are not `excused` cannot keep the patrols that are asked for from here,
    with these `clocks`."""
    patrol = patrol_of(network, objective, reaction, prompt=True, excused=excused)
    if patrol is None:
        return False
    robots = [walker.robot for walker in patrol.walkers]
    left = [
        float(duty.deadline - clocks[duty.clock]) if network.automaton(duty.name).initial == AT_RISK else float("inf")
        for duty in patrol.duties
    ]
    if is_too_late(robots, patrol.visits, [_first(walker, reaction) for walker in patrol.walkers], left):
        return True
    return least_wait(robots, patrol.visits) > min(visit.period for visit in patrol.visits)


def _first(walker: Walker, reaction: Fraction) -> Dict[str, float]:
    """How long a robot takes at least to each place from where it is: it may have rested, or be about to arrive."""
    here, ways = walker.automaton.initial, [way for led in walker.ways.values() for way in led.values()]
    target = (b for led in walker.ways.values() for b, way in led.items() if way.edge.target == here)
    start, rest = next(target, here), float(max(way.rest for way in ways) + reaction)
    return {place: max(0.0, time - rest) for place, time in walker.robot.times.get(start, {}).items()}


def _rounds(network: Network, patrol: Patrol, own: Strategy) -> Optional[Tuple[_Round, ...]]:
    """The robots that have tours; None where one is off its tour, or a place is on no tour."""
    walkers = {walker.automaton.name: walker for walker in patrol.walkers}
    tours = {tour.robot: tour for tour in own.tours}
    stops = {robot: _stop(network, walkers.get(robot), tour) for robot, tour in tours.items()}
    kept: Dict[str, List[Duty]] = {robot: [] for robot in tours}
    for duty, visit in zip(patrol.duties, patrol.visits):
        watching = {robot for watcher in own.watchers if watcher.objective == duty.name for robot in watcher.team}
        able = [robot for robot in tours if robot in duty.visits and visit.place in tours[robot].stops]
        robot = next((robot for robot in sorted(able, key=lambda each: each not in watching)), None)
        if robot is None or stops[robot] is None:
            return None
        kept[robot].append(duty)
    found: List[_Round] = []
    for robot, some in kept.items():
        stop = stops[robot]
        names = {duty.name for duty in some}
        watchers = tuple(w for w in own.watchers if w.team == (robot,) and w.objective in names)
        if some and stop is not None:
            found.append(_Round(walkers[robot], tours[robot], stop, tuple(some), watchers))
    return tuple(found)


def _stop(network: Network, walker: Optional[Walker], tour: Tour) -> Optional[int]:
    """The stop of its tour at which a robot is, or to which it is on its way; None where it is elsewhere, or its tour
    cannot be gone on with."""
    here = network.automaton(tour.name).initial
    stop = next((stop for stop in range(len(tour.stops)) if tour.at(stop) == here), None)
    if walker is None or stop is None:
        return None
    following = ((place, tour.after(k)) for k, place in enumerate(tour.stops))
    steps = [(place, tour.stops[k]) for place, k in following if k is not None]
    if any(b not in walker.ways.get(a, {}) for a, b in steps):
        return None
    under_way = {walker.ways[a][b].edge.target for a, b in steps if b == tour.stops[stop]}
    return stop if walker.automaton.initial in {tour.stops[stop], *under_way} else None


def _stays(
    network: Network, patrol: Patrol, some: _Round, reaction: Fraction, now: Now
) -> Optional[Mapping[int, Fraction]]:
    """How much longer than it has to the robot stays at the stop after which it has been everywhere; None where it is
    too late for a place even if it never stays longer."""
    tour, places = some.tour, [duty.visits[some.tour.robot][0] for duty in some.duties]
    everywhere = max(tour.stops.index(place) for place in places)
    course, again = _course(network, some, patrol.late, now), list(onward(some.walker, tour, tour.again, patrol.late))
    room: List[Fraction] = []
    for duty, place in zip(some.duties, places):
        room.append(Fraction(duty.deadline) * (1 - RESERVE) - _longest_gap(tour, again, place))
        name, clock = _kept_by(some, duty)
        if network.automaton(name).initial != AT_RISK:
            continue
        left = Fraction(duty.deadline) - now.clocks[clock] - patrol.unit
        visit = next((n for n, (stop, _) in enumerate(course) if tour.stops[stop] == place), None)
        if visit is None or course[visit][1] > left:
            return None
        if everywhere in (some.stop, *(stop for stop, _ in course[:visit])):
            room.append(left - course[visit][1])
    return {everywhere: max(Fraction(0), min(room)) // patrol.unit * patrol.unit}


def _kept_by(some: _Round, duty: Duty) -> Tuple[str, str]:
    """The automaton that says whether a place is visited in time, and its clock."""
    watched = ((watcher.name, watcher.clock) for watcher in some.watchers if watcher.objective == duty.name)
    return next(watched, (duty.name, duty.clock))


def _course(network: Network, some: _Round, late: Fraction, now: Now) -> List[Tuple[int, Fraction]]:
    """The stops that the robot comes to from now on, and when it is there at the latest if it stays nowhere."""
    tour, here, clock = some.tour, network.automaton(some.tour.robot).initial, now.clocks[some.walker.clock]
    found: List[Tuple[int, Fraction]] = []
    if here == tour.stops[some.stop]:
        following = tour.after(some.stop)
        way = None if following is None else some.walker.ways[here][tour.stops[following]]
        moment = now.late if way is None else max(now.late, way.rest - clock) - way.rest
    else:
        lasts = next(way.lasts for led in some.walker.ways.values() for way in led.values() if way.edge.target == here)
        moment = max(now.late, lasts - clock)
        found.append((some.stop, moment))
    for stop, takes in onward(some.walker, tour, some.stop, late):
        moment += takes
        found.append((stop, moment))
    return found


def _longest_gap(tour: Tour, again: Sequence[Tuple[int, Fraction]], place: str) -> Fraction:
    """How long a place waits at most between two visits on the way around."""
    longest = gap = Fraction(0)
    for stop, takes in again:
        gap += takes
        if tour.stops[stop] == place:
            longest, gap = max(longest, gap), Fraction(0)
    return longest
