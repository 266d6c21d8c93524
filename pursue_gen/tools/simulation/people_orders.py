"""People who order in a simulated mission: at any time, what the scenario lets them, as soon as they like, or what they
write, and who change their minds; who take robots out of service, and bring them back."""

from __future__ import annotations

import random
from typing import Callable, Dict

from pursue_gen.tools.simulation.event_queue import EventQueue
from pursue_gen.tools.simulation.stage import Stage

USUAL = 60.0
"""Time units between orders where none has a deadline. Not measured."""

CANCELLED, URGENT = 0.2, 0.1
"""The shares of orders that are cancelled some time later, and that are urgent. Not measured."""


WRITTEN = 0.2
"""The share of orders with which somebody writes one as well: a robot that is to be at a place. Not measured."""

LEAVING, AWAY = 0.3, 200.0
"""The share of orders with which a robot is taken out of service as well, and the time units until it is brought back
at most. Not measured."""


class PeopleOrders:
    """Orders of a mission, which `order` gets as texts: one after the other, at random times."""

    def __init__(self, stage: Stage, events: EventQueue, seed: str, order: Callable[[str], None]) -> None:
        self._menu = tuple(event.name for event in stage.scenario.orders)
        self._deadlines: Dict[str, float] = {}
        for each in (each for each in stage.scenario.safety if each.called_by in self._menu):
            longest = float(each.known_limit)
            self._deadlines[each.called_by] = min(longest, self._deadlines.get(each.called_by, longest))
        self._events, self._order, self._robots = events, order, stage.robots
        self._draw, self._mood = random.Random(f"{seed}/orders"), random.Random(f"{seed}/mood")
        self._service, self._writer = random.Random(f"{seed}/service"), random.Random(f"{seed}/written")
        self._places = [poi.name for poi in stage.scenario.pois]

    def begin(self) -> None:
        """Order from now on, where there is something to order."""
        if self._menu:
            longest = max(self._deadlines.values(), default=USUAL)
            self._events.schedule(self._events.now + self._draw.uniform(0, longest), self._next)

    def _next(self) -> None:
        event = self._draw.choice(self._menu)
        deadline = self._deadlines.get(event)
        sooner = deadline is not None and self._draw.random() < 0.5
        text = f"{event} within {self._draw.uniform(0.2, 1.0) * (deadline or 0):.1f}" if sooner else event
        self._order(f"urgent {text}" if self._mood.random() < URGENT else text)
        if self._mood.random() < CANCELLED:
            later = self._events.now + self._mood.uniform(0, 0.5) * (deadline or USUAL)
            self._events.schedule(later, lambda: self._order(f"cancel {event}"))
        if self._writer.random() < WRITTEN:
            where = f"{self._writer.choice(self._robots)} at {self._writer.choice(self._places)}"
            self._order(f"{where} within {self._writer.uniform(0.5, 2.0) * (deadline or USUAL):.1f}")
        if self._service.random() < LEAVING:
            robot = self._service.choice(self._robots)
            self._order(f"leave {robot}")
            back = self._events.now + self._service.uniform(0, AWAY)
            self._events.schedule(back, lambda: self._order(f"join {robot}"))
        self.begin()
