"""A mission on ROS of a scenario that says what a unit of time is, how fast a robot drives, and how long it rests."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

ERRAND = """\
unit 2 s
rest 1 s
poi "desk"
poi "shelf"
connect desk and shelf distance 4
event "fetch" location shelf duration 3 s to 6 s
agent "bot" controllable speed 0.5 location desk can_do fetch
reach_objective: do fetch within 1 min
"""


def test_a_unit_of_time_lasts_as_long_as_the_scenario_says(ros: Ros, tmp_path: Path) -> None:
    """The way takes 8 to 10 seconds, which are 4 to 5 units."""
    read = parse(ERRAND, "errand.pur")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), use_sim_time=True, speed=4) as run:
        assert run.until_over() == "won", run.output()
        assert re.search(r"The goal is reached, after \d+\.\d units of 2 s\.", run.output())
        states = run.states()
    assert {float(state["unit"]) for state in states} == {2.0}
    came = {state["places"].get("bot"): float(state["stamp"]) for state in reversed(states)}
    assert 8.0 - 0.2 <= came["shelf"] - came["going_desk_to_shelf"] <= 10.0 + 0.2, came
    assert 1.0 - 0.2 <= came["doing_fetch_in_shelf"] - came["shelf"] < 2.0, "it rests for a second, not for a unit"
