"""The times in simulated missions, whose robots keep to the model: all movements and actions are measured, and none
leaves its window."""

from __future__ import annotations

from pathlib import Path
from typing import List

import pytest

from pursue_gen.language import load
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.calibration.proposal import Options, propose
from pursue_gen.tools.calibration.samples import Way, of_record
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options as WorkspaceOptions
from pursue_runtime.state import SystemState

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"


class Recorded(SimulatedMission):
    """A mission that keeps the states of its observer."""

    def __init__(self, stage: Stage, seed: int) -> None:
        super().__init__(stage, Settings("random", (), until=200.0), seed, None)
        self.states: List[SystemState] = []

    def publish(self, state: SystemState) -> None:
        self.states.append(state)
        super().publish(state)


@pytest.mark.parametrize("name", ["airport/luggage", "hotel/laundry", "thesis/catch_the_thief"])
def test_missions_that_keep_to_the_model_leave_no_window(name: str) -> None:
    scenario = load(str(SCENARIOS / f"{name}.pur"))
    stage = stage_of(scenario, solve_scenario(scenario, DEFAULT), WorkspaceOptions())
    works = drives = 0
    for seed in range(3):
        mission = Recorded(stage, seed)
        mission.run()
        found = of_record(MissionRecord(tuple(mission.states)), scenario)
        robots = {agent.name for agent in scenario.agents if agent.is_robot}
        entered = [
            (agent, after.locations[agent])
            for before, after in zip(mission.states, mission.states[1:])
            for agent in robots
            if after.locations[agent] != before.locations[agent]
        ]
        ways = [what for what in entered if role_of(what[1]) is Role.WAY]
        of_robots = [s for s in (*found.measured, *found.unused) if isinstance(s.what, Way) and s.what.agent in robots]
        assert len(of_robots) == len(ways) and found.strangers == ()
        works += sum(not isinstance(sample.what, Way) for sample in found.measured)
        drives += len(ways)
        proposal = propose(scenario, found, Options(found.unit or 1.0))
        assert proposal.left[0] == 0, proposal.left_most
    assert works + drives > 0
