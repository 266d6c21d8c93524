"""Assumptions about agents that are not controlled, watched during a mission.

What breaks an assumption is taken all the same: it has happened. The variable of the assumption becomes 0, and the plan
in force, which relies on it, is replaced by one that does not.
"""

from __future__ import annotations

from itertools import chain
from typing import AbstractSet, NamedTuple, Optional, Tuple

from pursue_runtime.event_words import Word
from pursue_runtime.model import Assumption, Model, Move, Position
from pursue_runtime.sentences import quoted
from pursue_runtime.zones import EPSILON


class Breach(NamedTuple):
    """Moves that are possible once these assumptions do not hold."""

    assumptions: Tuple[Assumption, ...]
    moves: Tuple[Move, ...]


def broken_reason(model: Model, position: Position, not_assumed: AbstractSet[str]) -> str:
    """Return which assumptions have been broken that the plan in force relies on; "" if there are none.

    `not_assumed`: the variables of those on which it does not rely.
    """
    broken = (each for each in model.assumptions if position.values[each.variable] == 0)
    says = [each.says for each in broken if each.variable not in not_assumed]
    return f"what was assumed is broken: {quoted('; '.join(says))}" if says else ""


def breach(model: Model, position: Position, word: Word, timed: bool) -> Optional[Breach]:
    """Return what a word does that only assumptions exclude here, and these; None if something else excludes it.

    One assumption is named where that suffices, else all that have not been broken yet.
    """
    standing = tuple(each for each in model.assumptions if position.values[each.variable])
    singles = ((each,) for each in standing)
    for some in chain(singles, [standing] if len(standing) > 1 else []):
        moves = model.joint_move(without(position, some), word.event, word.agent, timed)
        if moves:
            return Breach(some, moves)
    return None


def overstayed(model: Model, position: Position, automaton: str, tolerance: float) -> Tuple[Assumption, ...]:
    """Return the assumptions by which the automaton should have left its location, for at least the tolerance (time
    units)."""
    clocks = {
        bound.left
        for bound in model.bounds_of(automaton, position.locations[automaton], position.values)
        if position.clocks[bound.left] - bound.bound >= tolerance - EPSILON
    }
    return tuple(each for each in model.assumptions if each.clock in clocks)


def without(position: Position, assumptions: Tuple[Assumption, ...]) -> Position:
    """Return the position in which these assumptions have been broken."""
    return position._replace(values={**position.values, **{each.variable: 0 for each in assumptions}})
