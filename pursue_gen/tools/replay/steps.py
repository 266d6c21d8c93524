"""Steps of a recorded mission, how late commands took effect, and for how long they were due before something happened.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.synthesis.lookup import Entry
from pursue_gen.synthesis.strategy import Zone
from pursue_gen.tools.replay.moves import Move, Moves, place_of
from pursue_gen.tools.replay.orders import Orders, due_since
from pursue_gen.tools.replay.record import RecordedWord
from pursue_runtime.state import LIVE, RUNNING, SystemState

_PEOPLE = "UI"
"""Has the commands for people, who take their time."""


@dataclass(frozen=True)
class ReplayedStep:
    """A step from one state to the next: the move, and the word that it followed (None: an objective's own, or not
    recorded). `since`: the first state before it of which what was decided there for the mover still stood."""

    before: SystemState
    state: SystemState
    move: Move
    since: SystemState
    word: Optional[RecordedWord] = None

    @property
    def is_command(self) -> bool:
        """True where it followed a command."""
        return self.word is not None and self.word.seq is not None


def aged(before: SystemState, state: SystemState) -> Dict[str, float]:
    """The clocks of the state before, at the moment of this one."""
    passed = (state.stamp - before.stamp) / state.unit
    return {clock: value + passed for clock, value in before.clocks.items()}


def zones_of(orders: Orders, step: ReplayedStep) -> List[Zone]:
    """When the strategy has the command that a step followed."""
    wanted = step.move[0][0], step.state.event
    commands = orders.commands.find(place_of(step.before).facts)
    return [zone for command in commands if (command.agent, command.event) == wanted for zone in command.zones]


def delays(steps: Sequence[ReplayedStep], orders: Mapping[int, Orders]) -> Tuple[float, ...]:
    """How late commands of controllers took effect, in time units: since they were due, and had been decided.

    `orders`: the strategies by the number of their plan.
    """
    found: List[float] = []
    for step in steps:
        known = orders.get(step.before.plan)
        if not step.is_command or known is None or step.before.status != RUNNING:
            continue
        if not known.owners.get(step.move[0][0], frozenset()) - {_PEOPLE}:
            continue
        back = (step.state.stamp - step.since.stamp) / step.state.unit
        since = due_since(zones_of(known, step), aged(step.before, step.state), back)
        found += [] if since is None else [since]
    return tuple(found)


def where(state: SystemState) -> str:
    """Return where everything is in a state, in one line."""
    return " ".join(f"{name}={location}" for name, location in state.locations.items())


def change(before: SystemState, state: SystemState) -> str:
    """Return which locations and variables differ in the next state, in one line."""
    old: Dict[str, object] = {**before.locations, **before.values}
    new: Dict[str, object] = {**state.locations, **state.values}
    return ", ".join(f"{name}: {old[name]} to {new[name]}" for name in old if old[name] != new.get(name))


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
