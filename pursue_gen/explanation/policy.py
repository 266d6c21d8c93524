"""What the controller does in a counter-play: as well as it can be expected to play a game that it cannot win.

It follows, in turn, strategies that win nearly the same game (see `changes`), as long as they know a position;
where none does, the first step of a relaxed plan.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import AbstractSet, Callable, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.explanation.position import Position
from pursue_gen.language import network_names as names
from pursue_gen.synthesis.game import Bound, Game, JointMove, State, invariant
from pursue_gen.synthesis.lookup import blocks_of, facts_of
from pursue_gen.synthesis.relaxed import RelaxedPlanner
from pursue_gen.synthesis.strategy import Block, Strategy, Zone
from pursue_gen.tga.network import Edge
from pursue_gen.zones.dbm import is_strict

Choice = Tuple[JointMove, Fraction]
"""A move and after what delay it is decided."""

_Key = Tuple[str, str, str, str]

COARSE = Fraction(1, 10)
"""How long after a moment that is just too early: soon enough for most plays, and short to write. Not measured."""


@dataclass(frozen=True)
class Window:
    """Delays: from `low` (not itself if `low_open`) to `high` (not itself if `high_open`; None: for ever)."""

    low: Fraction = Fraction(0)
    low_open: bool = False
    high: Optional[Fraction] = None
    high_open: bool = False

    def at_least(self, low: Fraction, strict: bool) -> Window:
        """The delays of the window from there on."""
        if low > self.low or (low == self.low and strict):
            return replace(self, low=low, low_open=strict)
        return self

    def at_most(self, high: Fraction, strict: bool) -> Window:
        """The delays of the window up to there."""
        if self.high is None or high < self.high or (high == self.high and strict):
            return replace(self, high=high, high_open=strict)
        return self

    def both(self, other: Window) -> Window:
        """The delays in this window and in the other one."""
        common = self.at_least(other.low, other.low_open)
        return common if other.high is None else common.at_most(other.high, other.high_open)

    def holds(self, delay: Fraction) -> bool:
        """True if the delay is in the window."""
        if delay < self.low or (delay == self.low and self.low_open):
            return False
        return self.high is None or delay < self.high or (delay == self.high and not self.high_open)

    def earliest(self, grain: Fraction = COARSE) -> Optional[Fraction]:
        """The first moment, or where there is none one soon after the beginning; None: the window is empty."""
        if not self.low_open and self.holds(self.low):
            return self.low
        if self.holds(self.low + grain):
            return self.low + grain
        if self.high is None or self.high <= self.low:
            return None
        return (self.low + self.high) / 2 if self.high_open else self.high

    def latest(self) -> Optional[Fraction]:
        """The last moment; None where there is none."""
        return self.high if self.high is not None and self.holds(self.high) else None


Windows = Sequence[Tuple[JointMove, Window]]
"""Moves with the delays after which they can be made."""


def longest(game: Game, here: Position) -> Optional[Fraction]:
    """How long time may pass in a position; None: for ever."""
    rooms = [game.time(bound) - here.clocks[i - 1] for i, _, bound in invariant(game, here.state)]
    return min(rooms) if rooms else None


def window(game: Game, here: Position, move: JointMove) -> Window:
    """The delays after which the move can be made."""
    entered = [bound for bound in invariant(game, move.target) if bound[0] not in move.resets]
    return within(game, here, (*invariant(game, here.state), *move.bounds, *entered))


def within(game: Game, here: Position, bounds: Iterable[Bound]) -> Window:
    """The delays after which all these bounds hold, each of one clock."""
    result = Window()
    for i, j, bound in bounds:
        if j == 0:
            result = result.at_most(game.time(bound) - here.clocks[i - 1], is_strict(bound))
        else:
            result = result.at_least(-game.time(bound) - here.clocks[j - 1], is_strict(bound))
    return result


def is_driven(game: Game, here: Position, move: JointMove) -> bool:
    """True for the end of a movement or an action that has to come in time."""
    bounds = game.automata[move.owner].invariants[here.state.locations[move.owner]]
    return bool(bounds) and game.origins[move.edges[0]].is_end


def preferred(driven: Windows, robots: AbstractSet[int], grain: Fraction = COARSE) -> List[Choice]:
    """When each of these moves is made, in the order of time: robots end as late as they may, others as soon as they
    can."""
    found: List[Choice] = []
    for move, open_ in driven:
        late = open_.latest() if move.owner in robots else None
        delay = open_.earliest(grain) if late is None else late
        found += [] if delay is None else [(move, delay)]
    return sorted(found, key=lambda choice: choice[1])


class Controller:
    """Decides for the controller; remembers where it has been, to not go in circles by a relaxed plan."""

    def __init__(self, game: Game, strategies: Sequence[Strategy]) -> None:
        self._game = game
        self._books = [blocks_of(strategy) for strategy in strategies]
        self._planners = _planners(game)
        self._been: Set[State] = set()

    def decide(self, here: Position, moves: Sequence[JointMove]) -> Optional[Choice]:
        """One of the controller's moves and when; None: wait."""
        self._been.add(here.state)
        windows = [(move, window(self._game, here, move)) for move in moves]
        state = facts_of(self._game, here.state)
        for book in self._books:
            blocks = [block for _, block in book.find(state)]
            if blocks and all(self._knows(block, here) for block in blocks):
                choices = (self._advised(block, here, windows) for block in blocks)
                return min((choice for choice in choices if choice), key=lambda choice: choice[1], default=None)
        return self._planned(here, windows)

    def _knows(self, block: Block, here: Position) -> bool:
        return any(span is not None and span.holds(Fraction(0)) for span in map(self._span(here), block.zones))

    def _advised(self, block: Block, here: Position, windows: Windows) -> Optional[Choice]:
        choices: List[Choice] = []
        named = {name for name, _ in block.state.locations}
        for command in block.commands:
            keys = tuple(_key(move.automaton, move.edge) for move in command.moves)
            for move, open_ in windows:
                if self._keys(move, named) != keys:
                    continue
                for span in map(self._span(here), command.zones):
                    delay = None if span is None else span.both(open_).earliest()
                    if delay is not None:
                        choices.append((move, delay))
        return min(choices, key=lambda choice: choice[1], default=None)

    def _planned(self, here: Position, windows: Windows) -> Optional[Choice]:
        new = [(move, open_) for move, open_ in windows if move.target not in self._been]
        # What is due now comes before what may come to be due.
        urgent = sorted(self._planners, key=lambda planner: planner.state(here.state) != here.state)
        for planner in urgent:
            for offered in (new, windows):
                liked = planner.plans.choose(planner.state(here.state), [move for move, _ in offered])
                for move, open_ in offered:
                    delay = open_.earliest() if move in liked else None
                    if delay is not None:
                        return move, delay
        return None

    def _keys(self, move: JointMove, named: AbstractSet[str]) -> Tuple[_Key, ...]:
        """What the named automata do in the move."""
        game = self._game
        parts = ((game.automata[game.edges[k].automaton].name, game.origins[k]) for k in move.edges)
        return tuple(_key(name, edge) for name, edge in parts if name in named)

    def _span(self, here: Position) -> Callable[[Zone], Optional[Window]]:
        """When a zone holds, seen from here; None: time does not get there."""
        clocks = dict(zip(self._game.clocks, here.clocks))
        return lambda zone: span(zone, clocks)


class _Planner(NamedTuple):
    """Plans for the goal, or for the way out of the risk of one deadline: (automaton, location at risk)."""

    plans: RelaxedPlanner
    at_risk: Optional[Tuple[int, int]] = None

    def state(self, state: State) -> State:
        """From where it plans: always from the risk, since the next one comes."""
        if self.at_risk is None:
            return state
        number, place = self.at_risk
        return replace(state, locations=(*state.locations[:number], place, *state.locations[number + 1 :]))


def _planners(game: Game) -> List[_Planner]:
    """One for the goal; where there are deadlines only, one for each."""
    if game.goal:
        return [_Planner(RelaxedPlanner(game))]
    found: List[_Planner] = []
    for number in dict.fromkeys(automaton for automaton, _ in game.bad):
        locations = game.automata[number].locations
        if names.AT_RISK in locations:
            idle = (number, locations.index(names.IDLE))
            plans = RelaxedPlanner(replace(game, goal=(idle,)))
            found.append(_Planner(plans, (number, locations.index(names.AT_RISK))))
    return found


def _key(automaton: str, edge: Edge) -> _Key:
    return automaton, edge.source, edge.target, str(edge.sync)


def moments(windows: Windows, grain: Fraction) -> Iterator[Fraction]:
    """The first and last moments of the windows."""
    for _, open_ in windows:
        for moment in (open_.earliest(grain), open_.latest()):
            if moment is not None:
                yield moment


def span(zone: Zone, clocks: Mapping[str, Fraction]) -> Optional[Window]:
    """The delays after which clocks that have these values now are in a zone; None: none of them are."""
    result = Window()
    for c in zone:
        if c.left is not None and c.right is not None:
            difference = clocks[c.left] - clocks[c.right]
            if difference > c.bound or (difference == c.bound and c.strict):
                return None
        elif c.left is not None:
            result = result.at_most(c.bound - clocks[c.left], c.strict)
        elif c.right is not None:
            result = result.at_least(-c.bound - clocks[c.right], c.strict)
    return result
