"""Two goals with deadlines: the mission is won when both are reached, and lost as soon as one comes too late."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import PLAYED, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

ERRANDS = """
poi "counter"
poi "office"
poi "belt"
connect counter and office distance 3
connect counter and belt distance 4
event "stamp" location office duration 2
event "fetch" location belt duration 1
agent "porter" controllable mobile 1 location counter can_do stamp, fetch
reach_objective: do stamp within 20
reach_objective: do fetch after 5 within 40
"""


def written(folder: Path) -> Path:
    """The workspace of the errands."""
    scenario = parse(ERRANDS, "errands.pur", "errands")
    won = solve_scenario(scenario, Rules())
    options = Options(reaction=Rules().reaction)
    return write_workspace(scenario, won.network, won.objective, won.strategy, options, folder)


def test_a_mission_with_two_goals_is_won_when_both_are_reached(ros: Ros, tmp_path: Path) -> None:
    folder = lay_over(ros, written(tmp_path / "ws"))
    with launched(ros, folder, tmp_path, ("porter",), mode="still", use_sim_time=True, speed=2) as run:
        stamped = run.until_step("stampDONE")
        assert (stamped["places"]["reachObj"], stamped.status) == ("win", "running")
        assert run.until_over() == "won", run.output()
        assert "All goals are reached" in run.output()


def test_a_goal_that_comes_too_late_is_named(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robot, which never arrives."""
    folder = lay_over(ros, written(tmp_path / "ws"))
    calm = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    with launched(ros, folder, tmp_path, ("porter",), **PLAYED, **calm, use_sim_time=True, speed=2) as run:
        run.until_step("porter_counter2office")
        assert run.until_over() == "lost", run.output()
        assert "a deadline has passed (broken: do stamp within 20)" in run.output()
