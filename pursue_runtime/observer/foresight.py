"""Where a mission will be in a few seconds: if the plan in force is played, and everybody ends when it is expected.

In a busy fleet something ends or begins more often than a plan is found, so a plan for an order is looked for from a
state that is still to come. It may come otherwise: whoever uses a plan for a foreseen state compares first. Times are
time units.
"""

from __future__ import annotations

from typing import Collection, Dict, Iterable, Iterator, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.model import Model, Move, Position
from pursue_runtime.observer.automata import Automata
from pursue_runtime.observer.planning import Spread
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Cover
from pursue_runtime.zones import EPSILON, INFINITY, Zone, due

MOST_EVENTS = 40
"""So many events are foreseen at most. Not measured."""

WIDE = 4.0
"""Of what may take so many time units more or less, the end is not foreseen: it has not come yet. Not measured."""

MARGIN = 0.05
"""A zone that opens with a strict bound is reached less than so many time units later. Not measured."""

SOON = 0.002
"""Time units that an event may be off of which the moment is known: it is noticed so much later. Not measured."""

NOTHING: Mapping[str, float] = {}


class Foreseen(NamedTuple):
    """A position, in how many time units it `begins`, and by what those clocks may differ that start until then."""

    position: Position
    begins: float
    spread: Spread


class _Event(NamedTuple):
    """What happens next, so long from the moment of a position on; `own`: by how much more or less; `because`: by what
    else. `word` "": nobody knows what happens, or it is an objective's own step where `agent` is "", too."""

    middle: float
    own: float = 0.0
    because: Mapping[str, float] = NOTHING
    agent: str = ""
    word: str = ""

    @property
    def off(self) -> float:
        return self.own + sum(self.because.values())


class Foresight:
    """Foresees once, from one position: nothing is expected of those who are `gone`."""

    def __init__(self, automata: Automata, cover: Optional[Cover], gone: Collection[str]) -> None:
        self._automata, self._model, self._cover, self._gone = automata, automata.model, cover, gone
        self._spread: Dict[str, Mapping[str, float]] = {}
        self._last = NOTHING  # by what the moment of the last event may differ
        self._commanded: Dict[Tuple[str, str], Mapping[str, float]] = {}  # what is commanded: that of its moment

    def find(self, here: Position, least: float, most: float, quiet: float) -> Optional[Foreseen]:
        """Return the first position between `least` and `most` in which nothing happens for `quiet`; None: none.

        Requires time units, 0 <= `least`, and to be asked once; ensures a position that the mission comes to if nothing
        happens that is not expected.
        """
        passed = settled = 0.0
        position = here
        for number in range(MOST_EVENTS):
            begins = max(least, settled)
            if begins > most:
                return None
            events = list(self._next(position, passed))
            if begins + quiet <= passed + min((each.middle - each.off for each in events), default=INFINITY):
                return Foreseen(position.aged(begins - passed), begins, self._spread)
            event = min(events, key=lambda each: each.middle)
            if event.middle < 0.0:
                event = event._replace(middle=0.0, own=event.own - event.middle)
            position = position.aged(event.middle)
            moves = self._moves(event, position)
            if not moves:
                return None
            passed, position = passed + event.middle, Model.after(moves, position)
            settled = max(settled, passed + event.off)
            self._last = {**event.because, str(number): event.own + SOON}
            self._spread.update((clock, self._last) for move in moves for clock in move.edge.resets)
        return None

    def _moves(self, event: _Event, position: Position) -> Optional[Tuple[Move, ...]]:
        if event.word:
            return self._model.joint_move(position, event.word, event.agent, timed=False)
        return None if event.agent else self._automata.internal_move(position.aged(SOON))

    def _next(self, position: Position, passed: float) -> Iterator[_Event]:
        """What may happen first if time passes, so long after the first position."""
        yield from self._commands(position, passed)
        yield from map(_Event, self._automata.internal_delays(position))
        ends = list(self._ends(position, passed))
        yield from ends
        known = {each.agent for each in ends}
        for name, delay in self._automata.bounds(position):
            if name not in known and name not in self._gone:
                yield _Event(delay, agent=name)

    def _commands(self, position: Position, passed: float) -> Iterator[_Event]:
        """What the plan in force commands. Controllers send it a quarter of the reaction after it is due, and it takes
        effect up to the reaction later."""
        found = [] if self._cover is None else self._cover.find(SystemState(0, 0.0, *position))
        known, self._commanded = self._commanded, {}
        half = 0.75 * self._model.reaction
        before = position if passed else position.aged(-2 * half)  # what was due a moment ago is on its way
        for what, zones in (each for covered in found for each in covered.commands.items()):
            delay = due(zones, before.clocks)
            if delay is None or what[0] in self._gone:
                continue
            delay -= 0.0 if passed else 2 * half
            if delay <= MARGIN:
                delay, because = 0.0, known.get(what, self._last)
            else:
                because = self._waits_for(zones, position, delay)
            self._commanded[what] = because
            yield _Event(delay + half, half, because, *what)

    def _waits_for(self, zones: Iterable[Zone], position: Position, delay: float) -> Mapping[str, float]:
        """By what the moment may differ at which one of the zones is reached."""
        for each in (each for zone in zones for each in zone if each.right and not each.left):
            if abs(-each.bound - position.clocks[each.right] - delay) <= MARGIN:
                return self._spread.get(each.right, NOTHING)
        return NOTHING

    def _ends(self, position: Position, passed: float) -> Iterator[_Event]:
        """The ends of what agents do that are known to come within a short time."""
        for automaton in self._model.acting:
            place = position.locations[automaton.name]
            bounds = self._model.bounds_of(automaton.name, place, position.values)
            if automaton.name in self._gone or not bounds:
                continue
            last, clock = min((bound.bound - position.clocks[bound.left], bound.left) for bound in bounds)
            because = self._spread.get(clock, NOTHING)
            for edge in automaton.edges_from(place):
                if edge.is_end and edge.sync != "receive" and edge.allowed(position.values):
                    first = _opens(edge.when, position)
                    first = first if because else max(first, -passed)  # it has not come yet
                    if -EPSILON <= last - first <= WIDE:
                        yield _Event((first + last) / 2, (last - first) / 2, because, automaton.name, edge.word)
                        break


def _opens(zone: Zone, position: Position) -> float:
    """From when on the clocks are in the zone, negative: so long ago."""
    opens = (-each.bound - position.clocks[each.right] for each in zone if each.right and not each.left)
    return max(opens, default=-INFINITY)
