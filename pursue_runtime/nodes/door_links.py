"""The topics between the doors' node and one door, or one lift: what it is asked, and what it reports; or a simulated
one."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from functools import partial
from typing import Any, Callable

import rospy
from std_msgs.msg import Bool, Int32, String

from pursue_runtime.data import DataError
from pursue_runtime.doors.keeper import Word
from pursue_runtime.doors.lifts import NOWHERE
from pursue_runtime.doors.settings import (
    RMF_CLOSED,
    RMF_END,
    RMF_OPEN,
    RMF_RIDE,
    DoorSettings,
    command_word,
    floor_called,
    floor_number,
    floor_word,
    state_of_word,
)
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.nodes.robot_link import needed

Report = Callable[[Any], None]
"""Takes what it is, as an `keeper.Word`; None: that is not known."""

Ask = Callable[[Any], None]
"""Asks a door, or a lift, for an `keeper.Word`; it may be asked the same again."""


def _ask_on_own_topics(
    settings: DoorSettings,
    kind: Any,
    written: Callable[[Any], Any],
    read: Callable[[Any], Any],
    report: Report,
    ending: Ending,
) -> Ask:
    """One with topics of its own, whose messages have `data`."""
    command = rospy.Publisher(settings.command, kind, queue_size=10, latch=True)
    subscribe(settings.state, kind, lambda message: report(read(message.data)), ending, queue_size=10)
    return lambda what: command.publish(kind(written(what)))


class _OfRmf(ABC):
    """One of Open-RMF, whose topics all of them share. `kind`: Door or Lift."""

    def __init__(self, settings: DoorSettings, kind: str, report: Report, ending: Ending) -> None:
        try:
            if kind == "Lift":
                self._messages = needed("rmf_lift_msgs", "rmf_lift_msgs.msg", "adapter: rmf")
            else:
                self._messages = needed("rmf_door_msgs", "rmf_door_msgs.msg", "adapter: rmf")
        except DataError:
            raise DataError(
                f"adapter: rmf needs the ROS package rmf_{kind.lower()}_msgs, which is not here: build it for ROS 1 "
                "from rmf_internal_msgs of Open-RMF, as ros1_bridge needs it too, and source its workspace; or choose "
                "another adapter, such as std_msgs"
            ) from None
        self._settings, self._report = settings, report
        self._requester = rospy.get_name().strip("/")
        request, state = (getattr(self._messages, kind + what) for what in ("Request", "State"))
        self._command = rospy.Publisher(settings.command, request, queue_size=10)
        subscribe(settings.state, state, self._on_state, ending, queue_size=100)

    @abstractmethod
    def _on_state(self, message: Any) -> None: ...


class _RmfDoor(_OfRmf):
    """rmf_door_msgs/DoorRequest to it, DoorState from it."""

    def ask(self, what: Any) -> None:
        request = self._messages.DoorRequest()
        request.request_time = rospy.Time.now()
        request.requester_id = self._requester
        request.door_name = self._settings.name
        request.requested_mode.value = RMF_OPEN if what else RMF_CLOSED
        self._command.publish(request)

    def _on_state(self, message: Any) -> None:
        if message.door_name == self._settings.name:
            self._report(message.current_mode.value == RMF_OPEN)


class _RmfLift(_OfRmf):
    """rmf_lift_msgs/LiftRequest to it, LiftState from it: it counts as open in a session of ours alone."""

    def ask(self, what: Any) -> None:
        request = self._messages.LiftRequest()
        request.request_time = rospy.Time.now()
        request.session_id = self._requester
        request.lift_name = self._settings.name
        request.destination_floor = self._settings.floors.get(what, "")
        request.request_type = RMF_RIDE if what else RMF_END
        request.door_state = RMF_OPEN if what else RMF_CLOSED
        self._command.publish(request)

    def _on_state(self, message: Any) -> None:
        if message.lift_name == self._settings.name:
            is_open = message.door_state == RMF_OPEN and message.session_id == self._requester
            self._report(floor_called(self._settings, message.current_floor) if is_open else NOWHERE)


class _Simulated:
    """One that has done what it was asked at a time of its own within its time, and closes at once."""

    def __init__(self, within: Callable[[], float], seed: str, report: Report, ending: Ending) -> None:
        """`within`: the seconds in which it has done it at the latest."""
        self._within, self._seed, self._report = within, seed, report
        self._times = 0
        self._asked: Word = False
        self._alarm = Alarm(lambda: report(self._asked), ending)

    def ask(self, what: Any) -> None:
        if what == self._asked:
            return
        self._asked = what
        self._alarm.set()
        self._report(type(what)())
        if what:
            self._times += 1
            share = random.Random(f"{self._seed}/{self._times}").uniform(0.1, 0.9)
            self._alarm.set(rospy.get_time() + share * self._within())


def linked(settings: DoorSettings, within: Callable[[], float], seed: str, report: Report, ending: Ending) -> Ask:
    """Connect a door, or a lift, with these settings; return what asks it. `within` and `seed`: as in a simulated one.
    Raises DataError where its messages are not installed."""
    if settings.adapter == "simulated":
        return _Simulated(within, seed, report, ending).ask
    if settings.adapter == "rmf":
        kind = _RmfLift if settings.floors else _RmfDoor
        return kind(settings, "Lift" if settings.floors else "Door", report, ending).ask
    called = partial(floor_called, settings)
    numbers, words = (partial(one, settings) for one in (floor_number, floor_word))
    of_lift: Any = {"std_msgs": (Int32, numbers, called), "string": (String, words, called)}
    of_door: Any = {"std_msgs": (Bool, bool, bool), "string": (String, command_word, state_of_word)}
    kind_of_message, written, read = (of_lift if settings.floors else of_door)[settings.adapter]
    return _ask_on_own_topics(settings, kind_of_message, written, read, report, ending)
