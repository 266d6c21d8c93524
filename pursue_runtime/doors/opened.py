"""What is published on `pursue/doors`: for whom which door is open, as of which state of which mission."""

from __future__ import annotations

import json
from types import MappingProxyType
from typing import FrozenSet, Mapping, NamedTuple, Optional

from pursue_runtime.bounded import SETTINGS, json_object

DOORS = "pursue/doors"
"""The topic."""

_FORMAT = 1


class Opened(NamedTuple):
    """Door → the agents for whom it is open, and stays so until they have passed it. `seq`: the number of the state
    from which that follows."""

    mission: str = ""
    seq: int = -1
    doors: Mapping[str, FrozenSet[str]] = MappingProxyType({})

    def all_for(self, agent: str, doors: FrozenSet[str], since: int) -> bool:
        """Return True if all these doors are open for the agent, as of a state with this number or a later one."""
        return self.seq >= since and all(agent in self.doors.get(door, ()) for door in doors)


NONE_OPENED = Opened()
"""Nothing has been heard of any door."""


def opened_text(opened: Opened) -> str:
    """Return it as text."""
    doors = {door: sorted(agents) for door, agents in sorted(opened.doors.items())}
    return json.dumps({"format": _FORMAT, "mission": opened.mission, "seq": opened.seq, "open": doors})


def read_opened(text: str) -> Optional[Opened]:
    """Return what `opened_text` has written; None for any other text."""
    data = json_object(text, SETTINGS) or {}
    mission, seq, doors = data.get("mission"), data.get("seq"), data.get("open")
    if not isinstance(mission, str) or type(seq) is not int or not isinstance(doors, dict):
        return None
    if data.get("format") != _FORMAT or not all(_are_names(agents) for agents in doors.values()):
        return None
    return Opened(mission, seq, {door: frozenset(agents) for door, agents in doors.items()})


def _are_names(agents: object) -> bool:
    return isinstance(agents, list) and all(isinstance(agent, str) for agent in agents)
