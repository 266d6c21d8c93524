"""How long a strategy may need to the goal from a point of a play: what the worst opponent makes as long as it can.

The closed loop of network and strategy is played on from the point in all ways, as `synthesis.worst_case` does from
the start: commands are decided as soon as controllers do (those of a workspace: a quarter of the reaction inside a
zone that opens with a strict bound) and take effect up to the reaction later.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, Optional, Tuple, Type

from pursue_gen.diagnostics import PursueError
from pursue_gen.proof.closed_loop import ClosedLoop, Entry
from pursue_gen.proof.moves import JointMove, State
from pursue_gen.proof.worst_case import LONGEST, counting_clock, with_counter, with_deadline
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.tga.network import Network
from pursue_gen.zones.dbm import Dbm, raw

STATES = 2_000
"""So many symbolic states are looked at from one point; a game with longer plays is too large. Not measured."""

KNOWN = 20_000
"""So many points are remembered. Not measured."""

CHEAP = 200
"""A game of so many symbolic states, or fewer, can be looked ahead in all the time. Measured on a game of 1,400
symbolic states."""

FOREVER = 1e9
"""Where the strategy does not know how to go on: time units."""


class Remaining:
    """The worst times to the goal from points of plays, in time units; nothing is known where there is no goal, or of
    strategies in stages."""

    def __init__(self, won: Solution, states: int = STATES) -> None:
        self._loop: Optional[ClosedLoop] = None
        self._won, self._states = won, states
        self.ease = 1.0
        """How often to look ahead where many missions are to be played: less often in larger games."""
        self._known: Dict[Tuple[State, Tuple[int, ...]], Optional[float]] = {}
        self._met = 0  # symbolic states that were looked at
        if not won.objective.reaches or won.strategy.in_parts:
            return
        part = won.part
        game = with_deadline(with_counter(part), won.objective, LONGEST)
        self._added = len(game.clocks) - len(part.clocks)
        self._project = _Projection(won.network, part)
        instant = won.reaction / 4 or Fraction(1, 50)
        try:
            self._loop = ClosedLoop(game, won.objective, won.strategy, won.reaction, None, instant)
            self._count = self._loop.arena.clock[counting_clock(game) or ""]
            known = self.at(*self._project.start) is not None
        except PursueError:
            known = False
        if not known:
            self._loop = None
        self.ease = min(1.0, CHEAP / max(1, self._met))

    def __reduce__(self) -> Tuple[Type[Remaining], Tuple[Solution, int]]:
        """Another process gets what it is found out from: that is small."""
        return Remaining, (self._won, self._states)

    @property
    def works(self) -> bool:
        """True where something is known."""
        return self._loop is not None

    def bound(self) -> Optional[float]:
        """The longest that a mission takes with the workspace's controllers, in time units."""
        if self._loop is None:
            return None
        bound = self.at(*self._project.start)
        return None if bound == FOREVER else bound

    def after(self, move: JointMove, point: Tuple[float, ...], delay: float) -> Optional[float]:
        """From where the move leads that is made after the delay, from the point (0 first, then the clocks) on."""
        moved = [value + delay if k else 0.0 for k, value in enumerate(point)]
        for index in move.resets:
            moved[index] = 0.0
        return self.at(move.target, tuple(moved))

    def at(self, state: State, point: Tuple[float, ...]) -> Optional[float]:
        """From this point (0 first, then the clocks) on; FOREVER where the strategy fails; None: not known."""
        loop = self._loop
        if loop is None:
            return None
        state, point = self._project.of(state, point)
        ticks = tuple(int(value * loop.arena.scale) for value in (*point, *(0.0,) * self._added))
        if (state, ticks) not in self._known:
            if len(self._known) >= KNOWN:
                self._known.clear()
            self._known[state, ticks] = self._latest(loop, (state, _point(ticks)))
        latest = self._known[state, ticks]
        if latest is None or latest == FOREVER:
            return latest
        return latest - ticks[self._count] / loop.arena.scale

    def _latest(self, loop: ClosedLoop, start: Entry) -> Optional[float]:
        """The largest value of the counting clock at the goal; FOREVER where the strategy fails."""
        found = loop.latest(self._count, self._states, LimitMonitor(), start=start)
        self._met += found.states
        if found.fails:
            return FOREVER
        return None if found.value is None else found.value / loop.arena.scale


class _Projection:
    """From the states and points of a network to those of the part that a strategy speaks of."""

    def __init__(self, network: Network, part: Network) -> None:
        automata, variables = ({a.name for a in part.automata}, {name for name, _ in part.variables})
        self._automata = [k for k, a in enumerate(network.automata) if a.name in automata]
        self._variables = [k for k, (name, _) in enumerate(network.variables) if name in variables]
        self._clocks = [0, *(k for k, clock in enumerate(network.clocks, start=1) if clock in part.clocks)]
        locations = tuple(automaton.initial for automaton in network.automata)
        self.start: Tuple[State, Tuple[float, ...]] = (
            (locations, tuple(value for _, value in network.variables)), (0.0,) * (len(network.clocks) + 1)
        )

    def of(self, state: State, point: Tuple[float, ...]) -> Tuple[State, Tuple[float, ...]]:
        """The state and the point (0 first, then the clocks) as the part has them."""
        locations, values = state
        some = tuple(locations[k] for k in self._automata), tuple(values[k] for k in self._variables)
        return some, tuple(point[k] for k in self._clocks)


def _point(ticks: Tuple[int, ...]) -> Dbm:
    """The zone of one point."""
    return Dbm(len(ticks), tuple(raw(a - b, False) for a in ticks for b in ticks))
