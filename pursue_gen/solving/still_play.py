"""How long robots drive by a strategy while nobody else does anything: a play in which all takes as long as it may."""

from __future__ import annotations

from typing import Dict, Iterator, List, Optional, Tuple

from pursue_gen.synthesis.lookup import blocks_of
from pursue_gen.synthesis.strategy import Strategy, Zone
from pursue_gen.tga.network import Edge, Network

_MOVES = 2_000
"""The most moves of a play. Measured on lab scenarios 0 to 40."""

_SOON = 1e-3
"""Time units after the moment from which on a command may be given: past a strict bound. Not measured."""


def driven_while_still(network: Network, strategy: Strategy, until: float) -> Optional[float]:
    """The time units for which robots are on their ways, all of them together, in the first `until` time units of a
    play in which the environment makes only moves that it has to make, as late as it may. None where nobody knows how
    to go on, or that takes very many moves."""
    play = _StillPlay(network, strategy)
    for _ in range(_MOVES):
        if not play.goes_on(until):
            break
    return play.driven if play.now >= until else None


class _StillPlay:
    def __init__(self, network: Network, strategy: Strategy) -> None:
        self._automata = {automaton.name: automaton for automaton in network.automata}
        self._leaving: Dict[Tuple[str, str], List[Edge]] = {}
        for name, edge in network.edges:
            self._leaving.setdefault((name, edge.source), []).append(edge)
        self._blocks, self._robots = blocks_of(strategy), strategy.commanded
        self._places = {automaton.name: automaton.initial for automaton in network.automata}
        self._values = dict(network.variables)
        self._clocks = dict.fromkeys(network.clocks, 0.0)
        self.now = self.driven = 0.0

    def goes_on(self, until: float) -> bool:
        """Makes the next move; False where there is none, or it comes later than that."""
        delay, name, edge = min(self._possible(), key=lambda move: move[0], default=(until - self.now, "", None))
        self.now += delay
        if self.now >= until or edge is None:
            return False
        for clock in self._clocks:
            self._clocks[clock] += delay
        if name in self._robots and edge.sets_off:
            self.driven += float(self._automata[name].longest.get(edge.target, 0))
        for who, taken in [(name, edge), *self._received(name, edge)]:
            self._places[who] = taken.target
            self._values.update(taken.assign)
            self._clocks.update(dict.fromkeys(taken.resets, 0.0))
        return True

    def _possible(self) -> Iterator[Tuple[float, str, Optional[Edge]]]:
        """What may come next, after which time: commands, and the ends of what may not go on for longer."""
        for _, block in self._blocks.find({**self._places, **self._values}):
            for command in block.commands:
                sent = command.moves[0]
                delays = [delay for delay in map(self._until, command.zones) if delay is not None]
                if delays and sent.edge.guard.holds(self._values):
                    yield min(delays), sent.automaton, sent.edge
        for name, place in self._places.items():
            for bound in self._automata[name].stays.get(place, ()):
                yield max(0.0, float(bound.bound) - self._clocks[bound.clock]), name, self._end(name, place)

    def _end(self, name: str, place: str) -> Optional[Edge]:
        edges = self._leaving.get((name, place), ())
        ends = (edge for edge in edges if not edge.controllable and edge.received is None)
        return next((edge for edge in ends if edge.guard.holds(self._values)), None)

    def _received(self, sender: str, sent: Edge) -> List[Tuple[str, Edge]]:
        found: Dict[str, Edge] = {}
        for name, place in self._places.items():
            for edge in self._leaving.get((name, place), ()) if sent.channel is not None and name != sender else ():
                if edge.received == sent.channel and edge.guard.holds(self._values):
                    found.setdefault(name, edge)
        return list(found.items())

    def _until(self, zone: Zone) -> Optional[float]:
        """After which time the clocks are in the zone; None: they never are."""
        low, high = 0.0, float("inf")
        for each in zone:
            left, right = (0.0 if clock is None else self._clocks[clock] for clock in (each.left, each.right))
            room, hair = float(each.bound) - (left - right), _SOON if each.strict else 0.0
            if each.right is None:
                high = min(high, room)
            elif each.left is None:
                low = max(low, hair - room)
            elif room < 0:
                return None
        return low if low <= high else None
