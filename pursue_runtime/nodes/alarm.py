"""When a node does something: at a set time, or after a reaction has had the time that it takes."""

from __future__ import annotations

import math
import threading
import time
from functools import partial
from typing import Callable, List, Optional

import rospy
from rosgraph_msgs.msg import Clock

from pursue_runtime.nodes.node import Ending, log, start_thread, subscribe


class Alarm:
    """Calls `action`, in a thread of its own, at a set time. It sleeps until then: nothing is polled.

    Setting it again replaces what was set. In simulated time it wakes on /clock.
    """

    def __init__(self, action: Callable[[], None], ending: Ending) -> None:
        self._action = action
        self._changed = threading.Condition()
        self._moment: Optional[float] = None
        self._deadline: Optional[float] = None
        self._wakes = -math.inf  # when the thread wakes by itself, on the monotonic clock; -inf: it is awake
        self._simulated: Optional[float] = None
        if not rospy.rostime.is_wallclock():
            self._simulated = rospy.get_time()
            subscribe("/clock", Clock, self._tick, ending, queue_size=10, tcp_nodelay=True)
        start_thread("alarm", self._run, ending)

    def set(self, moment: Optional[float] = None, patience: Optional[float] = None) -> None:
        """Call it at this ROS time (seconds), and in any case after `patience` seconds of real time.

        Neither: do not call it.
        """
        with self._changed:
            self._moment = moment
            self._deadline = None if patience is None else time.monotonic() + patience
            wait = self._wait()
            if wait is not None and time.monotonic() + wait < self._wakes:  # else a reaction would wait for the thread
                self._changed.notify()

    def _tick(self, message: Clock) -> None:
        with self._changed:
            self._simulated = message.clock.to_sec()
            if self._moment is not None and self._simulated >= self._moment:
                self._changed.notify()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            with self._changed:
                wait = self._wait()
                while wait is None or wait > 0.0:
                    self._wakes = time.monotonic() + (math.inf if wait is None else wait)
                    self._changed.wait(wait)
                    wait = self._wait()
                self._wakes = -math.inf
                self._moment = self._deadline = None
            self._action()

    def _wait(self) -> Optional[float]:
        """Seconds of real time until the call as things stand; None: until something changes."""
        waits: List[float] = []
        if self._moment is not None:
            if self._simulated is None:
                waits.append(self._moment - rospy.get_time())
            elif self._simulated >= self._moment:
                waits.append(0.0)
        if self._deadline is not None:
            waits.append(self._deadline - time.monotonic())
        return min(waits) if waits else None


class Later:
    """Does things in their order, in a thread of its own, but only after a reaction has had the time that it takes.

    What is passed in a `with` block is done after its end: the thread does not even wake before, which takes time too.
    """

    def __init__(self, name: str, ending: Ending) -> None:
        self._changed = threading.Condition()
        self._actions: List[Callable[[], object]] = []
        self._reactions = 0  # how many are under way
        start_thread(name, self._run, ending)

    def do(self, action: Callable[[], object]) -> None:
        """Do this after all that was passed before. An exception that it raises ends the node."""
        with self._changed:
            self._actions.append(action)
            self._wake()

    def log(self, level: str, text: str) -> None:
        """Log a sentence then: a line takes as long as a reaction, and other words or orders may be due."""
        self.do(partial(log, level, text))

    def __enter__(self) -> None:
        """A reaction begins."""
        with self._changed:
            self._reactions += 1

    def __exit__(self, *_: object) -> None:
        """It is over."""
        with self._changed:
            self._reactions -= 1
            self._wake()

    def _wake(self) -> None:
        if self._actions and not self._reactions:
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                while not self._actions or self._reactions:
                    self._changed.wait()
            time.sleep(0.01)
            with self._changed:
                actions, self._actions = self._actions, []
            for action in actions:
                action()
