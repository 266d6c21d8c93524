"""Simulated missions in which it is found out late what a state is: they wait for it, and a plan may be looked for."""

from __future__ import annotations

from pathlib import Path

from pursue_gen.language import load
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.state import STOPPED

SEARCH = Path(__file__).resolve().parents[3] / "scenarios" / "warehouse" / "which_shelf.pur"


def test_a_mission_waits_for_what_is_found_out_late() -> None:
    scenario = load(SEARCH)
    won = solve_scenario(scenario, DEFAULT)
    stage = stage_of(scenario, won, Options(reaction=won.reaction))
    ends = set()
    for seed in (0, 1, 4, 9):
        mission = SimulatedMission(stage, Settings("random", ("late",), until=300.0), seed, None)
        outcome = mission.run()
        assert outcome.problems == () and outcome.end in (GOAL, STOPPED)
        if any("onA" in state.late for state in mission.recorder.states):
            ends.add(outcome.end)
    assert GOAL in ends
