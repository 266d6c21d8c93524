"""When a state began that was recorded late.

A node may be killed when it has published a state to some nodes only: then the recording holds this state with a later
stamp, as the observer published it again. The clocks that its step resets say how long the state had been there.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, Mapping, NamedTuple, Sequence

from pursue_gen.replay.moves import Moves, after, place_of
from pursue_runtime.state import WAITING, SystemState

EXACT = 0.001
"""Seconds by which a clock may be beside the stamps."""


class Beginnings(NamedTuple):
    """The states with those that were missing, and the seconds by which each number was recorded late."""

    states: Sequence[SystemState]
    late: Mapping[int, float]


def with_beginnings(states: Sequence[SystemState], moves: Moves) -> Beginnings:
    """Add to each state whose first copy is a later one the state as it was when it began."""
    found: List[SystemState] = []
    late: Dict[int, float] = {}
    for state in states:
        before = found[-1] if found else None
        passed = 0.0 if before is None or state.seq != before.seq + 1 else _passed(before, state, moves)
        if passed:
            late[state.seq] = passed
            clocks = {clock: value - passed / state.unit for clock, value in state.clocks.items()}
            found.append(state._replace(stamp=state.stamp - passed, clocks=clocks))
        found.append(state)
    return Beginnings(found, late)


def _passed(before: SystemState, state: SystemState, moves: Moves) -> float:
    """The seconds since the step into this state, by the clocks that it reset; 0 where they do not say it."""
    for resets in _resets(before, state, moves):
        ages = [state.clocks.get(clock, 0.0) * state.unit for clock in resets]
        if ages and min(ages) > EXACT and max(ages) - min(ages) <= EXACT and state.stamp - min(ages) >= before.stamp:
            return min(ages)
    return 0.0


def _resets(before: SystemState, state: SystemState, moves: Moves) -> Iterator[Sequence[str]]:
    """The clocks that are reset on the way to this state, for each way."""
    if before.status == WAITING:
        yield moves.network.clocks
    elif state.event and moves.knows(place_of(before)):
        for move in moves.of(place_of(before), state.event, state.agent):
            place, resets = after(move, place_of(before))
            if place == place_of(state):
                yield resets
