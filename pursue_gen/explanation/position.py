"""Who wins from a position in the middle of a play: decided by the solver, with a network that begins there.

Positions are those of the game (see `synthesis.game`) with exact clocks in time units. The network that begins at a
position keeps all automata parked while a prologue, at fixed moments of the environment's, sets the clocks; then all
start at once. A safety game can be cut off at a horizon, after which nothing is lost any more: from a position that is
lost even so, the environment wins in that time, so it makes headway by just staying among such positions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.game import JointMove, State
from pursue_gen.synthesis.limits import NO_LIMITS
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Network, Objective, Sync
from pursue_gen.tga.pauses import acting_at_most
from pursue_gen.tga.scale import common_denominator, scaled
from pursue_gen.thresholds import from_below

_PARKED, _OVER, _PROLOGUE = "@parked", "@over", "@prologue"
_HORIZON = "@horizon"


@dataclass(frozen=True)
class Position:
    """A point of a play: the discrete state, and the clocks in time units in the network's order."""

    state: State
    clocks: Tuple[Fraction, ...]

    def later(self, delay: Fraction) -> Position:
        """The position when so much time has passed."""
        return Position(self.state, tuple(value + delay for value in self.clocks))

    def after(self, move: JointMove, delay: Fraction) -> Position:
        """The position after a move that is made when so much time has passed."""
        aged = enumerate(self.later(delay).clocks, 1)
        return Position(move.target, tuple(Fraction(0) if clock in move.resets else value for clock, value in aged))


class PositionSolver:
    """Decides of positions of one game whether they are lost for the controller; answers are remembered.

    `budget`: what that may take; by default as much as it needs. `few`: only those count as lost in which no agent that
    rests between events needs to do more than one (see `acting_at_most`): fewer are, and it is quickly decided.
    """

    def __init__(
        self,
        network: Network,
        objective: Objective,
        reaction: Fraction,
        budget: Optional[Budget] = None,
        few: bool = False,
    ) -> None:
        self.network, self._objective, self._reaction, self._few = network, objective, reaction, few
        self.budget = Budget(NO_LIMITS) if budget is None else budget
        self._known: Dict[Tuple[Position, Fraction, Optional[int]], bool] = {}

    def same(self, position: Position) -> Position:
        """The position with clocks that no guard can tell from larger ones made equal."""
        bounds = self.network.largest.values()
        return replace(position, clocks=tuple(min(v, Fraction(top + 1)) for v, top in zip(position.clocks, bounds)))

    def lost(self, position: Position, elapsed: Fraction = Fraction(0), horizon: Optional[int] = None) -> bool:
        """True if the controller cannot win from here; with a horizon, not even if only so much time since the start
        counts, of which `elapsed` has passed. Raises LimitHit at a limit.
        """
        if horizon is not None and elapsed > horizon:
            return False
        position = self.same(position)
        key = (position, elapsed if horizon is not None else Fraction(0), horizon)
        if key not in self._known:
            network, clocks = self.network, position.clocks
            if horizon is not None:
                network = with_horizon(network, horizon)
                clocks = (*clocks, elapsed)
            scale = common_denominator(clocks)
            begun = beginning_at(scaled(network, scale), position.state, [int(v * scale) for v in clocks])
            self._known[key] = not won_from(self.budget, begun, self._objective, self._reaction * scale, self._few)
        return self._known[key]

    def horizon(self, start: Position, most: Optional[int] = None) -> Optional[int]:
        """About the least time in which the environment can do its work from a position that is lost, so that a play
        can make for its end; None: it is more than `most`. Raises LimitHit at a limit."""
        found = from_below(8, lambda time: self.lost(start, horizon=time), part=12, most=most)
        return None if found is None else found + 1


def won_from(
    budget: Budget, network: Network, objective: Objective, reaction: Fraction, few: bool, share: float = 1.0
) -> bool:
    """True if the game is won; `few`: where each agent that rests between events does no more than one. Raises
    LimitHit."""
    if few:
        return budget.verdict(acting_at_most(network, objective, 1), objective, reaction, share).won
    return verdict_of(budget, network, objective, reaction).won


def with_horizon(network: Network, horizon: int) -> Network:
    """The network with a last clock, never reset; at the horizon the game ends, which no move delays."""
    over = Location(_OVER)
    ends = Sync(_OVER, sends=False)

    def ending(automaton: Automaton) -> Automaton:
        edges = (Edge(place.name, _OVER, sync=ends) for place in automaton.locations)
        return replace(automaton, locations=(*automaton.locations, over), edges=(*automaton.edges, *edges))

    then = Guard((ClockBound(_HORIZON, ">=", horizon),))
    end = Edge(_HORIZON, _OVER, then, Sync(_OVER, sends=True), controllable=False)
    until = Location(_HORIZON, (ClockBound(_HORIZON, "<=", horizon),))
    referee = Automaton(_HORIZON, (until, over), _HORIZON, (end,))
    clocks, channels = (*network.clocks, _HORIZON), (*network.channels, _OVER)
    return replace(network, clocks=clocks, channels=channels, automata=(*map(ending, network.automata), referee))


def beginning_at(network: Network, state: State, clocks: Sequence[int]) -> Network:
    """The network whose play gets, with no choice for anybody, to this state (of its automata but the referee) with
    these clocks, and goes on from there as the network's does.
    """
    automata: List[Automaton] = []
    for k, automaton in enumerate(network.automata):
        here = automaton.locations[state.locations[k]].name if k < len(state.locations) else automaton.initial
        edges = (*automaton.edges, Edge(_PARKED, here, sync=Sync(_PROLOGUE, sends=False)))
        places = (*automaton.locations, Location(_PARKED))
        automata.append(replace(automaton, locations=places, initial=_PARKED, edges=edges))
    automata.append(_prologue(dict(zip(network.clocks, clocks))))
    values = tuple((name, value) for (name, _), value in zip(network.variables, state.values))
    channels = (*network.channels, _PROLOGUE)
    return replace(network, variables=values, channels=channels, automata=tuple(automata))


def _prologue(clocks: Mapping[str, int]) -> Automaton:
    """Resets each clock when what is left until the start is the value it must have; the largest is never reset."""
    total = max(clocks.values())
    watch = next(name for name, value in clocks.items() if value == total)
    moments = sorted({total - value for value in clocks.values()} | {0, total})
    locations: List[Location] = []
    edges: List[Edge] = []
    for k, moment in enumerate(moments):
        last = k == len(moments) - 1
        resets = tuple(name for name, value in clocks.items() if value == total - moment and name != watch)
        here, then = f"{_PROLOGUE}{k}", Guard((ClockBound(watch, "==", moment),))
        locations.append(Location(here, (ClockBound(watch, "<=", moment),)))
        sync = Sync(_PROLOGUE, sends=True) if last else None
        edges.append(Edge(here, f"{_PROLOGUE}{k + 1}", then, sync, resets=resets, controllable=False))
    locations.append(Location(f"{_PROLOGUE}{len(moments)}"))
    return Automaton(_PROLOGUE, tuple(locations), locations[0].name, tuple(edges))
