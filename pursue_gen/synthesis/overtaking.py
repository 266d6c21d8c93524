"""Commands kept apart in time, so that none that is on its way is overtaken by one that leads less far.

An engine's command leads to lower ranks if nothing else is decided before it takes effect. But time may take the state
out of the command's zone meanwhile, into that of another one with a higher rank, which another robot (or the same one,
started again) then decides: what was gained is lost, over and over. So that zone begins later: its points that time
reaches from the first command within the reaction are waited in. That is no loss where time goes on to other points of
the same zone, as who is there may act anywhere on the way through it, or to a zone that ranks no higher.
"""

from __future__ import annotations

from typing import Iterable, List, Optional, Sequence, Tuple

from pursue_gen.synthesis.game import Action, Game, RawBlock
from pursue_gen.zones.dbm import Dbm
from pursue_gen.zones.federation import Federation, predt

Piece = Tuple[Dbm, Action]

Ranks = Tuple[int, ...]
"""The rank of each of a block's pieces."""


def without_overtaking(
    game: Game, blocks: Iterable[RawBlock], ranks: Iterable[Ranks]
) -> Tuple[Tuple[RawBlock, ...], Tuple[Ranks, ...]]:
    """The blocks of a reach game and their ranks, with later beginnings where commands may be overtaken.

    Requires disjoint pieces in each block, and a rank of each. A zone stays as it is where time takes none of its
    points to a part of it that is out of reach, or to another zone that ranks no higher: the checker finds out whether
    such a strategy wins.
    """
    new_blocks: List[RawBlock] = []
    new_ranks: List[Ranks] = []
    for block, numbers in zip(blocks, ranks):
        locations, values, raw_pieces = block
        if len({action for _, action in raw_pieces if action is not None}) > 1:
            pieces = [(Dbm(game.dim, tuple(matrix)), action) for matrix, action in raw_pieces]
            apart = kept_apart(pieces, numbers, game.delta)
            if len(apart) != len(pieces):
                block = (locations, values, tuple((zone.m, action) for (zone, action), _ in apart))
                numbers = tuple(rank for _, rank in apart)
        new_blocks.append(block)
        new_ranks.append(numbers)
    return tuple(new_blocks), tuple(new_ranks)


def kept_apart(pieces: Sequence[Piece], ranks: Sequence[int], late: int) -> List[Tuple[Piece, int]]:
    """The pieces of one discrete state with their ranks, when commands take effect up to `late` after they are due.

    Requires disjoint pieces; ensures the same, that together they hold the same points, and that each command's zone is
    in one that it had.
    """
    assert len(pieces) == len(ranks) and late >= 0
    flights = [
        (rank, action, zone.up_within(late)) for (zone, action), rank in zip(pieces, ranks) if action is not None
    ]
    result: List[Tuple[Piece, int]] = []
    for (zone, action), rank in zip(pieces, ranks):
        before = Federation(
            tuple(
                flight
                for lower, other, flight in flights
                if action is not None and lower < rank and other != action and zone.intersect(flight) is not None
            )
        )
        after = Federation((zone,)).minus(before)
        # On each line of time the points that are met in flight come first: the other zone lies before this one.
        met = before.intersect_zone(zone)
        if not met:
            result.append(((zone, action), rank))
            continue
        near, higher = _next(pieces, ranks, zone, rank, late)
        early = met.intersect(predt(after.union(near.minus(before)), higher))
        if early:
            command = after.union(met.minus(early)).disjoint()
            result += [((part, action), rank) for part in command]
            result += [((part, None), rank) for part in early.disjoint()]
        else:
            result.append(((zone, action), rank))
    return result


def ended_earlier(game: Game, blocks: Iterable[RawBlock], ranks: Iterable[Ranks]) -> Optional[Tuple[RawBlock, ...]]:
    """The blocks in which no command is on its way where another one of a higher rank is decided; None: they are so.

    Each command's zone ends so early that it takes effect before; the points that are left out are waited in, up to the
    other command's zone. Ranks hold across such blocks no more: the checker finds out whether the strategy wins.
    """
    new_blocks: List[RawBlock] = []
    changed = False
    for (locations, values, raw_pieces), numbers in zip(blocks, ranks):
        pieces = [(Dbm(game.dim, tuple(matrix)), action) for matrix, action in raw_pieces]
        apart = shortened(pieces, numbers, game.delta)
        changed = changed or len(apart) != len(pieces)
        new_blocks.append((locations, values, tuple((zone.m, action) for zone, action in apart)))
    return tuple(new_blocks) if changed else None


def shortened(pieces: Sequence[Piece], ranks: Sequence[int], late: int) -> List[Piece]:
    """The pieces of one discrete state: before a command of a higher rank, that of a lower one ends by `late`.

    Requires disjoint pieces; ensures that together they hold the same points.
    """
    assert len(pieces) == len(ranks) and late >= 0
    result: List[Piece] = []
    for (zone, action), rank in zip(pieces, ranks):
        flight = zone.up_within(late)
        later = [
            (other, what)
            for (other, what), r in zip(pieces, ranks)
            if action is not None and what not in (None, action) and r > rank and flight.intersect(other) is not None
        ]
        near = Federation(tuple(other.down_within(late) for other, _ in later)).intersect_zone(zone)
        if not near:
            result.append((zone, action))
            continue
        result += [(part, action) for part in Federation((zone,)).minus(near).disjoint()]
        result += [(part, None) for part in near.disjoint()]
    return result


def _next(
    pieces: Sequence[Piece], ranks: Sequence[int], zone: Dbm, rank: int, late: int
) -> Tuple[Federation, Federation]:
    """The other zones that time may reach before a command takes effect: those with no higher rank, and the others."""
    soon = zone.up_within(late)
    near: List[Dbm] = []
    higher: List[Dbm] = []
    for (other, _), r in zip(pieces, ranks):
        if other is not zone and soon.intersect(other) is not None:
            (near if r <= rank else higher).append(other)
    return Federation(tuple(near)), Federation(tuple(higher))
