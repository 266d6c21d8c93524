"""When connections are made anew, and what is thought of the master: no ROS; moments are seconds of a real clock."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Mapping

SILENCE = 3.0
"""Seconds without a pulse after which a publisher counts as silent."""

FIRST_WAIT, LAST_WAIT = 4.0, 60.0
"""Seconds until a publisher that stays silent on new connections gets the next ones: at first, and at most."""

PATIENCE = 10.0
"""Seconds after which a master that is gone is given up."""

REGISTERED, NOT_REGISTERED, REFUSED, UNREACHABLE = "known", "stranger", "refused", "unreachable"
MASTER_PROBLEMS = {
    REGISTERED: "",
    NOT_REGISTERED: "the ROS master was started anew and does not know this node: start the nodes again",
    REFUSED: "the ROS master is gone",
    UNREACHABLE: "the ROS master cannot be reached",
}
"""What a call to the master may find, and how it is told."""


@dataclass
class _Peer:
    count: int = -1
    received: float = 0.0
    renewed: float = float("-inf")
    wait: float = FIRST_WAIT
    stale: bool = False


class Peers:
    """Which publishers are silent, and for which of them it is time to make the connections anew.

    Who was silent gets new connections even if it is heard again before: others of its connections may still be dumb.
    """

    def __init__(self, silence: float = SILENCE) -> None:
        self._silence = silence
        self._peers: Dict[str, _Peer] = {}

    def __len__(self) -> int:
        return len(self._peers)

    def update(self, counts: Mapping[str, int], now: float) -> None:
        """How many messages each connected publisher has sent so far."""
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
        """Who has said nothing for too long."""
        return sorted(name for name, peer in self._peers.items() if now - peer.received >= self._silence)

    def due(self) -> List[str]:
        """Whose connections are to be made anew, as soon as they can be."""
        return sorted(name for name, peer in self._peers.items() if peer.stale)

    def on_renewed(self, name: str, now: float) -> None:
        """The connections to this publisher were made anew. If it stays silent, the next time comes later."""
        peer = self._peers.get(name)
        if peer is not None:
            if peer.renewed > peer.received:
                peer.wait = min(2 * peer.wait, LAST_WAIT)
            peer.count, peer.renewed, peer.stale = 0, now, False


class MasterWatch:
    """What is to be thought of the master, call by call.

    A master that is cut off may come back as it was. One that is gone, or another one, never hears its old nodes again.
    """

    def __init__(self, patience: float = PATIENCE) -> None:
        self.found = REGISTERED
        self._patience = patience
        self._since = 0.0

    def update(self, found: str, now: float) -> bool:
        """What a call has found; True if that is news."""
        news = found != self.found
        if news and not {found, self.found} <= {NOT_REGISTERED, REFUSED}:
            self._since = now
        self.found = found
        return news

    def lost(self, now: float) -> bool:
        """True when the master has been gone, or another one, for too long."""
        return self.found in (NOT_REGISTERED, REFUSED) and now - self._since >= self._patience
