"""Planning again in a simulated mission: the planner itself, in this process, and a simulated time that it takes."""

from __future__ import annotations

import random
import threading
from typing import Any, Callable, Dict, Optional

from pursue_gen.tools.simulation.event_queue import EventQueue
from pursue_gen.tools.simulation.stage import Stage
from pursue_runtime.observer.planner import no_plan
from pursue_runtime.observer.planning import PlanRequest

MIN_TIME, MAX_TIME = 0.2, 3.0
"""Seconds between which the planner answers. Not measured."""

STATES = 12_000
"""The states that the planner may take (see `replan`): the same on every machine. Not measured."""


SEARCHES = threading.Event()
"""Set while a plan is looked for in this process, which may take long: for whoever shows what it does."""


class SimulatedPlanner:
    """Looks for one plan at a time; `answer` gets the name of a call of the mission, `planned` or `unplanned`, and its
    arguments."""

    def __init__(self, stage: Stage, events: EventQueue, seed: str, answer: Callable[..., None]) -> None:
        self._stage, self._events, self._answer = stage, events, answer
        self._draw = random.Random(f"{seed}/planner")
        self._number = 0

    def request_plan(self, request: Optional[PlanRequest]) -> None:
        """This plan is wanted now (None: none is)."""
        number = request.number if request else 0
        if number == self._number:
            return
        self._number = number
        if request is not None:
            delay = self._draw.uniform(MIN_TIME, MAX_TIME)
            self._events.schedule(self._events.now + delay, lambda: self._search(request))

    def _search(self, request: PlanRequest) -> None:
        if request.number != self._number:
            return
        found = self._replan(request)
        if found.get("won"):
            self._answer("planned", request.number, found)
        else:
            self._answer(*no_plan(request.number, str(found["why"]), found.get("possible", 0.0)))

    def _replan(self, request: PlanRequest) -> Dict[str, Any]:
        if self._stage.request is None:
            return {"won": False, "why": "the workspace has no planner"}
        from pursue_gen.tools.replanning import replan

        SEARCHES.set()
        try:
            return dict(replan({"format": 1, "game": self._stage.request, **request.data()}, STATES))
        finally:
            SEARCHES.clear()
