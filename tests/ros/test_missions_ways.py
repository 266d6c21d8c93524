"""A mission with ways in one direction, windows, limits, rules for each robot, and names that are words of UPPAAL."""

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

AIRPORT = """\
poi "hall"
poi "plane"
poi "clock"
connect hall and plane distance 2 one_way
connect plane and clock distance 1
connect clock and hall distance 1
event "load" location hall duration 1 to 3 at_most 2 times
event "unload" location plane
event "sweep" location plane duration 1 to 3
event "process" location plane
rule "bag" for each robot: load before unload
rule "work": (unload and sweep) before process
agent "guard" controllable mobile 1 location plane can_do load, unload, process
agent "cart" controllable mobile 1 location plane can_do load, unload, sweep
travel guard from hall to plane takes 3 to 5
travel cart from hall to plane takes 3 to 5
reach_objective: do process
"""


def test_carts_bring_what_they_have_loaded(ros: Ros, tmp_path: Path) -> None:
    """The way back from the plane is the longer one; who unloads is who has loaded."""
    read = parse(AIRPORT, "airport.pur", "airport")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    robots = ("guard", "cart")
    with launched(ros, lay_over(ros, folder), tmp_path, robots, mode="still", use_sim_time=True, speed=2) as run:
        assert run.until_over() == "won", run.output()
        states, orders = run.states(), run.orders()
    whose = {what: robot for robot, what in orders if what in ("load", "unload")}
    assert whose["load"] == whose["unload"]
    places = [state["places"][robot] for state in states for robot in robots]
    assert "going_hall_to_plane" in places and "going_plane_to_hall" not in places
    carrier = whose["load"]
    starts = [s["clocks"][f"C{carrier}"] for s in states if s["places"][carrier] == "going_hall_to_plane"]
    assert starts and max(starts) <= 5.5
