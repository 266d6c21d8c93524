"""Steps of a recorded mission, and how late commands took effect."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.synthesis.strategy import Zone
from pursue_gen.tools.replay.moves import Move, place_of
from pursue_gen.tools.replay.orders import Orders, due_since
from pursue_gen.tools.replay.record import RecordedWord
from pursue_runtime.state import RUNNING, SystemState

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
