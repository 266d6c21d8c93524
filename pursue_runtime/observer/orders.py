"""The orders to robots that follow from what the strategy commands, and which of them were acknowledged.

Times are seconds of ROS time.
"""

from __future__ import annotations

from typing import Collection, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple

from pursue_runtime.locations import action, is_under_way
from pursue_runtime.model import Model, Move
from pursue_runtime.orders import Order, format_order, parse_orders
from pursue_runtime.sentences import marked


class Orders:
    """What robots are to do: begun by a command of the strategy, or by an agent that nobody controls and with whom they
    do it. What somebody publishes by hand for a robot is none.

    An order of something that is done at once counts as carried out when the robot's side has acknowledged it.
    """

    def __init__(self, model: Model) -> None:
        self._kinds = {automaton.name: automaton.kind for automaton in model.automata}
        self._reacts_to = {automaton.name: automaton.reacts_to for automaton in model.of_kind("robot")}
        self._standing: Dict[Tuple[str, str, int], Order] = {}
        self._given: Dict[Tuple[str, str, int], float] = {}

    def adopt(self, texts: Iterable[str], now: float) -> None:
        """Take the orders of a state."""
        self._standing = {order.key: order for order in parse_orders(texts)}
        self._given = dict.fromkeys(self._standing, now)

    def on_moves(
        self, moves: Tuple[Move, ...], seq: int, is_commanded: bool, lost: Collection[str],
        locations: Mapping[str, str], now: float,
    ) -> None:
        """Take the moves that led to the state of this number, in which automata are at these locations. Requires one
        move at least, that of who acts first."""
        gone = {name for name, edge in moves if edge.source != edge.target}
        for key, order in list(self._standing.items()):
            if order.agent in gone and not order.at_once:
                del self._standing[key], self._given[key]
        doer = moves[0].automaton
        if is_commanded or self._kinds.get(doer) == "agent":
            for order in self._begun(moves, seq, is_commanded, lost, locations):
                self._standing[order.key], self._given[order.key] = order._replace(given=round(now, 6)), now

    def _begun(
        self, moves: Tuple[Move, ...], seq: int, is_commanded: bool, lost: Collection[str], locations: Mapping[str, str]
    ) -> Iterator[Order]:
        doer, first = moves[0]
        for name, edge in moves:
            if name not in self._reacts_to or (name != doer and name in lost):
                continue  # what is lost is moved with the others, and nothing is expected of it
            if edge.source == edge.target:
                if name == doer and is_commanded:
                    yield Order(name, first.word, seq, edge.target, at_once=True)
            elif is_under_way(edge.target):
                yield Order(name, first.word, seq, edge.target)
            elif edge.breaks_off and is_commanded:
                yield Order(name, first.word, seq, edge.target, at_once=True)
        moved = {name for name, _ in moves}
        for robot, events in self._reacts_to.items():
            place = locations[robot]
            if first.word not in events or robot in moved or robot in lost or is_under_way(place):
                continue
            if locations[doer] in (place, action(first.word, place)):
                yield Order(robot, first.word, seq, place, at_once=True)

    def on_receipt(self, robot: str, seq: int, given: Optional[float]) -> bool:
        """Take that the robot's side has the order of this number, and of this time (None: the receipt has none);
        return False where no such order is open."""
        found = [
            key
            for key, order in self._standing.items()
            if (order.agent, order.seq) == (robot, seq) and given in (None, order.given)
        ]
        is_news = False
        for key in found:
            order = self._standing[key]
            is_news |= not order.acknowledged
            if order.at_once:
                del self._standing[key], self._given[key]
            else:
                self._standing[key] = order._replace(acknowledged=True)
        return is_news

    def open_since(self) -> List[Tuple[Order, float]]:
        """Return the orders of what is done at once that were not acknowledged, and when they were given."""
        return [(order, self._given[key]) for key, order in self._standing.items() if order.at_once]

    def awaited(self) -> str:
        """Return whose acknowledgements are missing, in words; "" if none is."""
        orders = [order for order, _ in self.open_since()]
        return " and ".join(f"{marked(order.agent)} has not acknowledged {marked(order.event)}" for order in orders)

    def texts(self) -> Tuple[str, ...]:
        """Return the orders as they stand in the state."""
        return tuple(format_order(order) for order in self._standing.values())


def first_overdue(orders: Iterable[Tuple[Order, float]], patience: float) -> Optional[float]:
    """Return when the first of these orders has been open for `patience` seconds; None: there is none."""
    return min((given + patience for _, given in orders), default=None)
