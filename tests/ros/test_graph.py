"""The ROS graph of the report is the one that the master of a running mission knows."""

from __future__ import annotations

import time
import xmlrpc.client
from pathlib import Path
from typing import Callable, Dict, List, Set, Tuple

import pytest
from ros_world import SCENARIOS, Ros, end

from pursue_gen.language import load
from pursue_gen.partition import partition
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.tools.report.ros_graph import topics
from tests.waiting import PATIENCE

Build = Callable[..., Path]
Graph = Tuple[Dict[str, Set[str]], Dict[str, Set[str]]]

pytestmark = pytest.mark.ros

LAUNCH = "source devel/setup.bash; exec roslaunch {}_bringup mission.launch autostart:=false"


def seen(uri: str) -> Graph:
    """Topic → publishers, topic → subscribers, without ROS's own log."""

    def named(listed: List[List[object]]) -> Dict[str, Set[str]]:
        found = {str(topic): set(map(str, nodes)) for topic, nodes in listed}  # type: ignore[call-overload]
        return {topic: nodes for topic, nodes in found.items() if not topic.startswith("/rosout")}

    with xmlrpc.client.ServerProxy(uri) as master:
        _, _, (publishers, subscribers, _) = master.getSystemState("/test")  # type: ignore[misc]
    return named(publishers), named(subscribers)


@pytest.mark.parametrize("name", ["thesis/scenario_1", "work_cell/clean_room", "hotel/one_lift"])
def test_the_master_knows_the_nodes_and_topics_of_the_report(
    ros: Ros, built: Build, tmp_path: Path, name: str
) -> None:
    scenario = load(str(SCENARIOS / f"{name}.pur"))
    won = solve_scenario(scenario, Rules())
    some = topics(scenario, partition(won.strategy, won.network, scenario.agents))
    expected = (
        {t.name: set(t.publishers) for t in some if t.publishers},
        {t.name: set(t.subscribers) for t in some if t.subscribers},
    )
    with ros.master() as there:
        mission = ros.start(LAUNCH.format(scenario.name), built(name), tmp_path / "log", **there)
        try:
            deadline = time.monotonic() + PATIENCE
            while seen(there["ROS_MASTER_URI"]) != expected and time.monotonic() < deadline:
                time.sleep(0.3)
            assert seen(there["ROS_MASTER_URI"]) == expected
        finally:
            end(mission)
