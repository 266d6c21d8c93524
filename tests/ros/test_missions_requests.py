"""A mission on ROS whose orders come again while others wait: each is answered, and one too many is said."""

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
poi "desk"
poi "shelf"
connect desk and shelf distance 3
event "order" location desk
event "pack" location shelf duration 20
agent "bot" controllable mobile 1 location desk can_do pack
agent "shop" location desk can_do order
objective: if order then pack within 100, at_most 2 open
"""


def test_each_order_is_packed_and_one_too_many_breaks_what_is_assumed(ros: Ros, tmp_path: Path) -> None:
    read = parse(SHOP, "shop.pur", "shop")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), mode="still", use_sim_time=True, speed=4) as run:
        run.until(lambda: run.now()["status"] == "running")

        def order() -> None:
            before = run.steps().count("order")
            run.until(lambda: run.now()["clocks"]["Cshop"] > 1.1)
            run.publish("shop:order")
            run.until(lambda: run.steps().count("order") > before)

        order()
        order()
        run.until(lambda: run.orders().count(("bot", "pack")) == 2)
        run.until(lambda: {run.now()["places"][name] for name in ("obj", "obj2")} == {"idle"})
        assert run.now()["values"]["assume1"] == 1
        for _ in range(30):  # sooner or later three wait, however slow this machine is
            order()
            if run.now()["values"]["assume1"] == 0:
                break
        said = "order happens only while fewer than 2 wait for pack"
        state = run.until(lambda: next((each for each in run.states() if said in str(each["reason"])), None))
        assert (state["status"], state["values"]["assume1"]) == ("holding", 0)
