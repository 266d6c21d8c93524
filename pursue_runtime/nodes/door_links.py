"""The topics between the doors' node and one door: what it is asked, and what it reports; or a simulated door."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from typing import Any, Callable, Mapping, Optional

import rospy
from std_msgs.msg import Bool, String

from pursue_runtime.data import DataError
from pursue_runtime.doors.settings import RMF_CLOSED, RMF_OPEN, DoorSettings, command_word, state_of_word
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.nodes.robot_link import needed

Report = Callable[[Optional[bool]], None]
"""Takes what a door is: open, or not; None: that is not known."""


class DoorLink(ABC):
    """The connection to one door."""

    @abstractmethod
    def ask(self, is_open: bool) -> None:
        """Ask the door to open, or to close; it may be asked the same again."""


class _BoolDoor(DoorLink):
    """A door whose messages are std_msgs/Bool: true is open."""

    def __init__(self, settings: DoorSettings, report: Report, ending: Ending) -> None:
        self._command = rospy.Publisher(settings.command, Bool, queue_size=10, latch=True)
        subscribe(settings.state, Bool, lambda message: report(bool(message.data)), ending, queue_size=10)

    def ask(self, is_open: bool) -> None:
        self._command.publish(Bool(is_open))


class _StringDoor(DoorLink):
    """A door whose messages are std_msgs/String: `open` and `close` to it, what it is from it."""

    def __init__(self, settings: DoorSettings, report: Report, ending: Ending) -> None:
        self._command = rospy.Publisher(settings.command, String, queue_size=10, latch=True)
        subscribe(settings.state, String, lambda message: report(state_of_word(message.data)), ending, queue_size=10)

    def ask(self, is_open: bool) -> None:
        self._command.publish(String(command_word(is_open)))


class _RmfDoor(DoorLink):
    """A door of Open-RMF: rmf_door_msgs/DoorRequest to it, DoorState from it, on topics that all doors share."""

    def __init__(self, settings: DoorSettings, report: Report, ending: Ending) -> None:
        try:
            self._messages = needed("rmf_door_msgs", "rmf_door_msgs.msg", "adapter: rmf")
        except DataError:
            raise DataError(
                "adapter: rmf needs the ROS package rmf_door_msgs, which is not here: build it for ROS 1 from "
                "rmf_internal_msgs of Open-RMF, as ros1_bridge needs it too, and source its workspace; or choose "
                "another adapter, such as std_msgs"
            ) from None
        self._name, self._report = settings.name, report
        self._command = rospy.Publisher(settings.command, self._messages.DoorRequest, queue_size=10)
        subscribe(settings.state, self._messages.DoorState, self._on_state, ending, queue_size=100)

    def ask(self, is_open: bool) -> None:
        request = self._messages.DoorRequest()
        request.request_time = rospy.Time.now()
        request.requester_id = rospy.get_name().strip("/")
        request.door_name = self._name
        request.requested_mode.value = RMF_OPEN if is_open else RMF_CLOSED
        self._command.publish(request)

    def _on_state(self, message: Any) -> None:
        if message.door_name == self._name:
            self._report(message.current_mode.value == RMF_OPEN)


class _SimulatedDoor(DoorLink):
    """A door that opens at a time of its own within its time, and closes at once."""

    def __init__(self, within: Callable[[], float], seed: str, report: Report, ending: Ending) -> None:
        """`within`: the seconds in which it is open at the latest."""
        self._within, self._seed, self._report = within, seed, report
        self._times, self._is_open, self._opens = 0, False, False
        self._alarm = Alarm(self._on_alarm, ending)

    def ask(self, is_open: bool) -> None:
        if is_open == (self._is_open or self._opens):
            return
        self._opens = is_open
        if not is_open:
            self._is_open = False
            self._alarm.set()
            self._report(False)
            return
        self._times += 1
        share = random.Random(f"{self._seed}/{self._times}").uniform(0.1, 0.9)
        self._alarm.set(rospy.get_time() + share * self._within())

    def _on_alarm(self) -> None:
        if self._opens:
            self._is_open, self._opens = True, False
            self._report(True)


_KINDS: Mapping[str, Callable[[DoorSettings, Report, Ending], DoorLink]] = {
    "std_msgs": _BoolDoor, "string": _StringDoor, "rmf": _RmfDoor,
}  # fmt: skip


def linked(settings: DoorSettings, within: Callable[[], float], seed: str, report: Report, ending: Ending) -> DoorLink:
    """Return the connection to a door with these settings. `within` and `seed`: as in a simulated one. Raises DataError
    where its messages are not installed."""
    if settings.adapter == "simulated":
        return _SimulatedDoor(within, seed, report, ending)
    return _KINDS[settings.adapter](settings, report, ending)
