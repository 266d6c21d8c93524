"""Missions on ROS in which a robot breaks off what takes long, as something is due sooner, and begins it again: all of
it, or the part that it was at."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

GARDEN = """\
poi "bench"
poi "tomatoes"
connect bench and tomatoes distance 3
event "prune" location tomatoes duration 20 may_stop
event "answer" location bench
event "call"
agent "bot" controllable mobile 1 location bench can_do prune, answer
agent "gerda" location bench can_do call
assume: gerda does call at_most 1 times
objective: if call then answer within 14
reach_objective: do prune
"""


def test_a_robot_is_told_to_break_off_and_begins_again(ros: Ros, tmp_path: Path) -> None:
    """The test calls while the robot prunes; robot and its node are simulated."""
    read = parse(GARDEN, "garden.pur", "garden")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    over = lay_over(ros, write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws"))
    with launched(ros, over, tmp_path, ("bot",), mode="still", use_sim_time=True, speed=2) as run:
        run.until_step("prune")
        run.publish("call")
        stopped = run.until_step("pruneSTOP")
        assert stopped["places"]["bot"] == "tomatoes"
        run.until_step("answer")
        assert run.until_over() == "won", run.output()
        acts = [order for robot, order in run.orders() if order in ("prune", "pruneSTOP", "answer")]
        assert acts == ["prune", "pruneSTOP", "answer", "prune"]
        assert run.steps().count("pruneDONE") == 1


def test_it_goes_on_with_the_part_that_was_begun(ros: Ros, tmp_path: Path) -> None:
    """The same with two parts: the second one is broken off, and the first one is not done again."""
    read = parse(GARDEN.replace("20 may_stop", "40 may_stop in 2 parts"), "garden.pur", "garden")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    over = lay_over(ros, write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws"))
    with launched(ros, over, tmp_path, ("bot",), mode="still", use_sim_time=True, speed=2) as run:
        run.until(lambda: run.steps().count("prune") == 2)
        run.publish("call")
        run.until_step("pruneSTOP")
        assert run.until_over() == "won", run.output()
        acts = [order for robot, order in run.orders() if order in ("prune", "pruneSTOP", "answer")]
        assert acts == ["prune", "prune", "pruneSTOP", "answer", "prune"]
        assert (run.steps().count("prunePART"), run.steps().count("pruneDONE")) == (1, 1)
