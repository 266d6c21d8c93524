"""What each door and lift was asked, what it says, and since when that counts; and for whom each door is to be open.

Times are seconds of ROS time.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Collection, Dict, FrozenSet, List, Mapping, NamedTuple, Optional, Tuple, Union

from pursue_runtime.data import DataError
from pursue_runtime.doors.opened import Opened
from pursue_runtime.state import SystemState

REPEAT = 1.0
"""Seconds after which what has not done what it was asked is asked again."""

SETTLE = 1.0
"""Seconds for which what it was asked has to stay true where it was so already: what was reported before may be older
than an order to the contrary. Half of the time that it may take, where that is less."""

Word = Union[bool, str]
"""Of a door whether it is open; of a lift the floor at which it is open, "": none, or anywhere."""


@dataclass
class Asking:
    """`said`: what it reported last, None: nothing that counts; `asked`: what it was asked last, None: nothing."""

    settle: float = SETTLE
    said: Optional[Word] = None
    said_at: float = 0.0
    asked: Optional[Word] = None
    asked_since: float = 0.0
    asked_last: float = field(default=float("-inf"))

    def ask(self, what: Word, now: float) -> None:
        """Have it asked this, unless it was."""
        if self.asked != what:
            self.asked, self.asked_since, self.asked_last = what, now, float("-inf")

    def take(self, said: Optional[Word], now: float) -> None:
        """Take what it reports."""
        self.said, self.said_at = said, now

    @property
    def done_at(self) -> Optional[float]:
        """Return from when on it counts as having done what it was asked, as things stand; None: it does not."""
        if self.asked is None or self.said != self.asked:
            return None
        return self.asked_since if self.said_at > self.asked_since else self.asked_since + self.settle

    @property
    def ask_at(self) -> float:
        """Return when it is asked next: at once what is new, and again what it has not done."""
        if self.asked is None:
            return float("inf")
        if self.asked_last == float("-inf"):
            return self.asked_last
        return float("inf") if self.said == self.asked or self.asked == "" else self.asked_last + REPEAT

    def is_open(self, now: float) -> bool:
        """Return True if it counts as open for whoever wants that, having done what it was asked."""
        return bool(self.asked) and self.done_at is not None and now >= self.done_at


class Keeper:
    """Asks doors, or lifts, and takes what they report."""

    def __init__(self, asked: Mapping[str, Asking]) -> None:
        self._asked = asked
        self._mission, self._seq = "", -1

    def on_report(self, name: str, said: Optional[Word], now: float) -> None:
        """Take what one of them reports; None: it says nothing that counts."""
        self._asked[name].take(said, now)

    def due(self, now: float) -> List[Tuple[str, Word]]:
        """Return which are to be asked now, and what."""
        found = []
        for name, one in self._asked.items():
            if one.asked is not None and now >= one.ask_at:
                one.asked_last = now
                found.append((name, one.asked))
        return found

    def next_moment(self, now: float) -> Optional[float]:
        """Return when to look again, later than now; None: not before the next state or report."""
        moments = (moment for each in self._asked.values() for moment in (each.ask_at, each.done_at))
        return min((moment for moment in moments if moment is not None and now < moment < float("inf")), default=None)

    def waited_for(self, now: float) -> Dict[str, float]:
        """Return which are to be open, and are not, and for how many seconds they have been asked."""
        shut = {name: one for name, one in self._asked.items() if one.asked and not one.is_open(now)}
        return {name: now - one.asked_since for name, one in shut.items()}


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
