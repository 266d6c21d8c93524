"""How long places wait on a tour, those that the robot only passes included; tours that visit some places more
often."""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from pursue_gen.solving.rounds import Round
from pursue_gen.solving.walkers import Patrol, Walker
from pursue_gen.tga.tours import Tour

_OFTEN = 12
"""On a round through so many places some may come more often than others. Not measured."""


class Gap(NamedTuple):
    """How long a place waits at most for its first visit, and between two visits, in time units."""

    first: Fraction
    later: Fraction


def onward(walker: Walker, tour: Tour, stop: int, late: Fraction) -> Iterator[Tuple[int, Fraction]]:
    """The stops that come behind this one until the tour is back where its way around begins, and this one, each with
    the longest time to it from the one before, when the robot stays nowhere and sets off so `late`."""
    for _ in range(2 * len(tour.stops)):
        following = tour.after(stop)
        if following is None:
            return
        way = walker.ways[tour.stops[stop]][tour.stops[following]]
        yield following, way.rest + late + way.lasts
        stop = following


def tour_of(walker: Walker, patrol: Patrol, mine: Round) -> Optional[Tour]:
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
    if places[0] == start:  # the wait at the start is not repeated in each round
        return Tour(walker.automaton.name, (*stops, *back), 1)
    return Tour(walker.automaton.name, (*stops, *back[:-1]), len(walker.stops([start, places[0]])))


def gaps(walker: Walker, patrol: Patrol, mine: Round) -> Dict[int, Gap]:
    """How long each visit of a round waits, by its number."""
    tour = tour_of(walker, patrol, mine)
    if tour is None:
        return {}
    comes: Dict[str, List[Fraction]] = {}
    for stop, moment in course(walker, patrol, tour):
        comes.setdefault(tour.stops[stop], []).append(moment)
    return {k: _gap(comes[patrol.visits[k].place], walker.stay) for k in dict.fromkeys(mine)}


def course(walker: Walker, patrol: Patrol, tour: Tour) -> List[Tuple[int, Fraction]]:
    """The stops of a tour from the start on until all has come twice, with the latest moments of a robot that stays
    nowhere."""
    found, moment = [(0, Fraction(0))], Fraction(0)
    for stop, takes in onward(walker, tour, 0, patrol.late):
        moment += takes
        found.append((stop, moment))
    return found


def _gap(comes: Sequence[Fraction], stay: Fraction) -> Gap:
    return Gap(comes[0], max((b - a - stay for a, b in zip(comes, comes[1:])), default=Fraction(0)))


def part_of_period(walker: Walker, patrol: Patrol, mine: Round) -> Fraction:
    """The longest time that a visit of a round waits, as a part of its period."""
    return max((part for _, part in _parts(walker, patrol, mine)), default=Fraction(0))


def _parts(walker: Walker, patrol: Patrol, mine: Round) -> Iterator[Tuple[int, Fraction]]:
    for k, gap in gaps(walker, patrol, mine).items():
        yield k, max(gap) / Fraction(patrol.visits[k].period)


def repeated(walker: Walker, patrol: Patrol, mine: Round, enough: Fraction) -> Round:
    """The round, on which some places come more often where they wait longer than `enough` of their period otherwise.

    One visit more, or one less, is what helps most, as long as something does: nothing says that there is no better
    way.
    """
    best, known = mine, _too_long(walker, patrol, mine, enough)
    while any(known) and len(set(mine)) <= _OFTEN and len(best) < 3 * len(mine):
        some = {other: _too_long(walker, patrol, other, enough) for other in _neighbours(best)}
        found = min(some, key=lambda other: (some[other], len(other), other), default=best)
        if some.get(found, known) >= known:
            break
        best, known = found, some[found]
    return best


def _too_long(walker: Walker, patrol: Patrol, mine: Round, enough: Fraction) -> Tuple[Fraction, Fraction]:
    """By how much visits wait longer than their periods, and than `enough`, all together, in parts of their periods:
    what is kept stays so."""
    parts = [part for _, part in _parts(walker, patrol, mine)]
    over, longer = (sum((max(Fraction(0), part - most) for part in parts), Fraction(0)) for most in (1, enough))
    return over, longer


def _neighbours(some: Round) -> Iterator[Round]:
    """The rounds with a visit more, or with one less of those that come several times, none of them twice in a row."""
    more = ((*some[:at], k, *some[at:]) for at in range(len(some)) for k in dict.fromkeys(some))
    less = ((*some[:at], *some[at + 1 :]) for at, k in enumerate(some) if some.count(k) > 1)
    yield from (other for other in (*more, *less) if all(a != b for a, b in zip(other, (*other[1:], other[0]))))
