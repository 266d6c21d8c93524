"""Strategies in fewer zones and bounds, in C++ (simplify.hpp)."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.proof.native.tables import MOST_DELAY, MOST_FACTOR, MOST_RANK, Bound, NotHeld, tables_of
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.strategy import Block, Command, Constraint, Strategy, Zone, ZoneKey
from pursue_gen.tga.network import Network
from pursue_gen.tga.scale import least_common_multiple
from pursue_gen.zones.dbm import constant, is_strict

_UNKNOWN = -(1 << 63)
"""How simplify.hpp writes that no rank is known."""


def simplified(
    network: Network,
    strategy: Strategy,
    reaction: Fraction,
    ranks: Optional[Mapping[ZoneKey, int]],
    monitor: LimitMonitor,
) -> Strategy:
    """As `proof.simplify.simplified`. Raises NotHeld where the native checker cannot do it."""
    tables = tables_of(network, strategy)
    scale = least_common_multiple([tables.scale, reaction.denominator])
    factor, late = scale // tables.scale, int(reaction * scale)
    held = factor <= MOST_FACTOR and late <= MOST_DELAY and all(abs(r) < MOST_RANK for r in (ranks or {}).values())
    if not tables.whole or not held:
        raise NotHeld
    numbers = tables.numbers(ranks, _UNKNOWN) if ranks else None
    try:
        found = tables.simplify(factor, late, numbers, monitor)
    except OverflowError:
        raise NotHeld from None
    names = (None, *network.clocks)
    known: Dict[Bound, Constraint] = {}

    def zones(some: Sequence[Sequence[Bound]]) -> Tuple[Zone, ...]:
        result: List[Zone] = []
        for zone in some:
            for bound in zone:
                if bound not in known:
                    i, j, raw = bound
                    known[bound] = Constraint(names[i], names[j], Fraction(constant(raw), scale), is_strict(raw))
            result.append(tuple(known[bound] for bound in zone))
        return tuple(result)

    def smaller(block: Block, actions: Sequence[Sequence[Sequence[Bound]]]) -> Block:
        if not actions:  # the invariant holds nowhere
            return block
        commands = (Command(zones(some), command.moves) for command, some in zip(block.commands, actions[1:]) if some)
        return Block(block.state, zones(actions[0]), tuple(commands))

    return replace(strategy, blocks=tuple(map(smaller, strategy.blocks, found)))
