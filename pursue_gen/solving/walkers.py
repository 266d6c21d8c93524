"""Who walks on patrols, on which ways and how fast, and the places to be visited: what rounds and tours are made of."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import AbstractSet, Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.language.network_names import LOSE
from pursue_gen.solving.distances import backwards, distances_to
from pursue_gen.solving.due_moves import Duty, duties, patrols
from pursue_gen.solving.rounds import Robot, Visit
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.tga.network import Automaton, Edge, Guard, Network, Objective
from pursue_gen.tga.scale import common_denominator, least_common_multiple
from pursue_gen.tga.tours import ways_of

_UNITS = 10
"""A command is due within a tenth of a time unit, or less: behind a strict bound there is no first instant."""


@dataclass(frozen=True)
class Way:
    """A movement that can be commanded: its edge, the rest before it, how long it lasts at least and at most, and the
    edge of its end where that is commanded, too."""

    edge: Edge
    rest: Fraction
    least: Fraction
    lasts: Fraction
    end: Optional[Edge]


@dataclass(frozen=True)
class Walker:
    """A robot: its ways by place and next place, and as `rounds` knows it; how long it stays at a place at most before
    it goes on; from each place to each other one where it goes first."""

    automaton: Automaton
    clock: str
    ways: Mapping[str, Mapping[str, Way]]
    robot: Robot
    stay: Fraction
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
class Patrol:
    """What tours are to keep: who walks them, the duties, and as `rounds` has these; for how long a command is due, and
    how late it takes effect at most."""

    walkers: Tuple[Walker, ...]
    duties: Tuple[Duty, ...]
    visits: Tuple[Visit, ...]
    unit: Fraction
    late: Fraction


def patrol_of(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    prompt: bool = False,
    excused: AbstractSet[str] = frozenset(),
) -> Optional[Patrol]:
    """The patrol that an objective asks for; None where it asks for something else, or a robot does not move as it is
    told, at any time. `prompt`: commands are given at the first instant; `excused`: robots that are not relied on."""
    bad = dict.fromkeys(name for name, _ in objective.bad)
    known = () if objective.reaches else duties(network, objective, patrols(network))
    if not known or len(known) != len(bad) or any(place != LOSE for _, place in objective.bad):
        return None
    in_order = any(network.automaton(duty.name).assigned for duty in known)  # a visit counts at some times only
    if in_order or any(len(places) != 1 for duty in known for places in duty.visits.values()):
        return None
    unit = Fraction(1, least_common_multiple((_UNITS, common_denominator([reaction, *network.times]))))
    unit *= max(1, reaction // unit)  # who may be so late need not be so prompt
    late = reaction if prompt else reaction + unit
    robots = [network.automaton(name) for name in commanded_agents(network) if name not in excused]
    walkers = [_walker(robot, late, bool(network.start)) for robot in robots]
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
    return Patrol(tuple(able), known, tuple(visits), unit, late)


def _walker(robot: Automaton, late: Fraction, under_way: bool) -> Optional[Walker]:
    """The robot with the ways that depend on nothing but its rest; None where there are none, or it starts on one and
    is not `under_way` in the middle of a play."""
    clocks = {bound.clock for bounds in robot.stays.values() for bound in bounds}
    if len(clocks) != 1:
        return None
    (clock,) = clocks
    ways: Dict[str, Dict[str, Way]] = {}
    for place, led in ways_of(robot).items():
        for following, edge in led.items():
            ends = [other for other in robot.edges if other.source == edge.target and other.target == following]
            if any(each.guard.integers or clock not in each.resets for each in (edge, *ends)):
                continue
            if len(ends) != 1 or len(robot.stays.get(edge.target, ())) != 1:
                continue
            rest, least = (_since(each.guard, clock) for each in (edge, *ends))
            end = ends[0] if ends[0].controllable else None
            lasts = Fraction(robot.longest[edge.target]) if end is None else least + late
            ways.setdefault(place, {})[following] = Way(edge, rest, least, lasts, end)
    if not ways or (robot.initial in robot.stays and not under_way):
        return None
    steps = {a: {b: float(way.rest + late + way.lasts) for b, way in led.items()} for a, led in ways.items()}
    times, following_of = _all_ways(steps)
    stay = min(way.rest for led in ways.values() for way in led.values()) + late
    return Walker(robot, clock, ways, Robot(robot.initial, times, float(stay)), stay, following_of)


def _since(guard: Guard, clock: str) -> Fraction:
    """From when on a guard holds."""
    bounds = (Fraction(bound.bound) for bound in guard.clocks if bound.clock == clock and bound.op in (">", ">="))
    return max(bounds, default=Fraction(0))


def _all_ways(
    steps: Mapping[str, Mapping[str, float]]
) -> Tuple[Dict[str, Dict[str, float]], Dict[Tuple[str, str], str]]:
    """How long it takes from each place to each other one, and where one goes first."""
    back = backwards(steps)
    times: Dict[str, Dict[str, float]] = {start: {} for start in steps}
    following: Dict[Tuple[str, str], str] = {}
    for place in dict.fromkeys((*steps, *back)):
        far = distances_to([place], back)
        for start in steps:
            if start in far:
                ways = ((takes + far[first], first) for first, takes in steps[start].items() if first in far)
                times[start][place], following[start, place] = far[start], min(ways)[1] if start != place else ""
    return times, following
