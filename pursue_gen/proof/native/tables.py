"""A network and a strategy as the integer tables of the native checker (see tables.hpp)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.language.numbers import Number
from pursue_gen.outcomes import Invalid
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.native import not_built, not_held
from pursue_gen.synthesis.strategy import Constraint, DiscreteState, Move, Strategy, Zone, ZoneKey
from pursue_gen.tga.network import ClockBound, Edge, Network
from pursue_gen.tga.scale import common_denominator, least_common_multiple

try:
    from pursue_gen.proof.native import _proof
except ImportError:  # no compiler when the package was installed
    _proof = None  # type: ignore[assignment]

_MOST, _VALUES = 1 << 50, 1 << 31
"""The bounds of the tables: constants, values of variables."""

_MOST_FACTOR, _MOST_DELAY = 1 << 40, (1 << 30) - 1
"""What the tables' constants may be multiplied by, and scaled delays, at most."""

Bound = Tuple[int, int, int]
"""Two clocks (0: none) and the raw bound of their difference."""

Smaller = List[List[List[List[Bound]]]]


@dataclass(frozen=True)
class Tables:
    """The tables, with constants multiplied by `scale`.

    `firsts`: the number of the first zone of each block, in the order in which the tables number zones; then that of
    all zones. `whole`: every block is for a discrete state of the network. `edges`: the network's, by their numbers.
    `locations`: the numbers of each automaton's.
    """

    native: Any
    network: Network
    strategy: Strategy
    scale: int
    firsts: Tuple[int, ...]
    whole: bool
    edges: Tuple[Move, ...]
    locations: Sequence[Mapping[str, int]]

    def factor(self, scale: int, delay: int) -> int:
        """What makes the tables' times those of this scale. Raises LimitHit for one, or a scaled delay, too large."""
        factor = scale // self.scale
        if factor > _MOST_FACTOR or delay > _MOST_DELAY:
            raise not_held("checker")
        return factor

    def loop(self, settings: Dict[str, Any]) -> _proof.Loop:
        """The native closed loop."""
        return _proof.Loop(self.native, settings)

    def simplify(self, factor: int, late: int, ranks: Optional[Sequence[int]], monitor: LimitMonitor) -> Smaller:
        """Of each block the zones of each action, to wait first, as bounds in a scale that is `factor` times finer.

        Empty where the block's invariant holds nowhere. Raises LimitHit where times or clocks do not fit.
        """
        try:
            return _proof.simplify(self.native, factor, late, ranks, monitor.check)
        except OverflowError:
            raise not_held("checker") from None

    def places(self, places: Iterable[Tuple[int, str]]) -> List[Tuple[int, int]]:
        """Locations of automata, by the numbers of both."""
        return [(k, self.locations[k][name]) for k, name in places]

    def numbers(self, values: Mapping[ZoneKey, int], default: int) -> List[int]:
        """The values of all zones, in the tables' order."""
        keys = (key for b in range(len(self.strategy.blocks)) for key in self.strategy.keys_of(b))
        return [values.get(key, default) for key in keys]

    def keys(self, numbers: Sequence[int]) -> List[ZoneKey]:
        """Where the zones with these numbers, which rise, stand in the strategy."""
        found: List[ZoneKey] = []
        b = -1
        keys: List[ZoneKey] = []
        for number in numbers:
            while number >= self.firsts[b + 1]:
                b += 1
                keys = []
            keys = keys or self.strategy.keys_of(b)
            found.append(keys[number - self.firsts[b]])
        return found


_KEPT = 50_000
"""So many blocks the tables that were made last have, but for the last ones. Measured on a patrol of 140 places."""

_LEAST = 50
"""So many blocks any tables count as at least. Not measured."""


class _Latest:
    """The tables that were made last: one strategy is checked several times in a row, or each part of it."""

    def __init__(self) -> None:
        self._tables: Dict[int, List[Tables]] = {}  # by the identity of their strategies, which they hold
        self._blocks = 0

    def known(self, network: Network, strategy: Strategy) -> Optional[Tables]:
        """Those of this strategy in this network, where they are kept."""
        return next((tables for tables in self._tables.get(id(strategy), ()) if tables.network == network), None)

    def keep(self, made: Tables) -> Tables:
        """Keeps them, in place of the oldest ones; returns them."""
        same = self._tables.pop(id(made.strategy), [])
        self._tables[id(made.strategy)] = [*same, made]
        self._blocks += _counted(made)
        while len(self._tables) > 1 and self._blocks > _KEPT:
            self._blocks -= sum(map(_counted, self._tables.pop(next(iter(self._tables)))))
        return made


_latest = _Latest()


def _counted(tables: Tables) -> int:
    return max(_LEAST, len(tables.strategy.blocks))


def tables_of(network: Network, strategy: Strategy) -> Tables:
    """The tables. Raises LimitHit where they cannot hold it, Unavailable where the native checker was not built, and
    Invalid for a strategy with clocks that the network does not have."""
    if _proof is None:
        raise not_built("checker")
    return _latest.known(network, strategy) or _latest.keep(_Maker(network).tables(strategy))


class _Maker:
    """Names to numbers."""

    def __init__(self, network: Network) -> None:
        self.network = network
        self.clocks: Dict[Optional[str], int] = {None: 0, **{name: k + 1 for k, name in enumerate(network.clocks)}}
        self.variables = {name: k for k, (name, _) in enumerate(network.variables)}
        self.locations = [{place.name: n for n, place in enumerate(a.locations)} for a in network.automata]
        self.places = [
            {(a.name, name): n for name, n in names.items()} for a, names in zip(network.automata, self.locations)
        ]
        self.channels: Dict[str, int] = {}
        self.kinds: Dict[Tuple[str, Edge], int] = {}
        self.known: Dict[Tuple[str, int], int] = {}  # the kinds by the identity of edges: most are the network's own

    def tables(self, strategy: Strategy) -> Tables:
        """All tables."""
        network = self.network
        # Most constraints and zones are met again and again, so they are known by their identity.
        numbers: Dict[int, int] = {}
        known: Dict[int, List[int]] = {}
        constraints: List[Constraint] = []

        def zones(some: Sequence[Zone]) -> List[List[int]]:
            return [known.get(id(zone)) or table(zone) for zone in some]

        def table(zone: Zone) -> List[int]:
            result = known[id(zone)] = []
            for constraint in zone:
                number = numbers.get(id(constraint))
                if number is None:
                    number = numbers[id(constraint)] = len(constraints)
                    constraints.append(constraint)
                result.append(number)
            return result

        edges = self._edges()
        blocks = [
            (
                self._state(block.state),
                zones(block.wait),
                [(list(map(self._kind, command.moves)), zones(command.zones)) for command in block.commands],
            )
            for block in strategy.blocks
        ]
        scale = least_common_multiple([strategy.scale, common_denominator(network.times)])
        bounds = [self._constraint(constraint, scale) for constraint in constraints]
        firsts = [0]
        for _, wait, commands in blocks:
            firsts.append(firsts[-1] + len(wait) + sum(len(some) for _, some in commands))
        native = _proof.Tables(self._network(edges, scale), blocks, bounds)
        whole = all(state is not None for state, _, _ in blocks)
        named = tuple(Move(network.automata[k].name, edge) for k, edge in edges)
        return Tables(native, network, strategy, scale, tuple(firsts), whole, named, self.locations)

    def _state(self, state: DiscreteState) -> Optional[List[int]]:
        network = self.network
        if len(state.locations) != len(network.automata) or len(state.values) != len(network.variables):
            return None
        places = [names.get(place) for names, place in zip(self.places, state.locations)]
        if None in places or any(name != own for (name, _), (own, _) in zip(state.values, network.variables)):
            return None
        values = [value for _, value in state.values]
        return None if any(not _fits(value) for value in values) else [*(n for n in places if n is not None), *values]

    def _edges(self) -> List[Tuple[int, Edge]]:
        found: List[Tuple[int, Edge]] = []
        for k, automaton in enumerate(self.network.automata):
            for edge in automaton.edges:
                kind = self.kinds.setdefault((automaton.name, edge), len(found))
                self.known[automaton.name, id(edge)] = kind
                found.append((k, edge))
        return found

    def _kind(self, move: Move) -> int:
        known = self.known.get((move.automaton, id(move.edge)))
        return self.kinds.get((move.automaton, move.edge), -1) if known is None else known

    def _network(self, edges: Sequence[Tuple[int, Edge]], scale: int) -> Dict[str, Any]:
        automata = []
        for k, automaton in enumerate(self.network.automata):
            leaving: List[List[int]] = [[] for _ in automaton.locations]
            for n, (owner, edge) in enumerate(edges):
                if owner == k:
                    leaving[self.locations[k][edge.source]].append(n)
            invariants = [self._bounds(place.invariant, scale) for place in automaton.locations]
            automata.append({"invariants": invariants, "leaving": leaving})
        initial = [names[a.initial] for a, names in zip(self.network.automata, self.locations)]
        return {
            "clocks": len(self.network.clocks),
            "initial": initial + [_held(value) for _, value in self.network.variables],
            "automata": automata,
            "edges": [self._edge(k, edge, scale) for k, edge in edges],
        }

    def _edge(self, k: int, edge: Edge, scale: int) -> Dict[str, Any]:
        sync = edge.sync
        return {
            "kind": self.known[self.network.automata[k].name, id(edge)],
            "source": self.locations[k][edge.source],
            "target": self.locations[k][edge.target],
            "guard": self._bounds(edge.guard.clocks, scale),
            "clauses": [
                [(self.variables[test.variable], _held(test.value)) for test in clause]
                for clause in edge.guard.integers
            ],
            "channel": -1 if sync is None else self.channels.setdefault(sync.channel, len(self.channels)),
            "sends": sync is None or sync.sends,
            "assign": [(self.variables[name], _held(value)) for name, value in edge.assign],
            "resets": [self.clocks[name] for name in edge.resets],
            "controllable": edge.controllable,
        }

    def _bounds(self, bounds: Sequence[ClockBound], scale: int) -> List[Bound]:
        found: List[Bound] = []
        for bound in bounds:
            x, constant = self.clocks[bound.clock], bound.bound
            if bound.op in ("<", "<=", "=="):
                found.append((x, 0, _raw(constant, scale, bound.op == "<")))
            if bound.op in (">", ">=", "=="):
                found.append((0, x, _raw(-constant, scale, bound.op == ">")))
        return found

    def _constraint(self, constraint: Constraint, scale: int) -> Bound:
        sides = constraint.left, constraint.right
        unknown = [clock for clock in sides if clock not in self.clocks]
        if unknown:
            hint = f"the clocks are {', '.join(self.network.clocks)}"
            raise Invalid([error("SYN104", f"the strategy speaks of a clock {unknown[0]}", hint=hint)])
        i, j = (self.clocks[clock] for clock in sides)
        return i, j, _raw(constraint.bound, scale, constraint.strict)


def _raw(bound: Number, scale: int, strict: bool) -> int:
    constant = bound.numerator * (scale // bound.denominator)
    if abs(constant) >= _MOST:
        raise not_held("checker")
    return 2 * constant + (not strict)


def _fits(value: int) -> bool:
    return -_VALUES <= value < _VALUES


def _held(value: int) -> int:
    if not _fits(value):
        raise not_held("checker")
    return value
