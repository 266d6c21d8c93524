"""For how long commands were due in a mission before something happened."""

from __future__ import annotations

from typing import Dict, Mapping, Sequence, Tuple

from pursue_gen.synthesis.lookup import Entry
from pursue_gen.tools.replay.moves import Moves, place_of
from pursue_gen.tools.replay.orders import Orders, due_since
from pursue_gen.tools.replay.steps import ReplayedStep, aged
from pursue_runtime.state import LIVE, RUNNING, SystemState

_TOUCHED = 1.5e-5
"""Time units: clocks that are in a zone for no longer only touch it, and its bounds may be strict."""


def longest_due(
    states: Sequence[SystemState],
    until: float,
    steps: Sequence[ReplayedStep],
    moves: Moves,
    orders: Mapping[int, Orders],
) -> Tuple[float, str]:
    """The time units for which a command was due at most, and which command that was; the last state stands until the
    moment `until` (seconds).

    While a mission holds, its commands are late as well. `orders`: the strategies by the number of their plan.
    """
    found = 0.0, ""
    taken = {step.state.seq: step for step in steps}
    since: Dict[Entry, float] = {}  # when what each block decides was decided; else: when the last step was taken
    moved = decided = 0.0
    for before, state in zip(states, [*states[1:], states[-1]._replace(seq=-1, stamp=until)]):
        if state.seq == before.seq:
            continue
        known, step = orders.get(before.plan), taken.get(state.seq)
        if known is not None and before.status in LIVE:
            found = max(found, _due(before, state, known, since, moved, decided), key=lambda each: each[0])
        if state.plan != before.plan:
            decided = state.stamp
        if step is not None:
            goes_on = (before.status, state.status, before.plan) == (RUNNING, RUNNING, state.plan)
            place = place_of(step.before)
            since = known.after(step.move, place, moves, since, moved, state.stamp) if goes_on and known else {}
        if step is not None or before.seq == 0:
            moved = state.stamp
    return found


def _due(
    before: SystemState, state: SystemState, known: Orders, since: Mapping[Entry, float], moved: float, decided: float
) -> Tuple[float, str]:
    """For how long a command was due at most when this state came, and which one."""
    found, clocks = (0.0, ""), aged(before, state)
    for block in known.commands.holding(place_of(before).facts):
        stay = (state.stamp - max(decided, since.get(block, moved))) / before.unit
        for command in known.commands.entered(block):
            due = due_since(command.zones, clocks, stay, _TOUCHED)
            if due is not None and due > found[0]:
                found = due, f"{command.event} in state {before.seq}"
    return found
