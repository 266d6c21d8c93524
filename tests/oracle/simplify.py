"""The readable twin of what puts strategies into fewer zones (`proof.simplify` says why plays do not change)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

from pursue_gen.synthesis.limits import NO_LIMITS, PROVING, LimitMonitor, Limits
from pursue_gen.synthesis.solve import minimal
from pursue_gen.synthesis.strategy import Block, Command, Constraint, Strategy, Zone, ZoneKey
from pursue_gen.tga.network import Network
from pursue_gen.tga.scale import common_denominator
from pursue_gen.zones.dbm import Dbm, constant, is_strict, raw
from tests.oracle.unions import outside
from tests.oracle.zones import hull

Bound = Tuple[int, int, int]

Action = Union[int, str]
"""The number of a command in its block, or WAIT."""

WAIT = "wait"


@dataclass(frozen=True)
class _BoundedZone:
    """A zone of an action within the invariant, and the bounds that make it there."""

    zone: Dbm
    bounds: Tuple[Bound, ...] = ()


@dataclass(frozen=True)
class _Origin:
    """A zone that the action had, and its rank if that is known."""

    zone: Dbm
    rank: Optional[int]

    def leads_to(self, other: _Origin) -> bool:
        """True if a command that is due here may as well be given there."""
        return self is other or (self.rank is not None and other.rank is not None and other.rank <= self.rank)


@dataclass(frozen=True)
class _Place:
    """A discrete state: its invariant, how late a command may come (scaled), and for each action the zones that it had
    and the parts that it has."""

    invariant: Dbm
    late: int
    origins: Dict[Action, Tuple[_Origin, ...]]
    parts: Dict[Action, List[_BoundedZone]]

    def may_have(self, action: Action, zone: Dbm) -> bool:
        """True if the action may have this zone, too: no play notices."""
        for other, parts in self.parts.items():
            if other != action and any(zone.intersect(part.zone) is not None for part in parts):
                return False
        if action == WAIT:
            return True
        mine = self.origins[action]
        in_zone = ((zone.intersect(origin.zone), origin) for origin in mine)
        return all(
            self._adds_nothing(zone, met.up(), [other.zone for other in mine if origin.leads_to(other)])
            for met, origin in in_zone
            if met is not None
        ) and all(
            self._adds_nothing(zone, origin.zone.up_within(self.late), [other.zone for other in mine])
            for action_in_flight, origins in self.origins.items()
            if action_in_flight not in (WAIT, action) and self.late
            for origin in origins
        )

    def _adds_nothing(self, zone: Dbm, later: Dbm, known: Sequence[Dbm]) -> bool:
        """True if all points of the zone that are met later are known ones."""
        met = zone.intersect(later)
        met = None if met is None else met.intersect(self.invariant)
        return met is None or not outside(met, known)


class _Units:
    """Names and exact times on one side, indices and integers on the other."""

    def __init__(self, network: Network, strategy: Strategy, reaction: Fraction) -> None:
        self.names = (None, *network.clocks)
        self._index = {name: k for k, name in enumerate(self.names)}
        self.scale = common_denominator([reaction, *network.times, *(c.bound for c in strategy.constraints)])
        self.late = int(reaction * self.scale)
        self._invariants = {
            (automaton.name, location.name): tuple(
                (self._index[b.clock], 0, raw(int(b.bound * self.scale), b.op == "<")) for b in location.invariant
            )
            for automaton in network.automata
            for location in automaton.locations
        }

    def invariant(self, block: Block) -> Optional[Dbm]:
        """Where the clocks may be in the block's discrete state."""
        bounds = (bound for place in block.state.locations for bound in self._invariants.get(place, ()))
        return Dbm.of(len(self.names), bounds)

    def bounds(self, zone: Zone) -> Tuple[Bound, ...]:
        """The zone's constraints as bounds of matrices."""
        return tuple(
            (self._index[c.left], self._index[c.right], raw(self._scaled(c.bound), c.strict)) for c in zone
        )

    def zone(self, bounds: Iterable[Bound]) -> Zone:
        """The bounds as a strategy's zone."""
        return tuple(
            Constraint(self.names[i], self.names[j], Fraction(constant(bound), self.scale), is_strict(bound))
            for i, j, bound in bounds
        )

    def _scaled(self, bound: Fraction) -> int:
        return bound.numerator * (self.scale // bound.denominator)


def simplified(
    network: Network,
    strategy: Strategy,
    reaction: Fraction,
    ranks: Optional[Mapping[ZoneKey, int]] = None,
    limits: Limits = NO_LIMITS,
) -> Strategy:
    """What the native checker finds."""
    units, monitor = _Units(network, strategy, reaction), LimitMonitor(limits, phase=PROVING)
    blocks: List[Block] = []
    with monitor:
        for b, block in enumerate(strategy.blocks):
            monitor.check(b, len(strategy.blocks) - b)
            blocks.append(_simplified_block(units, b, block, ranks or {}))
    return replace(strategy, blocks=tuple(blocks))


def _simplified_block(units: _Units, b: int, block: Block, ranks: Mapping[ZoneKey, int]) -> Block:
    """The block, number b of the strategy, in fewer zones."""
    invariant = units.invariant(block)
    if invariant is None:
        return block
    zones: Dict[Action, Tuple[Zone, ...]] = {WAIT: block.wait}
    zones.update((k, command.zones) for k, command in enumerate(block.commands))
    origins: Dict[Action, Tuple[_Origin, ...]] = {}
    for action, some in zones.items():
        within = ((n, invariant.constrained_all(units.bounds(zone))) for n, zone in enumerate(some))
        origins[action] = tuple(_Origin(zone, ranks.get((b, action, n))) for n, zone in within if zone is not None)
    parts = {action: [_BoundedZone(origin.zone) for origin in some] for action, some in origins.items()}
    place = _Place(invariant, units.late, origins, parts)
    commands_first: List[Action] = [*range(len(block.commands)), WAIT]
    for action in commands_first:
        _merge(place, action)
    for action in commands_first:
        _relax(place, action)
        _drop(place, action)
    return Block(
        block.state,
        tuple(units.zone(part.bounds) for part in parts[WAIT]),
        tuple(
            Command(tuple(units.zone(part.bounds) for part in parts[k]), command.moves)
            for k, command in enumerate(block.commands)
            if parts[k]
        ),
    )


def _merge(place: _Place, action: Action) -> None:
    """Fewer zones for the action, where a hull of some will do."""
    parts = place.parts[action]
    together = _together(place, action, parts) if len(parts) > 2 else None
    if together is not None:
        parts[:] = [together]
    k = 0
    while k < len(parts):
        n = k + 1
        while n < len(parts):
            together = _together(place, action, (parts[k], parts[n]))
            if together is None:
                n += 1
            else:
                parts[k] = together
                del parts[n]
                n = k + 1
        k += 1


def _together(place: _Place, action: Action, parts: Sequence[_BoundedZone]) -> Optional[_BoundedZone]:
    """The parts of the action as one, or None."""
    whole = parts[0].zone
    for part in parts[1:]:
        whole = hull(whole, part.zone)
    return _BoundedZone(whole) if place.may_have(action, whole) else None


def _relax(place: _Place, action: Action) -> None:
    """Fewer bounds for each zone of the action; differences go first, then upper bounds, then lower ones."""
    parts = place.parts[action]
    for k, part in enumerate(parts):
        kept, zone = minimal(part.zone.dim, part.zone.m), part.zone
        for bound in sorted(kept, key=_worth):
            fewer = [other for other in kept if other != bound]
            larger = place.invariant.constrained_all(fewer)
            if larger is not None and (larger == zone or place.may_have(action, larger)):
                kept, zone = fewer, larger
        parts[k] = _BoundedZone(zone, tuple(kept))


def _worth(bound: Bound) -> Tuple[int, int, int]:
    i, j, _ = bound
    return (0 if i and j else 1 if i else 2, i, j)


def _drop(place: _Place, action: Action) -> None:
    """No zone of the action that the others cover."""
    parts = place.parts[action]
    for k in reversed(range(len(parts))):
        zone, rest = parts[k].zone, [other.zone for n, other in enumerate(parts) if n != k]
        # A command is decided before time leaves the zone in which it was met: a zone may go if one other covers it.
        idle = not outside(zone, rest) if action == WAIT else any(other.includes(zone) for other in rest)
        if idle:
            del parts[k]
