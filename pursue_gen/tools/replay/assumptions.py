"""Assumptions in a recording: which were broken by a step, and what a word did that they excluded."""

from __future__ import annotations

from itertools import chain
from typing import Iterator, List, Mapping, Sequence, Tuple

from pursue_gen.language.network_names import assumption_clock, is_assumption
from pursue_gen.tools.replay.moves import DiscreteState, Move, Moves

Found = Tuple[DiscreteState, List[Move]]
"""The place with the variables of broken assumptions at 0, and the moves that are possible there."""


def newly_broken(before: Mapping[str, int], now: Mapping[str, int]) -> Tuple[str, ...]:
    """The variables of the assumptions that hold among the values before, and not among those now."""
    return tuple(name for name, value in before.items() if is_assumption(name) and value and now.get(name) == 0)


def without(place: DiscreteState, broken: Sequence[str]) -> DiscreteState:
    """The place with these variables at 0."""
    return place._replace(values={**place.values, **dict.fromkeys(broken, 0)})


def breach(moves: Moves, place: DiscreteState, word: str, agent: str) -> Found:
    """What a word does that only assumptions exclude; no moves where something else excludes it.

    One assumption is broken where that suffices, else all that hold, as the observer has it.
    """
    standing = [name for name, value in place.values.items() if is_assumption(name) and value]
    for some in chain(([name] for name in standing), [standing] if len(standing) > 1 else []):
        found = list(moves.of(without(place, some), word, agent))
        if found:
            return without(place, some), found
    return place, []


def overstayed(moves: Moves, place: DiscreteState, clocks: Mapping[str, float]) -> Tuple[str, ...]:
    """The variables of the assumptions by which somebody should have left by now."""
    return tuple(_overstayed(moves, place, clocks))


def _overstayed(moves: Moves, place: DiscreteState, clocks: Mapping[str, float]) -> Iterator[str]:
    over = {clock for clock, late in moves.exceeded(place, clocks).items() if late >= 0}
    numbers = (name for name, value in place.values.items() if is_assumption(name) and value)
    for name in numbers:
        if assumption_clock(int(name[len("assume") :])) in over:
            yield name
