"""A mission with labels and decimals on ROS: people read labels, topics have names, times are those of the scenario."""

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

ERRAND = """\
poi "desk" label "front desk"
poi "door2" label "<b>security</b> door: {{ x }}"
connect desk and door2 distance 2.5
event "give" label "hand 'it' over & leave" location door2 duration 0.5 to 1.75
agent "porter" label "Porter #1, $(whoami)" controllable mobile 0.5 location desk can_do give
reach_objective: do give after 2.5 within 9.75
"""


def test_people_read_labels_and_times_have_decimals(ros: Ros, tmp_path: Path) -> None:
    read = parse(ERRAND, "errand.pur", "errand")
    won = solve_scenario(read, DEFAULT)
    folder = write_workspace(
        read, won.network, won.objective, won.strategy, Options(reaction=DEFAULT.reaction), tmp_path / "ws"
    )
    with launched(ros, lay_over(ros, folder), tmp_path, ("porter",), mode="still", use_sim_time=True, speed=2) as run:
        assert run.until_over() == "won", run.output()
        states, orders, output = run.states(), run.orders(), run.output()
    assert ("porter", "give") in orders
    assert "Porter #1, $(whoami) sets off from front desk to <b>security</b> door: {{ x }}" in output
    assert "Porter #1, $(whoami) begins hand 'it' over & leave" in output
    assert {state["places"]["porter"] for state in states} == {
        "desk", "going_desk_to_door2", "door2", "doing_give_in_door2"
    }
    moved = [state["clocks"]["Cporter"] for state in states if state["places"]["porter"] == "going_desk_to_door2"]
    assert max(moved) <= 2.25 + 0.5
