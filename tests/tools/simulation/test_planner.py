"""The simulated planner belongs to its observer, as the real one does."""

from __future__ import annotations

from functools import partial
from typing import Any, Dict, Optional, Set

from pursue_gen.tools.simulation.faults import Crash
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.nodes import ControllerNode
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_runtime.observer.planning import PlanRequest
from pursue_runtime.state import STOPPED
from tests.tools.simulation.stages import margin, stage

NAME, THIEF = "thesis/scenario_1", "thesis/catch_the_thief"


class Interrupted(SimulatedMission):
    """A mission whose observer dies while the first plan is looked for, and is away until the answer would come."""

    crashes = 0

    def request_plan(self, request: Optional[PlanRequest]) -> None:
        super().request_plan(request)
        if request is not None and not self.crashes:
            self.crashes += 1
            self.events.schedule(self.events.now + 0.1, lambda: self._crash(Crash(0.0, "observer", 5.0)))


def test_a_restarted_observer_looks_again_for_the_plan_that_it_was_looking_for() -> None:
    settings = Settings("still", ("failed",), margin=margin(NAME))
    missions = [Interrupted(stage(NAME), settings, seed, None) for seed in range(1, 7)]
    ends = [mission.run().end for mission in missions]
    assert sum(mission.crashes for mission in missions) >= 3
    assert set(ends) <= {GOAL, STOPPED}


class Unheard(SimulatedMission):
    """A mission whose controllers die when a new plan is in force; what they are sent first of it when they are started
    again is lost."""

    def __init__(self, seed: int) -> None:
        super().__init__(stage(THIEF), Settings("random", ("failed",), margin=margin(THIEF)), seed, None)
        self.died: Set[str] = set()
        self.lost: Set[str] = set()

    def publish_plan(self, plan: Dict[str, Any]) -> None:
        super().publish_plan(plan)
        for name in self._controllers:
            self.events.schedule(self.events.now + 1.0, partial(self._die, name))

    def _die(self, name: str) -> None:
        self.died.add(name)
        self._crash(Crash(0.0, name, 0.5))

    def _send_plan(self, node: ControllerNode, plan: Dict[str, Any]) -> None:
        send = self._connections.send
        if node.name in self.died - self.lost:
            self.lost.add(node.name)
            self._connections.send = lambda *message: None  # type: ignore[method-assign]
        super()._send_plan(node, plan)
        self._connections.send = send  # type: ignore[method-assign]


def test_a_plan_that_is_lost_comes_when_the_controller_has_connected_once_more() -> None:
    missions = [Unheard(seed) for seed in range(1, 9)]
    assert [mission.run().end for mission in missions] == [GOAL] * 8
    assert sum(bool(mission.lost) for mission in missions) >= 3
