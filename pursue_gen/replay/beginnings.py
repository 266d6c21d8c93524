"""When a state began that was recorded late.

A node may be killed when it has published a state to some nodes only: then the recording holds this state with a later
stamp, as the observer published it again. The clocks that its step resets say how long the state had been there.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence

from pursue_gen.replay.moves import Moves, after, place_of
from pursue_runtime.state import ENDED, WAITING, SystemState

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
        begun = None if before is None or state.seq != before.seq + 1 else _begun(before, state, moves)
        if begun is not None:
            late[state.seq] = state.stamp - begun.stamp
            found.append(begun)
        if begun is None or state.status not in ENDED:  # the clocks of an end stay as they were then
            found.append(state)
    return Beginnings(found, late)


def _begun(before: SystemState, state: SystemState, moves: Moves) -> Optional[SystemState]:
    """The state when it began, by the clocks that its step reset, or at the end by all others; None: it began now, or
    the clocks do not say when."""
    for resets in _resets(before, state, moves):
        if state.status in ENDED:
            kept = [clock for clock in before.clocks if clock not in resets and clock in state.clocks]
            since = [(state.clocks[clock] - before.clocks[clock]) * state.unit for clock in kept]
            ages = [state.stamp - before.stamp - each for each in since]
        else:
            ages = [state.clocks.get(clock, 0.0) * state.unit for clock in resets]
        if ages and min(ages) > EXACT and max(ages) - min(ages) <= EXACT and state.stamp - min(ages) >= before.stamp:
            passed = 0.0 if state.status in ENDED else min(ages) / state.unit
            clocks = {clock: value - passed for clock, value in state.clocks.items()}
            return state._replace(stamp=state.stamp - min(ages), clocks=clocks)
    return None


def _resets(before: SystemState, state: SystemState, moves: Moves) -> Iterator[Sequence[str]]:
    """The clocks that are reset on the way to this state, for each way."""
    if before.status == WAITING:
        yield moves.network.clocks
    elif state.event and moves.knows(place_of(before)):
        for move in moves.of(place_of(before), state.event, state.agent):
            place, resets = after(move, place_of(before))
            if place == place_of(state):
                yield resets
