"""Orders to robots: what a state says that they are to do, and how that stands in the state."""

from __future__ import annotations

import re
from typing import Iterable, NamedTuple, Optional, Tuple

from pursue_runtime.event_words import Word, format_word


class Order(NamedTuple):
    """A robot is to do `event`, as of the state with the number `seq`.

    `location` is where the agent is meanwhile. An order that is not `at_once` stands until the agent leaves it;
    one that is done at once stands until the robot's side has acknowledged it.
    """

    agent: str
    event: str
    seq: int
    location: str
    at_once: bool = False
    acknowledged: bool = False
    given: float = 0.0
    """The ROS time (seconds) at which it was given, 0: not known. It belongs to the number: in another mission a state
    may have the same one."""

    @property
    def key(self) -> Tuple[str, str, int]:
        """Return what tells it from other orders of the mission."""
        return self.agent, self.event, self.seq


_ORDER = re.compile(r"(\w+):(\w+)@(\d{1,18})(?:~(\d{1,12}\.\d{1,9}))?/(\w+)(!?)(\+?)", re.ASCII)


def format_order(order: Order) -> str:
    """Return the order as it stands in a state: `bot1:fetch@7~1700000011.400000/doing_fetch_in_shelf`, with `!` behind
    it for one that is done at once, and `+` for one that was acknowledged."""
    return f"{order.agent}:{order_text(order)}/{order.location}{'!' * order.at_once}{'+' * order.acknowledged}"


def order_text(order: Order) -> str:
    """Return what the robot is sent: `fetch@7~1700000011.400000`."""
    return format_word(Word("", order.event, order.seq, at=order.given or None))


def parse_order(text: str) -> Optional[Order]:
    """Return what `format_order` has written; None for any other text."""
    match = _ORDER.fullmatch(text)
    if match is None:
        return None
    agent, event, seq, given, location, at_once, acknowledged = match.groups()
    return Order(agent, event, int(seq), location, bool(at_once), bool(acknowledged), float(given or 0.0))


def parse_orders(texts: Iterable[str]) -> Tuple[Order, ...]:
    """Return the orders in these texts."""
    found = (parse_order(text) for text in texts)
    return tuple(order for order in found if order is not None)
