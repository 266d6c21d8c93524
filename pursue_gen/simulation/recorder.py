"""What is published in a simulated mission, as a recorder on robots would have it, but for its exact moments."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping

from pursue_gen.replay.record import MissionRecord, RecordedWord, RobotOrder, read_word
from pursue_runtime.locations import is_movement
from pursue_runtime.orders import Order
from pursue_runtime.state import SystemState


class Recorder:
    """Keeps states, words, orders and plans of one mission, each at its moment (seconds)."""

    def __init__(self) -> None:
        self.states: List[SystemState] = []
        self.words: List[RecordedWord] = []
        self.orders: List[RobotOrder] = []
        self.plans: Dict[int, Mapping[str, Any]] = {}

    def on_word(self, now: float, text: str, node: str) -> None:
        """A node publishes a word."""
        self.words.append(read_word(now, text, node))

    def on_order(self, now: float, order: Order, node: str, again: bool) -> None:
        """A controller sends its robot an order; `again`: it was restarted since its last one."""
        action = "" if is_movement(order.location) and not order.at_once else order.event
        self.orders.append(RobotOrder(now, order.agent, node, None, action, order.seq, order.location, again))

    def record(self) -> MissionRecord:
        """All of it."""
        return MissionRecord(tuple(self.states), tuple(self.words), tuple(self.orders), self.plans, is_exact=True)
