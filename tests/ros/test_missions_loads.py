"""A mission with things that are carried, a tool that has to be mounted, and a patrol by one of two robots."""

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

SHOP = """\
poi "store"
poi "shop"
connect store and shop distance 2
thing "box"
thing "brush"
event "load" location store duration 1 takes box
event "unload" location shop gives box
event "change" location store duration 1 mounts brush
event "sweep" location shop duration 1 needs brush
agent "cart" controllable mobile 1 carries 2 location shop can_do load, unload, change, sweep
agent "guard" controllable mobile 1 location shop
objective: patrol shop every 20 by cart or guard
reach_objective: do unload 3 times
reach_objective: do sweep
"""


def test_boxes_are_brought_and_a_tool_is_mounted_before_it_is_used(ros: Ros, tmp_path: Path) -> None:
    read = parse(SHOP, "shop.pur", "shop")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    robots = ("cart", "guard")
    with launched(ros, lay_over(ros, folder), tmp_path, robots, mode="still", use_sim_time=True, speed=2) as run:
        assert run.until_over() == "won", run.output()
        states, orders = run.states(), [what for robot, what in run.orders() if robot == "cart"]
    assert orders.index("change") < orders.index("sweep")
    carried = 0
    for what in orders:
        carried += {"load": 1, "unload": -1}.get(what, 0)
        assert 0 <= carried <= 2
    assert orders.count("unload") == 3
    loads = {state["values"]["Hcart"] for state in states}
    assert 0 in loads and len(loads) >= 3 and "Hguard" not in states[0]["values"]
