"""Robots that people take out of service while a mission is under way, and bring back.

Nothing is sent to a robot that is out of service; it stands where it is, and counts there. Only a plan that is proven
without it takes it out.
"""

from __future__ import annotations

from typing import Collection, FrozenSet, Iterable, Mapping, Optional, Sequence, Set

from pursue_runtime.locations import is_under_way
from pursue_runtime.model import Model, Move, Position
from pursue_runtime.observer.ordering import LEAVE, PersonOrder, Refused
from pursue_runtime.sentences import marked


class Service:
    """The robots that are `out` of service."""

    def __init__(self, model: Model) -> None:
        self.out: Set[str] = set()
        self._robots = tuple(automaton.name for automaton in model.of_kind("robot"))

    def adopt(self, out: Iterable[str]) -> None:
        """Take the robots as they are in a state."""
        self.out = set(out)

    def after(self, order: Optional[PersonOrder] = None) -> FrozenSet[str]:
        """The robots that are out of service once an order is taken; without one those of now."""
        if order is None or not order.is_service:
            return frozenset(self.out)
        return frozenset(self.out | {order.event} if order.how == LEAVE else self.out - {order.event})

    def check(self, order: PersonOrder, displaced: Mapping[str, str], silent: Collection[str]) -> None:
        """Raise Refused where a robot cannot leave or join now."""
        robot = order.event
        if robot not in self._robots:
            raise Refused(f"there is no robot {robot}; expected one of {', '.join(map(marked, self._robots))}")
        if order.how == LEAVE:
            if robot in self.out:
                raise Refused(f"{marked(robot)} is out of service already")
        elif robot not in self.out:
            raise Refused(f"{marked(robot)} is in service already")
        elif robot in displaced:
            raise Refused(f"{marked(robot)} {displaced[robot]}: bring it back to where it left, and order it again")
        elif controller_of(robot) in silent:
            raise Refused(f"{controller_of(robot)} is silent: start it, and order it again")

    def take(self, order: PersonOrder, position: Position) -> str:
        """Take a robot out of service, or bring it back, and return that as a sentence."""
        self.out, robot = set(self.after(order)), marked(order.event)
        if order.how != LEAVE:
            return f"{robot} is in service again"
        place = position.locations[order.event]
        if is_under_way(place):
            return f"{robot} is out of service: it ends what it does, and nothing else is sent to it"
        return f"{robot} is out of service: nothing is sent to it; it stands at {marked(place)}, and counts there"

    def commanded(self, moves: Sequence[Move]) -> str:
        """Return whom of them the moves of a command would have do something; "": nobody."""
        return next((name for name, edge in moves if name in self.out and not edge.is_end), "")

    @staticmethod
    def unneeded(out: Iterable[str], locations: Mapping[str, str]) -> FrozenSet[str]:
        """Return the controllers of those that stand: they may be silent, unless they command others."""
        return frozenset(controller_of(name) for name in out if not is_under_way(locations[name]))


def controller_of(robot: str) -> str:
    """Return the node that commands a robot, where each has its own."""
    return f"controller_{robot}"
