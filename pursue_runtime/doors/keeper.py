"""When each door is asked to open and to close, and for whom it is open. Times are seconds of ROS time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Collection, Dict, FrozenSet, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.doors.opened import Opened
from pursue_runtime.state import SystemState

REPEAT = 1.0
"""Seconds after which a door that has not done what it was asked is asked again."""

SETTLE = 1.0
"""Seconds for which a door that was open when it was asked to open has to stay open: what it reported before may be
older than an order to close. Half of the time in which it opens, where that is less."""

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
class _Door:
    """A door. `is_open`: what it reported last, None: nothing; `asked`: what it was asked last, and when."""

    needed_in: Dict[str, FrozenSet[str]]
    settle: float = SETTLE
    wanted_by: FrozenSet[str] = frozenset()
    is_open: Optional[bool] = None
    reported: float = 0.0
    asked: Optional[bool] = None
    asked_since: float = 0.0
    asked_last: float = field(default=float("-inf"))

    @property
    def wanted(self) -> bool:
        """Return True if it is to be open."""
        return bool(self.wanted_by)

    @property
    def open_at(self) -> Optional[float]:
        """Return from when on it counts as open, as things stand; None: it does not."""
        if not self.wanted or not self.asked or not self.is_open:
            return None
        return self.asked_since if self.reported > self.asked_since else self.asked_since + self.settle


class DoorKeeper:
    """Has each door open as long as somebody who asks for it is on a way through it, and closed otherwise.

    A door counts as open for whoever has asked when it reports that, after it was asked to open. A door is never asked
    to close while somebody is on the way, also if the mission is over, or holds.
    """

    def __init__(self, doors: Mapping[str, DoorData]) -> None:
        self._within = {name: door.within for name, door in doors.items()}
        self._doors = {
            name: _Door({agent: frozenset(locations) for agent, locations in door.asked_by.items()})
            for name, door in doors.items()
        }
        self._mission, self._seq = "", -1

    def on_state(self, state: SystemState, now: float) -> None:
        """Take a state of the mission."""
        self._mission, self._seq = state.mission, state.seq
        for name, door in self._doors.items():
            door.settle = min(SETTLE, self._within[name] * state.unit / 2)
            on_way = (agent for agent, where in door.needed_in.items() if state.locations.get(agent) in where)
            door.wanted_by = frozenset(on_way)
            if door.asked != door.wanted and (door.wanted or door.asked is not None or state.seq > 0):
                door.asked, door.asked_since, door.asked_last = door.wanted, now, float("-inf")

    def on_report(self, door: str, is_open: Optional[bool], now: float) -> None:
        """Take what a door reports: open, or not; None: it says nothing that counts."""
        self._doors[door].is_open, self._doors[door].reported = is_open, now

    def due(self, now: float) -> List[Tuple[str, bool]]:
        """Return the doors that are to be asked now, and whether to open."""
        found = []
        for name, door in self._doors.items():
            if door.asked is not None and now >= self._ask_at(door):
                door.asked_last = now
                found.append((name, door.asked))
        return found

    def next_moment(self) -> Optional[float]:
        """Return when to look again; None: not before the next state or report."""
        moments = [self._ask_at(door) for door in self._doors.values() if door.asked is not None]
        moments += [door.open_at for door in self._doors.values() if door.open_at is not None]
        return min(moments, default=None)

    def opened(self, now: float) -> Opened:
        """Return for whom which door is open now."""
        doors = {name: door.wanted_by for name, door in self._doors.items() if _is_reached(door.open_at, now)}
        return Opened(self._mission, self._seq, doors)

    def waited_for(self, now: float) -> Dict[str, float]:
        """Return the doors that are to be open and are not, and for how many seconds they have been asked."""
        shut = {name: door for name, door in self._doors.items() if door.wanted and not _is_reached(door.open_at, now)}
        return {name: now - door.asked_since for name, door in shut.items()}

    @staticmethod
    def _ask_at(door: _Door) -> float:
        """When it is asked next: at once what is new, and again what it has not done."""
        if door.asked_last == float("-inf"):
            return door.asked_last
        return float("inf") if door.is_open == door.asked else door.asked_last + REPEAT


def _is_reached(moment: Optional[float], now: float) -> bool:
    return moment is not None and now >= moment
