"""Robots that pass each other in a corridor on ROS: whose turn it is outlives the nodes that know it."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from benchmarks.ordinary_families import pass_in_a_corridor
from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

ROBOTS = ("bot1", "bot2", "bot3", "bot4")


def test_four_robots_change_places_though_observer_and_controllers_are_killed(ros: Ros, tmp_path: Path) -> None:
    read = parse(pass_in_a_corridor(4), "corridor.pur", "corridor")
    won = solve_scenario(read, DEFAULT)
    assert won.strategy.passages
    options = Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ROBOTS, use_sim_time=True, speed=2, lost_after=1000) as run:
        before = run.until_step("bot1_hall12hall2")
        assert before["places"]["hall2_passage"] == "has_bot1_1"
        run.until_back("observer", run.kill("observer"))
        assert run.now()["places"]["room1_passage"] != "has_bot1_1", "bot1 has left its room, and that is known still"
        run.until_back("controller_bot2", run.kill("controller_bot2"))
        assert run.until_over() == "won", run.output()
        states = run.states()
    for state in states:
        rooms = [state["places"][name] for name in ROBOTS if not state["places"][name].startswith("going")]
        rooms = [place.rpartition("_in_")[2] for place in rooms]
        assert len(set(rooms)) == len(rooms), state["places"]
