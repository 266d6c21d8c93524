"""What the robots' side has acknowledged of what robots were ordered to do at once, as it counts for the goal."""

from __future__ import annotations

from typing import AbstractSet, Iterable, List, Set, Tuple

from pursue_gen.tools.replay.finding import FAULT, UNRECORDED, Finding
from pursue_gen.tools.replay.record import MissionRecord
from pursue_runtime.event_words import ORDERED
from pursue_runtime.orders import parse_orders
from pursue_runtime.state import WON, SystemState

Receipt = Tuple[str, int]
"""A robot, and the number of the state that its order follows from."""


def receipts_in(record: MissionRecord, controllers: AbstractSet[str]) -> Set[Receipt]:
    """Return which orders were acknowledged, by other nodes than those that give them."""
    return {
        (word.agent, word.seq)
        for word in record.words
        if word.event == ORDERED and word.seq is not None and word.node not in controllers
    }


def without_receipt(
    record: MissionRecord, at_once: Iterable[Tuple[str, SystemState]], receipts: AbstractSet[Receipt]
) -> List[Finding]:
    """Return a finding for each order of a won mission that was to be acknowledged, and was not.

    `at_once`: robots, and the states that follow from what they were commanded to do at once. Actions without numbers,
    which a robot gets where `orders` is not numbered, are acknowledged by nobody; neither are those of a recording
    whose states have no orders, which is older.
    """
    orders = [(state, order) for state in record.states for order in parse_orders(state.orders)]
    if not orders or not any(state.status == WON for state in record.states):
        return []
    plain = {(order.robot, order.action) for order in record.orders if order.action and order.seq is None}
    wanted = {(robot, state.seq): (state, state.event) for robot, state in at_once}
    for state, order in orders:
        if order.at_once:
            wanted.setdefault((order.agent, order.seq), (state, order.event))
    found: List[Finding] = []
    for (robot, seq), (state, event) in sorted(wanted.items(), key=lambda entry: entry[0]):
        if (robot, seq) not in receipts and (robot, event) not in plain:
            level = UNRECORDED if state.stamp <= record.whole_from else FAULT
            text = f"the mission was won, but {robot}'s side has not acknowledged {event}"
            found.append(Finding(level, "unacknowledged", seq, text))
    return found
