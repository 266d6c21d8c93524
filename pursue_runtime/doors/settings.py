"""How each door is connected: the parameters of the node that concern doors."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Optional

from pursue_runtime.data import DataError
from pursue_runtime.parameters import choice, text

ADAPTERS = ("simulated", "std_msgs", "string", "rmf")
"""What a door is: simulated, or one whose messages are std_msgs/Bool, std_msgs/String, or those of rmf_door_msgs."""

_TOPICS = {"rmf": ("door_requests", "door_states")}
_OWN = ("adapter", "command", "state", "name")

RMF_CLOSED, RMF_OPEN = 0, 2
"""MODE_CLOSED and MODE_OPEN of rmf_door_msgs/DoorMode."""

_OPEN, _SHUT = ("open", "opened"), ("closed", "close", "shut", "moving", "opening", "closing")


class DoorSettings(NamedTuple):
    """How one door is connected. `command`, `state`: the topics on which it is asked, and says what it is; `name`: what
    messages that are for all doors call it."""

    adapter: str
    command: str
    state: str
    name: str


def read_door_settings(door: str, given: Mapping[str, Any]) -> DoorSettings:
    """The door's settings among the node's parameters; those in the group of its name win. Raises DataError."""
    own = given.get(door, {})
    if not isinstance(own, dict) or set(own) - set(_OWN):
        raise DataError(f"~{door} is {own!r}; expected some of {', '.join(_OWN)}")
    adapter = choice({**given, **own}, "adapter", "simulated", ADAPTERS)
    command, state = _TOPICS.get(adapter, (f"pursue/doors/{door}/command", f"pursue/doors/{door}/state"))
    return DoorSettings(adapter, text(own, "command", command), text(own, "state", state), text(own, "name", door))


def command_word(is_open: bool) -> str:
    """Return what a door is asked by the adapter `string`."""
    return "open" if is_open else "close"


def state_of_word(word: str) -> Optional[bool]:
    """Return what a door says by the adapter `string`: open, or not; None: that is not known."""
    said = word.strip().lower()
    return True if said in _OPEN else False if said in _SHUT else None
