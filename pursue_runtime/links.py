"""When connections to silent publishers are renewed, whether the observer answers, and the state of the ROS master.

Times are seconds of a monotonic clock.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, List, Mapping

SILENCE = 3.0
"""Seconds without a message after which a publisher counts as silent."""

FIRST_WAIT, LAST_WAIT = 4.0, 60.0
"""Seconds until the connections to a publisher that stays silent are renewed again: at first, and at most."""

ANSWER_LOOKS = 4
"""So many looks at a connection without an answer of its publisher, and it is tried anew."""

PATIENCE = 10.0
"""Seconds after which a master that does not know this node, or refuses connections, counts as lost."""

REGISTERED, NOT_REGISTERED, REFUSED, FOREIGN, UNREACHABLE = "known", "stranger", "refused", "foreign", "unreachable"
LOST = (NOT_REGISTERED, REFUSED, FOREIGN)
"""The results of a call after which the registrations of this node do not come back."""

MASTER_PROBLEMS = {
    REGISTERED: "",
    NOT_REGISTERED: "the ROS master was started anew and does not know this node: start the nodes again",
    REFUSED: "the ROS master is gone",
    FOREIGN: "the ROS master is gone, and another program answers at its address",
    UNREACHABLE: "the ROS master cannot be reached",
}
"""A message for each result of a call to the master."""


@dataclass
class _Peer:
    count: int = -1
    received: float = 0.0
    renewed: float = float("-inf")
    wait: float = FIRST_WAIT
    stale: bool = False


class Peers:
    """Keeps which publishers are silent, and whose connections have to be renewed.

    A publisher that was silent gets new connections even if a message arrives before: its other connections may still
    be broken.
    """

    def __init__(self, silence: float = SILENCE) -> None:
        self._silence = silence
        self._peers: Dict[str, _Peer] = {}

    def __len__(self) -> int:
        return len(self._peers)

    def update(self, counts: Mapping[str, int], now: float) -> None:
        """Take the number of messages received so far from each connected publisher."""
        for name, count in counts.items():
            peer = self._peers.setdefault(name, _Peer(received=now))
            if count > peer.count:
                peer.received = now
                if not peer.stale:
                    peer.wait = FIRST_WAIT
            peer.count = count  # fewer, on new connections
        for name, peer in list(self._peers.items()):
            if now - peer.received >= 2 * LAST_WAIT and name not in counts:
                del self._peers[name]
            elif now - peer.received >= self._silence and now - peer.renewed >= peer.wait:
                peer.stale = True

    def silent(self, now: float) -> List[str]:
        """Return the names of the silent publishers."""
        return sorted(name for name, peer in self._peers.items() if now - peer.received >= self._silence)

    def due(self) -> List[str]:
        """Return the names of the publishers whose connections have to be renewed."""
        return sorted(name for name, peer in self._peers.items() if peer.stale)

    def on_renewed(self, name: str, now: float) -> None:
        """Note that the connections to this publisher were renewed; the next renewal comes later if it stays silent."""
        peer = self._peers.get(name)
        if peer is not None:
            if peer.renewed > peer.received:
                peer.wait = min(2 * peer.wait, LAST_WAIT)
            peer.count, peer.renewed, peer.stale = 0, now, False


class Unanswered:
    """Keeps for how many looks connections have been waiting for an answer of their publishers.

    Looks are counted, not seconds: a node that stood still has not waited meanwhile.
    """

    def __init__(self) -> None:
        self._looks: Dict[int, int] = {}

    def look(self, waiting: Iterable[int]) -> List[int]:
        """Take which connections have no answer yet; return those that are to be tried anew."""
        self._looks = {each: self._looks.get(each, 0) + 1 for each in waiting}
        return [each for each, looks in self._looks.items() if looks % ANSWER_LOOKS == 0]


class MasterWatch:
    """Decides from the results of calls whether the master is lost.

    A master that cannot be reached may come back with its registrations. One that refuses connections, does not know
    this node, or is another program, has lost them.
    """

    def __init__(self, patience: float = PATIENCE) -> None:
        self.found = REGISTERED
        self._patience = patience
        self._since = 0.0

    def update(self, found: str, now: float) -> bool:
        """Take the result of a call; return True if it differs from the one before."""
        changed = found != self.found
        if changed and not {found, self.found} <= set(LOST):
            self._since = now
        self.found = found
        return changed

    def lost(self, now: float) -> bool:
        """Return True when the registrations have been lost for longer than the patience."""
        return self.found in LOST and now - self._since >= self._patience


LOOK = 0.5
"""Seconds of real time between two looks at the connections with the observer."""

LOOKS = 8
"""Looks in a row without a new message after which the observer counts as silent: it publishes two messages a second,
and a busy machine delays some."""


class Presence:
    """Decides from looks at the connections with the observer whether it answers.

    The connections to a process that has ended are closed. Those to one that stands still, or to a machine that is off
    or cut off, stay open: then no message comes. Looks are counted, not seconds: a process that did not run itself for
    a while has looked once.
    """

    def __init__(self) -> None:
        self.answers = True
        self._count = -1
        self._still = 0

    def look(self, is_open: bool, count: int) -> bool:
        """Take whether a connection is open, and how many messages the connections have brought; return True if
        `answers` has changed. It answers again with the first message: rospy opens connections to find nobody there.
        """
        is_new = 0 < count != self._count
        self._still = 0 if is_new else self._still + 1
        self._count = count
        answers = is_open and (self._still < LOOKS if self.answers else is_new)
        changed = answers != self.answers
        self.answers = answers
        return changed
