"""How long the course of a strategy with orders of passage takes at worst: the longest way through its events.

A command comes as soon as all is so that it needs and its clocks are past their bounds, and takes effect up to the
reaction later; the end of a movement or an action comes at the bound of its invariant. Where each event comes as late
as it can all later ones do, too.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, List, Mapping, Optional, Tuple

from pursue_gen.proof.course import START, Event
from pursue_gen.proof.passages import Fault, Played
from pursue_gen.synthesis.strategy import Block, Strategy, Zone
from pursue_gen.tga.network import Constraint, Guard

INSTANT = Fraction(1, 1000)
"""Who may act as soon as a clock is past a bound acts within this time, in time units. Not measured."""


def latest(played: Played, strategy: Strategy, reaction: Fraction) -> Fraction:
    """The latest time at which the goal is reached, in time units.

    Requires the course of this strategy, see `passages.played`. Raises Fault where an event of the course need not come
    in time, or at all.
    """
    assert reaction >= 0
    _check_zones(strategy)
    course = played.course
    resets = _resets(course.events)
    times: List[Fraction] = []
    for number, event in enumerate(course.events):
        if event.block is None:
            times.append(_of_end(played, event, times, resets))
            continue
        moments = [_time(times, course.begin(stay)) for stay in event.needs.items()]
        for clock, bound, strict in _enabled(event, _zone(strategy, event)):
            if clock not in played.part.clocks:
                raise Fault(f"{event.sender} waits for {clock}, of which nothing is known")
            for reset in resets.get(clock, ()):
                if not course.is_before(reset, number) and not course.is_before(number, reset):
                    raise Fault(f"{clock} may be reset when {event.sender} leaves {event.edge.source}")
            moments += [
                _time(times, reset) + bound + strict * INSTANT
                for reset in (START, *(r for r in resets.get(clock, ()) if r < number))
            ]
        times.append(max(moments) + reaction)
    at_goal = [_time(times, course.begin((name, course.last(name)))) for name, _ in played.objective.goal]
    _check_stays(played, strategy, reaction)
    return max(at_goal)


def _time(times: List[Fraction], event: int) -> Fraction:
    return Fraction(0) if event == START else times[event]


def _resets(events: List[Event]) -> Dict[str, List[int]]:
    """The events that reset each clock."""
    found: Dict[str, List[int]] = {}
    for number, event in enumerate(events):
        for clock in event.resets:
            found.setdefault(clock, []).append(number)
    return found


def _zone(strategy: Strategy, event: Event) -> Zone:
    """The only zone of the command that the event is."""
    assert event.block is not None
    (zone,) = next(c.zones for c in strategy.blocks[event.block].commands if c.moves[0].edge == event.edge)
    return zone


def _enabled(event: Event, zone: Zone) -> List[Tuple[str, Fraction, bool]]:
    """The lower bounds of the command's zone (clock, bound, strict), which let the edge's guard hold."""
    bounds = [_lower(constraint) for constraint in zone]
    for bound in event.edge.guard.clocks:
        strict = bound.op == ">"
        if not any(c == bound.clock and (b, s) >= (Fraction(bound.bound), strict) for c, b, s in bounds):
            raise Fault(f"{event.sender} may be commanded too soon to leave {event.edge.source}")
        if bound.op not in (">", ">="):
            raise Fault(f"{event.sender} may be commanded too late to leave {event.edge.source}")
    return bounds


def _lower(constraint: Constraint) -> Tuple[str, Fraction, bool]:
    """A lower bound of a clock. Raises Fault for another constraint."""
    if constraint.left is not None or constraint.right is None:
        raise Fault("a command's zone has other than lower bounds")
    return constraint.right, -constraint.bound, constraint.strict


def _check_zones(strategy: Strategy) -> None:
    """Each block says all the time what is done: it waits, up to the zone of its only command if it has one."""
    for block in strategy.blocks:
        if len(block.commands) > 1 or any(len(command.zones) != 1 for command in block.commands):
            raise Fault("a block has more than one command, or one with several zones")
        missing = _not_waited(block)
        if missing is not None:
            raise Fault(f"a block does not say what is done {missing}")


def _not_waited(block: Block) -> Optional[str]:
    """When a block says nothing; None: never."""
    if not block.commands:
        return None if () in block.wait else "all the time"
    for constraint in block.commands[0].zones[0]:
        clock, bound, strict = _lower(constraint)
        before = Constraint(clock, None, bound, not strict)
        if before not in [zone[0] for zone in block.wait if len(zone) == 1] and () not in block.wait:
            return f"before {clock} is {float(bound):g}"
    return None


def _of_end(played: Played, event: Event, times: List[Fraction], resets: Mapping[str, List[int]]) -> Fraction:
    """The latest time of an event of the environment, which an invariant obliges it to take."""
    course, name = played.course, event.sender
    stay = name, event.ends[name]
    begin, place = course.begin(stay), event.edge.source
    bounds = played.part.automaton(name).stays.get(place, ())
    if not bounds:
        raise Fault(f"nobody obliges {name} to leave {place}")
    for other in event.needs.items():
        if not course.is_before(course.begin(other), begin):
            raise Fault(f"{name} may not be able to leave {place}")
    clocks = {bound.clock for bound in bounds}
    if len(clocks) != 1 or any(bound.op != "<=" for bound in bounds):
        raise Fault(f"{name} has no last instant in {place}")
    (clock,) = clocks
    if begin != START and clock not in course.events[begin].resets:
        raise Fault(f"{name} may come to {place} without time to stay")
    longest = min(Fraction(bound.bound) for bound in bounds)
    if not _is_open(event.edge.guard, clock, longest):
        raise Fault(f"{name} may not be able to leave {place}")
    number = course.end(stay)
    assert number is not None
    for reset in resets.get(clock, ()):
        if not course.is_before(reset, begin) and not course.is_before(number, reset):
            raise Fault(f"{clock} may be reset while {name} is in {place}")
    return _time(times, begin) + longest


def _is_open(guard: Guard, clock: str, longest: Fraction) -> bool:
    """True if the guard holds where the clock is at the bound of its invariant."""
    last = {">": lambda bound: bound < longest, ">=": lambda bound: bound <= longest}
    return all(b.clock == clock and b.op in last and last[b.op](b.bound) for b in guard.clocks)


def _check_stays(played: Played, strategy: Strategy, reaction: Fraction) -> None:
    """No invariant stops time: whoever is at its bound leaves by itself (see `_of_end`), or is commanded to in time."""
    course = played.course
    for automaton in played.part.automata:
        for k, place in enumerate(course.values[automaton.name] if automaton.stays else ()):
            if place not in automaton.stays:
                continue
            number = course.end((automaton.name, k))
            end = None if number is None else course.events[number]
            if end is None or end.sender != automaton.name:
                raise Fault(f"{automaton.name} has a deadline in {place}")
            if end.block is not None:
                _check_commanded_end(played, strategy, end, reaction)


def _check_commanded_end(played: Played, strategy: Strategy, event: Event, reaction: Fraction) -> None:
    """Where the controller decides when a movement or an action ends it does so before time runs out."""
    course, name, place = played.course, event.sender, event.edge.source
    begin = course.begin((name, event.ends[name]))
    if reaction:
        raise Fault(f"what ends the stay of {name} in {place} may come too late")
    zone = _zone(strategy, event)
    for bound in played.part.automaton(name).stays.get(place, ()):
        starts = begin == START or bound.clock in course.events[begin].resets
        last = [(c, b) for c, b, strict in map(_lower, zone) if c != bound.clock or b + strict * INSTANT > bound.bound]
        if not starts or last or bound.op != "<=":
            raise Fault(f"{name} may not be able to leave {place}")
    if not all(course.is_before(course.begin(stay), begin) for stay in event.needs.items()):
        raise Fault(f"{name} may not be able to leave {place}")
