"""How far the mission has come, with the master: a third place, beside the journal and its mark.

It may be a second behind. What it says of another launch does not count.
"""

from __future__ import annotations

import threading
from typing import Any, Dict, Optional

import rospy

from pursue_runtime.nodes.node import Ending, start_thread
from pursue_runtime.observer.records import Rank

NEWEST = "pursue/newest"
"""The parameter, beside the node: `launch`, and `seq`, `ended` and `stamp` (seconds) of its newest state."""

NOTHING: Rank = (0, False)

PATIENCE = 1.0
"""Seconds of real time that a node which ends waits for the master to keep it."""


class Newest:
    """`begun`: a mission has been under way in this launch."""

    def __init__(self, launch: str, ending: Ending) -> None:
        found: Any = rospy.get_param(NEWEST, None)
        self._found: Dict[str, Any] = found if isinstance(found, dict) else {}
        self.begun = self._found.get("launch") == launch
        self._launch = launch
        self._noted: Optional[Rank] = None
        self._next: Dict[str, Any] = {}
        self._closed = False
        self._changed, self._kept = threading.Event(), threading.Event()
        start_thread("newest", self._keep, ending)  # it may have to wait for the master

    def reached(self, after: float) -> Rank:
        """Return how far this launch had come with a mission that was not over at the moment `after` (seconds)."""
        seq, stamp = self._found.get("seq"), self._found.get("stamp")
        if not self.begun or not isinstance(seq, int) or not isinstance(stamp, (int, float)) or stamp <= after:
            return NOTHING
        return seq, self._found.get("ended") is True

    def note(self, rank: Rank, stamp: float) -> None:
        """Have the master keep that the mission had come so far at this moment (seconds); return at once."""
        if rank != self._noted and not self._closed:
            self._noted, self.begun = rank, True
            self._keep_soon(rank, stamp)

    def close(self) -> None:
        """Have the master keep that this mission is over: the next one of the launch begins at 0."""
        self._closed = True
        self._kept.clear()
        self._keep_soon(NOTHING, 0.0)
        self._kept.wait(PATIENCE)

    def _keep_soon(self, rank: Rank, stamp: float) -> None:
        self._next = {"launch": self._launch, "seq": rank[0], "ended": rank[1], "stamp": stamp}
        self._changed.set()

    def _keep(self) -> None:
        while True:
            self._changed.wait()
            self._changed.clear()
            kept = self._next
            try:
                rospy.set_param(NEWEST, kept)
            except Exception as problem:  # whatever a master that is going down answers
                rospy.logwarn("the master does not keep the parameter %s: %s", NEWEST, problem)
            if kept is self._next:
                self._kept.set()
