"""How each door and each lift is connected: the parameters of the node that concern them."""

from __future__ import annotations

from types import MappingProxyType
from typing import Any, Dict, Mapping, NamedTuple, Optional, Sequence

from pursue_runtime.data import DataError
from pursue_runtime.doors.lifts import NOWHERE
from pursue_runtime.parameters import choice, text

ADAPTERS = ("simulated", "std_msgs", "string", "rmf")
"""What a door or a lift is: simulated, or one whose messages are std_msgs/Bool (of a lift Int32), std_msgs/String, or
those of Open-RMF."""

_RMF_TOPICS = {"doors": ("door_requests", "door_states"), "lifts": ("lift_requests", "lift_states")}
_OWN = ("adapter", "command", "state", "name")

RMF_CLOSED, RMF_OPEN = 0, 2
"""MODE_CLOSED and MODE_OPEN of rmf_door_msgs/DoorMode, DOOR_CLOSED and DOOR_OPEN of rmf_lift_msgs/LiftState."""
RMF_END, RMF_RIDE = 0, 1
"""REQUEST_END_SESSION and REQUEST_AGV_MODE of rmf_lift_msgs/LiftRequest."""

NO_FLOOR = -1
"""The number of no floor, on the topics of the adapter `std_msgs`."""
_FREE = "free"
_OPEN, _SHUT = ("open", "opened"), ("closed", "close", "shut", "moving", "opening", "closing")


class DoorSettings(NamedTuple):
    """How one door or lift is connected. `command`, `state`: the topics on which it is asked, and says what it is;
    `name`: what messages that are for all of them call it; `floors`: what its messages call the floors of a lift, in
    their order."""

    adapter: str
    command: str
    state: str
    name: str
    floors: Mapping[str, str] = MappingProxyType({})


def read_door_settings(door: str, given: Mapping[str, Any]) -> DoorSettings:
    """The door's settings among the node's parameters; those in the group of its name win. Raises DataError."""
    return _read("doors", door, given, _OWN)


def read_lift_settings(lift: str, floors: Sequence[str], given: Mapping[str, Any]) -> DoorSettings:
    """The same of a lift with these floors. Raises DataError."""
    settings = _read("lifts", lift, given, (*_OWN, "floors"))
    own = given.get(lift, {}).get("floors", {})
    numbers = settings.adapter == "std_msgs"
    if not isinstance(own, dict) or not set(own) <= set(floors):
        raise DataError(f"~{lift}/floors is {own!r}; expected what {', '.join(floors)} are called")
    called: Dict[str, str] = {
        floor: str(own.get(floor, index if numbers else floor)) for index, floor in enumerate(floors)
    }
    if len(set(called.values())) < len(called) or (numbers and not all(map(str.isdecimal, called.values()))):
        kind = "numbers from 0 up" if numbers else "names"
        raise DataError(f"~{lift}/floors is {own!r}; expected {kind}, a different one for each floor")
    return settings._replace(floors=called)


def _read(kind: str, one: str, given: Mapping[str, Any], known: Sequence[str]) -> DoorSettings:
    own = given.get(one, {})
    if not isinstance(own, dict) or set(own) - set(known):
        raise DataError(f"~{one} is {own!r}; expected some of {', '.join(known)}")
    adapter = choice({**given, **own}, "adapter", "simulated", ADAPTERS)
    topics = _RMF_TOPICS[kind] if adapter == "rmf" else (f"pursue/{kind}/{one}/command", f"pursue/{kind}/{one}/state")
    return DoorSettings(adapter, text(own, "command", topics[0]), text(own, "state", topics[1]), text(own, "name", one))


def command_word(is_open: bool) -> str:
    """Return what a door is asked by the adapter `string`."""
    return "open" if is_open else "close"


def state_of_word(word: str) -> Optional[bool]:
    """Return what a door says by the adapter `string`: open, or not; None: that is not known."""
    said = word.strip().lower()
    return True if said in _OPEN else False if said in _SHUT else None


def floor_word(settings: DoorSettings, floor: str) -> str:
    """Return what a lift is asked by the adapter `string`: a floor; `free` where nobody needs it."""
    return settings.floors.get(floor, _FREE)


def floor_number(settings: DoorSettings, floor: str) -> int:
    """Return the same by the adapter `std_msgs`."""
    return int(settings.floors.get(floor, NO_FLOOR))


def floor_called(settings: DoorSettings, called: object) -> str:
    """Return the floor that the messages of a lift call so; NOWHERE: none of them."""
    said = str(called).strip()
    return next((floor for floor, name in settings.floors.items() if name == said), NOWHERE)
