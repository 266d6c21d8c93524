"""Assumptions in a recording: which were broken by a step, and what a word did that they excluded."""

from __future__ import annotations

from itertools import chain
from typing import List, Mapping, Sequence, Tuple

from pursue_gen.language.symbols import Role, role_of
from pursue_gen.tools.replay.moves import DiscreteState, Move, Moves

Found = Tuple[DiscreteState, List[Move]]
"""The place with the variables of broken assumptions at 0, and the moves that are possible there."""


def newly_broken(before: Mapping[str, int], now: Mapping[str, int]) -> Tuple[str, ...]:
    """The variables of the assumptions that hold among the values before, and not among those now."""
    return tuple(name for name in _holding(before) if now.get(name) == 0)


def _holding(values: Mapping[str, int]) -> List[str]:
    return [name for name, value in values.items() if value and role_of(name) is Role.ASSUMPTION]


def without(place: DiscreteState, broken: Sequence[str]) -> DiscreteState:
    """The place with these variables at 0."""
    return place._replace(values={**place.values, **dict.fromkeys(broken, 0)})


def breach(moves: Moves, place: DiscreteState, word: str, agent: str) -> Found:
    """What a word does that only assumptions exclude; no moves where something else excludes it.

    One assumption is broken where that suffices, else all that hold, as the observer has it.
    """
    standing = _holding(place.values)
    for some in chain(([name] for name in standing), [standing] if len(standing) > 1 else []):
        found = list(moves.of(without(place, some), word, agent))
        if found:
            return without(place, some), found
    return place, []


def overstayed(moves: Moves, place: DiscreteState, clocks: Mapping[str, float]) -> Tuple[str, ...]:
    """The variables of the assumptions by which somebody should have left by now."""
    over = {clock for clock, late in moves.exceeded(place, clocks).items() if late >= 0}
    return tuple(name for name in _holding(place.values) if moves.assumed[name] in over)
