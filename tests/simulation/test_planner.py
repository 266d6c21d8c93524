"""The simulated planner belongs to its observer, as the real one does."""

from __future__ import annotations

from typing import Optional

from pursue_gen.simulation.faults import Crash
from pursue_gen.simulation.mission import SimulatedMission
from pursue_gen.simulation.outcome import GOAL, Settings
from pursue_runtime.observer.planning import PlanRequest
from pursue_runtime.state import STOPPED
from tests.simulation.stages import margin, stage

NAME = "thesis/scenario_1"


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
