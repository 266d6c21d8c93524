"""When each door is asked to open and to close, and for whom it is open. Times are seconds of ROS time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Collection, Dict, FrozenSet, Mapping, NamedTuple

from pursue_runtime.data import DataError
from pursue_runtime.doors.asking import SETTLE, Asking, Keeper
from pursue_runtime.doors.opened import Opened
from pursue_runtime.state import SystemState

AskedBy = Mapping[str, Collection[str]]
"""Agent → the locations of the agent in which it needs a door: it is on a way through it."""


class DoorData(NamedTuple):
    """What ui.yaml says of a door; `within`: the time units in which it is open at the latest."""

    within: float
    asked_by: AskedBy


def read_doors(settings: Mapping[str, Any]) -> Dict[str, DoorData]:
    """Return the doors in the content of ui.yaml. Raises DataError."""
    doors = settings.get("doors", {})
    if not isinstance(doors, dict):
        raise DataError("ui.yaml: expected doors: and a line for each door")
    for name, door in doors.items():
        asked_by = door.get("asked_by") if isinstance(door, dict) else None
        if not isinstance(asked_by, dict) or not isinstance(door.get("within"), (int, float)):
            raise DataError(f"ui.yaml: expected within: and asked_by: of the door {name}, got {door!r}")
    return {name: DoorData(float(door["within"]), door["asked_by"]) for name, door in doors.items()}


@dataclass
class _Door(Asking):
    """A door, and for whom it is to be open."""

    needed_in: Dict[str, FrozenSet[str]] = field(default_factory=dict)
    wanted_by: FrozenSet[str] = frozenset()


class DoorKeeper(Keeper):
    """Has each door open as long as somebody who asks for it is on a way through it, and closed otherwise.

    A door counts as open for whoever has asked when it reports that, after it was asked to open. A door is never asked
    to close while somebody is on the way, also if the mission is over, or holds.
    """

    def __init__(self, doors: Mapping[str, DoorData]) -> None:
        self._within = {name: door.within for name, door in doors.items()}
        self._doors = {
            name: _Door(needed_in={agent: frozenset(locations) for agent, locations in door.asked_by.items()})
            for name, door in doors.items()
        }
        super().__init__(self._doors)

    def on_state(self, state: SystemState, now: float) -> None:
        """Take a state of the mission."""
        self._mission, self._seq = state.mission, state.seq
        for name, door in self._doors.items():
            door.settle = min(SETTLE, self._within[name] * state.unit / 2)
            on_way = (agent for agent, where in door.needed_in.items() if state.locations.get(agent) in where)
            door.wanted_by = frozenset(on_way)
            if door.wanted_by or door.asked is not None or state.seq > 0:
                door.ask(bool(door.wanted_by), now)

    def opened(self, now: float) -> Opened:
        """Return for whom which door is open now."""
        doors = {name: door.wanted_by for name, door in self._doors.items() if door.is_open(now)}
        return Opened(self._mission, self._seq, doors)
