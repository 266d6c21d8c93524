"""The timeline of a mission, from its states: a lane for each agent, with what it did from when to when, and for each
objective, with when something was due.

Moments are time units since the start of the mission.
"""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional

from pursue_runtime.locations import is_action, is_movement
from pursue_runtime.model import Automaton, Model
from pursue_runtime.state import ENDED, LIVE, SystemState
from pursue_runtime.ui.promise import BROKEN, NOTHING, Promise, objectives_now
from pursue_runtime.vocabulary import where

MOST = 300
"""Segments of a lane; of a longer mission the last ones are kept."""

STANDS, MOVES, ACTS, DUE = "stands", "moves", "acts", "due"


class Segment(NamedTuple):
    """What an agent did, or what an objective was at, from one moment on, until the next segment of its lane begins."""

    begins: float
    kind: str
    text: str


class Lanes:
    """The lanes, as far as states have come: of a mission that was under way already, from the first state on."""

    def __init__(self, model: Model, promise: Promise = NOTHING) -> None:
        """`promise`: what is to be achieved."""
        self._model, self._promise = model, promise
        self._agents = model.acting
        self._last: Dict[str, str] = {}
        self._lanes: Dict[str, List[Segment]] = {agent.name: [] for agent in self._agents}
        self._promised: List[List[Segment]] = [[] for _ in promise.objectives]
        self._ends: Optional[float] = None

    def on_state(self, state: SystemState, at: float) -> None:
        """Take a state, `at` time units after the start."""
        if state.status not in (*LIVE, *ENDED) or self._ends is not None:
            return
        for agent in self._agents:
            location = state.locations.get(agent.name, "")
            if self._last.get(agent.name) != location:
                self._last[agent.name] = location
                lane = [*self._lanes[agent.name], self._segment(agent, location, at)]
                self._lanes[agent.name] = lane[-MOST:]
        for number, objective in enumerate(objectives_now(self._promise, (), self._model, state, at)):
            segment, before = self._promised_segment(objective, at), self._promised[number]
            if not before or before[-1][1:] != segment[1:]:
                self._promised[number] = [*before, segment][-MOST:]
        if state.status in ENDED:
            self._ends = at

    def shown(self) -> Optional[Dict[str, Any]]:
        """The lanes for a page; None before the end of the mission, or where nothing is known of it."""
        begins = [lane[0].begins for lane in self._lanes.values() if lane]
        if self._ends is None or not begins:
            return None
        lanes = [{"agent": name, "segments": [list(each) for each in lane]} for name, lane in self._lanes.items()]
        for objective, lane in zip(self._promise.objectives, self._promised):
            if objective.of:
                lanes.append({"promise": objective.name or objective.says, "segments": [list(each) for each in lane]})
        return {"begins": min(begins), "ends": self._ends, "lanes": lanes}

    def _segment(self, agent: Automaton, location: str, at: float) -> Segment:
        kind = MOVES if is_movement(location) else ACTS if is_action(location) else STANDS
        return Segment(round(at, 3), kind, where(self._model, agent, location))

    @staticmethod
    def _promised_segment(objective: Dict[str, Any], at: float) -> Segment:
        if objective["due"] is not None:
            return Segment(round(at, 3), DUE, f"due by {objective['due']:.1f}")
        return Segment(round(at, 3), BROKEN if objective["is"] == BROKEN else STANDS, objective["is"])
