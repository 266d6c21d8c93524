"""A mission with a lift that holds two, whoever they are, on ROS: at no moment are more of them in it."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from pursue_gen.language import load
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

LIFT = Path(__file__).resolve().parents[2] / "scenarios" / "warehouse" / "goods_lift.pur"


def test_nobody_enters_a_lift_that_may_be_full(ros: Ros, tmp_path: Path) -> None:
    read = load(LIFT)
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    robots = ("bot1", "bot2")
    with launched(ros, lay_over(ros, folder), tmp_path, robots, mode="random", use_sim_time=True, speed=2) as run:
        assert run.until_over() == "won", run.output()
        states = run.states()
    inside = [[name for name, place in state["places"].items() if place == "lift"] for state in states]
    assert max(map(len, inside)) <= 2
    assert any(set(robots) & set(some) for some in inside)
