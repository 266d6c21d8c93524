"""Who may be connected to a server: a flood of connections keeps nobody out who asks at once.

Where there is no room, a new connection takes the place of another one: one that has not shown that it may be here, of
the address that has the most of these, the oldest first. Other machines never take the places kept for this one.
"""

from __future__ import annotations

import ipaddress
from typing import Dict, Generic, Hashable, Iterator, List, NamedTuple, Optional, TypeVar

Key = TypeVar("Key", bound=Hashable)


def is_loopback(host: str) -> bool:
    """True for an address that only this machine reaches."""
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class _Slot(NamedTuple):
    sender: str
    trusted: bool = False


class Slots(Generic[Key]):
    """The connections of a server, by keys of the caller's, in the order in which they came.

    At most half of them are of one address; a quarter is kept for loopback.
    """

    def __init__(self, room: int) -> None:
        """`room`: so many connections at a time, 1 or more."""
        self._room, self._each, self._others = room, (room + 1) // 2, room - room // 4
        self._slots: Dict[Key, _Slot] = {}

    def __len__(self) -> int:
        return len(self._slots)

    def __iter__(self) -> Iterator[Key]:
        return iter(self._slots)

    def victim(self, address: str) -> Optional[Key]:
        """The connection that has to go for a new one of this address; None where there is room."""
        sender = _sender(address)
        own = [key for key, slot in self._slots.items() if slot.sender == sender]
        others = [key for key, slot in self._slots.items() if not is_loopback(slot.sender)]
        if len(own) >= self._each:
            return self._least(own)
        if not is_loopback(sender) and len(others) >= self._others:
            return self._least(others)
        return self._least(list(self._slots)) if len(self._slots) >= self._room else None

    def take(self, key: Key, address: str) -> Optional[Key]:
        """Add a connection; return the one whose place it takes, None where there was room."""
        victim = self.victim(address)
        if victim is not None:
            self.free(victim)
        self._slots[key] = _Slot(_sender(address))
        return victim

    def trust(self, key: Key) -> None:
        """Note that a connection has shown that it may be here: it goes after all that have not."""
        if key in self._slots:
            self._slots[key] = self._slots[key]._replace(trusted=True)

    def free(self, key: Key) -> None:
        """Forget a connection, if it is still here."""
        self._slots.pop(key, None)

    def _least(self, keys: List[Key]) -> Key:
        """The one of these that goes first."""
        counts: Dict[str, int] = {}
        for slot in self._slots.values():
            counts[slot.sender] = counts.get(slot.sender, 0) + (not slot.trusted)
        return min(keys, key=lambda key: (self._slots[key].trusted, -counts[self._slots[key].sender]))


def _sender(address: str) -> str:
    """Who is behind an address: a machine may have a whole network of IPv6 (/64) for itself."""
    found = ipaddress.ip_address(address.partition("%")[0])
    if isinstance(found, ipaddress.IPv6Address) and not found.is_loopback:
        return str(found.ipv4_mapped or ipaddress.ip_network((found, 64), strict=False))
    return str(found)
