"""When a state began that was recorded late.

A node may be killed when it has published a state to some nodes only: then the recording holds this state with a later
stamp, as the observer published it again. The text of a state that an acknowledgement follows at once is not published
at all. The clocks that its step resets say how long the state had been there.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence

from pursue_gen.tools.replay.moves import Moves, after, place_of
from pursue_runtime.state import ENDED, RUNNING, WAITING, SystemState

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
        begun = [] if before is None or state.seq != before.seq + 1 else _begun(before, state, moves)
        if begun:
            late[state.seq] = state.stamp - begun[0].stamp
        found += begun or [state]
    return Beginnings(found, late)


def _begun(before: SystemState, state: SystemState, moves: Moves) -> List[SystemState]:
    """The state when it began and, if time has passed since, as it was then; none: it began now, or the clocks do not
    say when.

    The clocks that its step reset say for how long it had been there. The clocks of an end stay as they were then: all
    others say how long ago that was.
    """
    for resets in _resets(before, state, moves):
        kept = [clock for clock in before.clocks if clock not in resets and clock in state.clocks]
        since = [(state.clocks[clock] - before.clocks[clock]) * state.unit for clock in kept]
        over = _one([state.stamp - before.stamp - each for each in since]) if state.status in ENDED else 0.0
        age = _one([state.clocks.get(clock, 0.0) * state.unit for clock in resets])
        if over is None or age is None or not over + age or state.stamp - over - age < before.stamp:
            continue
        shown = state._replace(stamp=state.stamp - over)
        if not age:
            return [shown]
        clocks = {clock: value - age / state.unit for clock, value in state.clocks.items()}
        begun = shown._replace(stamp=shown.stamp - age, clocks=clocks)
        return [begun._replace(status=RUNNING, reason="") if state.status in ENDED else begun, shown]
    return []


def _one(times: Sequence[float]) -> Optional[float]:
    """The one length of time that all of these are, 0 where there is none; None where they do not agree."""
    if not times or max(map(abs, times)) <= EXACT:
        return 0.0
    return min(times) if min(times) > EXACT and max(times) - min(times) <= EXACT else None


def _resets(before: SystemState, state: SystemState, moves: Moves) -> Iterator[Sequence[str]]:
    """The clocks that are reset on the way to this state, for each way."""
    if before.status == WAITING:
        yield moves.network.clocks
    elif state.event and moves.knows(place_of(before)):
        for move in moves.of(place_of(before), state.event, state.agent):
            place, resets = after(move, place_of(before))
            if place == place_of(state):
                yield resets
