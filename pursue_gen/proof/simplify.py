"""Simplify a strategy: fewer zones and bounds, the same plays.

In each discrete state zones with one action become one where their hull meets no other action, and bounds go that only
keep out points of which the strategy says nothing. The points with an action keep it, so zones never shrink, and the
plays do not change:

- no point gets a second action;
- time does not take a command's zone to new points of that command, so it is decided where it was decided before;
- a command that is on its way does not meet new points of another one.

A play that comes to a new point would have met none of the strategy's zones before, which a proven strategy rules out.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.proof.native.tables import Bound, tables_of
from pursue_gen.synthesis.limits import NO_LIMITS, PROVING, LimitMonitor, Limits
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
    ranks: Optional[Mapping[ZoneKey, int]] = None,
    limits: Limits = NO_LIMITS,
) -> Strategy:
    """The strategy in fewer zones and bounds (simplify.hpp). Requires that it is proven for the network and the
    reaction.

    `ranks` (see `verify`) allow more: a play may stay in a command's zone where that leads to no higher rank. Raises
    PursueError with exit status 5 at a limit, and where times or clocks are too large or too many.
    """
    assert reaction >= 0
    tables = tables_of(network, strategy)
    if not tables.whole:
        return strategy
    scale = least_common_multiple([tables.scale, reaction.denominator])
    late, monitor = int(reaction * scale), LimitMonitor(limits, phase=PROVING)
    numbers = tables.numbers(ranks, _UNKNOWN) if ranks else None
    found = tables.simplify(tables.factor(scale, late), late, numbers, monitor)
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
