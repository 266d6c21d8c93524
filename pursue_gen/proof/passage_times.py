"""How long the course of a strategy with orders of passage takes at worst: the longest way through its events.

A command comes as soon as all is so that it needs and its clocks are past their bounds, and takes effect up to the
reaction later; the end of a movement or an action comes at the bound of its invariant. Where each event comes as late
as it can all later ones do, too.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, List, Optional, Sequence, Tuple

from pursue_gen.proof.course import START, Course, Event
from pursue_gen.proof.passages import Fault, Played
from pursue_gen.synthesis.strategy import Block, Strategy, Zone
from pursue_gen.tga.network import Automaton, Constraint, Guard

_DECIDED = Fraction(1, 2)
"""Where a deadline runs controllers decide within this part of the reaction after a command is due: they begin one that
is due behind a strict bound a quarter of it later. Not measured."""

INSTANT = Fraction(1, 1000)
"""Who may act as soon as a clock is past a bound acts within this time, in time units. Not measured."""


def latest(played: Played, strategy: Strategy, reaction: Fraction) -> Fraction:
    """The latest time at which the goal is reached, in time units; 0 where there is none.

    Requires the course of this strategy, see `passages.played`. Raises Fault where an event of the course need not come
    in time, or at all.
    """
    course = played.course
    waits = _Waits(played, strategy, reaction)
    _check_stays(played, strategy, waits)
    at_goal = [course.begin((name, course.last(name))) for name, _ in played.objective.goal]
    return max((waits.longest(START, event) for event in at_goal), default=Fraction(0))


def deadlines(played: Played, strategy: Strategy, reaction: Fraction) -> Dict[str, Fraction]:
    """How long each deadline runs at worst until it is met, by automata. Requires and raises as `latest`."""
    return _check_stays(played, strategy, _Waits(played, strategy, reaction))


class _Waits:
    """For each event the events that it waits for, each with the time that it comes later at most."""

    def __init__(self, played: Played, strategy: Strategy, reaction: Fraction) -> None:
        assert reaction >= 0
        _check_zones(strategy)
        self.reaction = reaction
        self.course = played.course
        self.resets = _resets(played.course.events)
        self._latest: List[Fraction] = []
        self._terms: List[Dict[int, Fraction]] = []
        for number, event in enumerate(self.course.events):
            terms = self._of_end(played, event) if event.block is None else self._of_command(played, strategy, number)
            self._terms.append(terms)
            self._latest.append(max(_time(self._latest, other) + wait for other, wait in terms.items()))

    def longest(self, begin: int, end: int, late: Fraction = Fraction(0)) -> Fraction:
        """How long after one event another one that is behind it comes at most. `late`: how much later than it may each
        command is decided.

        What need not have happened when the first one does begins then at the latest; all else has happened.
        """
        if begin == START and not late:
            return _time(self._latest, end)
        open_ones = self.course.down(end) & ~(0 if begin == START else self.course.down(begin))
        times: Dict[int, Fraction] = {}
        while open_ones:
            number = (open_ones & -open_ones).bit_length() - 1
            open_ones &= open_ones - 1
            later = Fraction(0) if self.course.events[number].block is None else late
            times[number] = later + max(times.get(other, 0) + wait for other, wait in self._terms[number].items())
        return times.get(end, Fraction(0))

    def _of_command(self, played: Played, strategy: Strategy, number: int) -> Dict[int, Fraction]:
        """Of a command: it comes as soon as its needs are met and its clocks are past their bounds, and a reaction
        later."""
        course, event = self.course, self.course.events[number]
        terms = dict.fromkeys((course.begin(stay) for stay in event.needs.items()), self.reaction)
        for clock, bound, strict in _enabled(event, _zone(strategy, event)):
            if clock not in played.part.clocks:
                raise Fault(f"{event.sender} waits for {clock}, of which nothing is known")
            resets = self.resets.get(clock, ())
            if not all(course.is_before(reset, number) or course.is_before(number, reset) for reset in resets):
                raise Fault(f"{clock} may be reset when {event.sender} leaves {event.edge.source}")
            wait = bound + strict * INSTANT + self.reaction
            for reset in _last([START, *(reset for reset in resets if reset < number)], course):
                terms[reset] = max(terms.get(reset, wait), wait)
        return terms

    def _of_end(self, played: Played, event: Event) -> Dict[int, Fraction]:
        """Of an event of the environment, which an invariant obliges it to take."""
        course, name = self.course, event.sender
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
        for reset in self.resets.get(clock, ()):
            if not course.is_before(reset, begin) and not course.is_before(number, reset):
                raise Fault(f"{clock} may be reset while {name} is in {place}")
        return {begin: longest}


def _last(events: Sequence[int], course: Course) -> Sequence[int]:
    """The last of these events, in the order of the play, where all others are before it; else all."""
    return events[-1:] if all(course.is_before(event, events[-1]) for event in events) else events


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


def _is_open(guard: Guard, clock: str, longest: Fraction) -> bool:
    """True if the guard holds where the clock is at the bound of its invariant."""
    last = {">": lambda bound: bound < longest, ">=": lambda bound: bound <= longest}
    return all(b.clock == clock and b.op in last and last[b.op](b.bound) for b in guard.clocks)


def _check_stays(played: Played, strategy: Strategy, waits: _Waits) -> Dict[str, Fraction]:
    """No invariant stops time: whoever is at its bound leaves by itself (see `_of_end`), is commanded to in time, or
    has left before. How long it takes until then at worst, by automata."""
    course = played.course
    found: Dict[str, Fraction] = {}
    for automaton in played.part.automata:
        for k, place in enumerate(course.values[automaton.name] if automaton.stays else ()):
            if course.begin((automaton.name, k)) >= played.checked:
                break
            if place not in automaton.stays:
                continue
            number = course.end((automaton.name, k))
            end = None if number is None else course.events[number]
            if end is None or end.sender != automaton.name:
                took = _taken(played, automaton, k, waits)
                found[automaton.name] = max(took, found.get(automaton.name, took))
            elif end.block is not None:
                _check_commanded_end(played, strategy, end, waits.reaction)
    return found


def _taken(played: Played, automaton: Automaton, state: int, waits: _Waits) -> Fraction:
    """How long the deadline of a state of an automaton has run at most when somebody else ends the state in time."""
    course, stay, place = played.course, (automaton.name, state), str(played.course.values[automaton.name][state])
    number, begin, late = course.end(stay), course.begin(stay), waits.reaction * _DECIDED
    longest = Fraction(0)
    for bound in automaton.stays[place]:
        resets = waits.resets.get(bound.clock, ())
        before = [reset for reset in resets if course.is_before(reset, begin)]
        since = before[-1] if before else START
        ordered = all(course.is_before(reset, since) for reset in before)
        if number is None or not ordered or not all(r in before or course.is_before(number, r) for r in resets):
            raise Fault(f"{automaton.name} has a deadline in {place}")
        longest = max(longest, waits.longest(since, number, late))
        if bound.op != "<=" or longest >= bound.bound:
            raise Fault(f"the deadline of {automaton.name} may be missed: it takes {float(longest):g}")
    return longest


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
