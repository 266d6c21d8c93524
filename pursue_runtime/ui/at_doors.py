"""What agents do at doors and lifts on their way, for people: by ui.yaml, and by what the node for doors says."""

from __future__ import annotations

from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Set, Tuple

from pursue_runtime.doors.keeper import read_doors
from pursue_runtime.doors.lifts import gate_at, read_lifts
from pursue_runtime.doors.opened import NONE_OPENED, Opened
from pursue_runtime.state import LIVE, SystemState


class AtDoors:
    """Who waits for which door or lift, and who rides in one."""

    def __init__(self, settings: Mapping[str, Any], shown: Callable[[str], str]) -> None:
        """`settings`: the content of ui.yaml; `shown`: what people read for a name. Raises DataError."""
        self._doors, self._lifts, self._shown = read_doors(settings), read_lifts(settings), shown
        self._opened = NONE_OPENED
        self._state: Optional[SystemState] = None
        self._let_in: Set[Tuple[str, str]] = set()  # agent and location: its lift was open for it where it gets in

    @property
    def has_some(self) -> bool:
        """Return True if there is a door or a lift."""
        return bool(self._doors or self._lifts)

    def take(self, opened: Opened) -> None:
        """Take for whom doors and lifts are open."""
        self._opened = opened

    def says(self, state: SystemState) -> Dict[str, str]:
        """Return what each agent does that is at one in this state, as in `waits for lift1`."""
        if state.status not in LIVE:
            return {}
        here = state.locations
        self._let_in = {(agent, location) for agent, location in self._let_in if here.get(agent) == location}
        found = {}
        for agent, location in here.items():
            words = " and ".join(self._words(agent, location))
            if words:
                found[agent] = words
        return found

    def _words(self, agent: str, location: str) -> Iterator[str]:
        for name, door in self._doors.items():
            if location in door.asked_by.get(agent, ()) and not self._is_open(name, agent):
                yield f"waits for {self._shown(name)} to open"
        for name, lift in self._lifts.items():
            ends = lift.rides.get(agent, {}).get(location)
            if ends is None:
                continue
            gets_in, gets_out = (self._is_open(gate_at(name, floor), agent) for floor in ends)
            if gets_in:
                self._let_in.add((agent, location))
            rides = (agent, location) in self._let_in
            does = "gets out of" if gets_out else "gets into" if gets_in else "rides in" if rides else "waits for"
            yield f"{does} {self._shown(name)}"

    def _is_open(self, name: str, agent: str) -> bool:
        return agent in self._opened.doors.get(name, ())
