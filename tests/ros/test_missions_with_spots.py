"""Two robots meet at a place: each is sent to its own spot there, by a controller of its own or by one for both."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List

import pytest
from launched_mission import GOAL, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

MEETING = """
poi "store" //[0, 0, 0, 0, 0, 0, 1]
poi "gate" //[5, 0, 0, 0, 0, 0, 1]
poi "shop" //[10, 0, 0, 0, 0, 0, 1] cart2 [10, -3, 0, 0, 0, 0, 1]
connect store and gate distance 5
connect gate and shop distance 5
event "load" location shop duration 1
event "handOver" collaborative location gate
rule "box": load before handOver
agent "cart1" controllable mobile 1 location store reacts_to handOver
agent "cart2" controllable mobile 1 location gate can_do load, handOver
reach_objective: do handOver
"""


@pytest.mark.parametrize("controllers", ["distributed", "centralized"])
def test_each_robot_is_sent_to_its_own_spot(ros: Ros, tmp_path: Path, controllers: str) -> None:
    scenario = parse(MEETING, "meeting.pur")
    won = solve_scenario(scenario, Rules())
    options = Options(controllers=controllers, reaction=Rules().reaction)
    folder = write_workspace(scenario, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    robots = ("cart1", "cart2")
    with launched(ros, lay_over(ros, folder), tmp_path, robots, use_sim_time=True, speed=5, delays="middle") as run:
        assert run.until_over() == "won", run.output()
        sent: Dict[str, List[List[float]]] = {robot: [] for robot in robots}
        for entry in run.of(GOAL):
            sent[entry["robot"]].append(entry["data"])
    assert sent == {"cart1": [[5.0, 0.0]], "cart2": [[10.0, -3.0], [5.0, 0.8]]}
