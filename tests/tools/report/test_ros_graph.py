"""The ROS graph is that of the generated workspace: its nodes are the launch file's, its topics are in their code."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Dict, Optional, Set

import pytest

from pursue_gen.language import load
from pursue_gen.partition import partition
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.tools.report import graphviz
from pursue_gen.tools.report.ros_graph import DIAGNOSTICS, EVENTS, PLAN, SEEN, STATE, TEXT, Topic, graph, topics
from pursue_gen.workspace import Options, generate

SCENARIO = load(Path(__file__).resolve().parents[3] / "scenarios" / "thesis" / "catch_the_thief.pur")
NAMES = {
    "EVENTS": EVENTS, "STATE": STATE, "SYSTEM_STATE": TEXT, "PLAN": PLAN, "SEEN": SEEN, '"/diagnostics"': DIAGNOSTICS,
}  # fmt: skip
SHARED = {
    "subscribe_states(": "Subscriber(STATE, ", "subscribe(": "Subscriber(", "Witnesses(": "Subscriber(SEEN, ",
    "Witness(": "Publisher(SEEN, ",
    "Membership(": 'Publisher(SEEN, Subscriber(PLAN, Subscriber(STATE, Subscriber("/diagnostics", Diagnostics(',
    "Diagnostics(": 'Publisher("/diagnostics", ',
}  # fmt: skip
"""What nodes call in other modules, and what that does there."""


@pytest.fixture(scope="module")
def won() -> Solution:
    return solve_scenario(SCENARIO, Rules())


@pytest.fixture(scope="module")
def files(won: Solution) -> Dict[str, bytes]:
    return generate(SCENARIO, won.network, won.objective, won.strategy, Options())


@pytest.fixture(scope="module")
def some(won: Solution) -> "tuple[Topic, ...]":
    return topics(SCENARIO, partition(won.strategy, won.network, SCENARIO.agents))


def starts(condition: Optional[str], given: Dict[str, str]) -> bool:
    """Whether roslaunch starts a node with such an `if`, with these arguments."""
    values = {name: {"true": True, "false": False}.get(text, text) for name, text in given.items()}
    if condition is None:
        return True
    kind, expression = condition[2:-1].split(" ", 1)
    return bool(values[expression] if kind == "arg" else eval(expression, {**values, "arg": values.get, "bool": bool}))


def test_the_nodes_are_those_of_the_launch_file(files: Dict[str, bytes], some: "tuple[Topic, ...]") -> None:
    launch = ElementTree.fromstring(files["src/catch_the_thief_bringup/launch/mission.launch"])
    given = {arg.attrib["name"]: arg.get("default", "") for arg in launch.iter("arg")}
    given["markers"] = given["rviz"]  # whose default it has
    started = {node.attrib["name"] for node in launch.iter("node") if starts(node.get("if"), given)}
    assert {name.strip("/") for topic in some for name in (*topic.publishers, *topic.subscribers)} == started


def calls(files: Dict[str, bytes], package: str, script: str, call: str) -> Set[str]:
    """The fixed topics that a node's code names in such calls: its own module, and those that it shares."""
    found = re.search(r"from pursue_runtime.nodes import (\w+)", files[f"src/{package}/scripts/{script}"].decode())
    assert found is not None
    beside = {"controller": ["exeggutor"], "ui": ["ui_state"]}.get(found.group(1), [])
    modules = [found.group(1), "node", *beside]
    paths = [f"src/pursue_runtime/src/pursue_runtime/nodes/{module}.py" for module in modules]
    code = "\n".join(files[path].decode() for path in paths)
    for name, what in SHARED.items():
        code = code.replace(name, what)
    found_names = re.findall(rf"{call}\(\s*([A-Z_]+|\"/diagnostics\"),", code)
    return {NAMES[name] for name in found_names if name in NAMES}


@pytest.mark.parametrize(
    ("package", "script"),
    [("observer", "observer"), ("UI", "UI"), ("UI", "simulator"), ("controller_polBot1", "controller_polBot1")],
)
def test_nodes_publish_and_hear_what_their_code_names(
    files: Dict[str, bytes], some: "tuple[Topic, ...]", package: str, script: str
) -> None:
    node, fixed = f"/{script}", set(NAMES.values())
    assert {t.name for t in some if node in t.publishers} & fixed == calls(files, package, script, "Publisher")
    assert {t.name for t in some if node in t.subscribers} & fixed == calls(files, package, script, "Subscriber")


def test_each_robot_is_reported_by_its_own_controller_and_received_by_the_simulator(some: "tuple[Topic, ...]") -> None:
    for robot in ("polBot1", "polBot2"):
        own = [topic for topic in some if topic.name.startswith(f"/{robot}/")]
        assert {topic.name for topic in own} == {f"/{robot}/move_base_simple/goal", f"/{robot}/pursue/actions"}
        assert all((t.publishers, t.subscribers) == ((f"/controller_{robot}",), ("/simulator",)) for t in own)
    assert not any(topic.name.startswith("/thief") for topic in some)


@pytest.mark.skipif(not graphviz.installed(), reason="graphviz is not installed")
def test_the_picture_has_every_node_topic_and_arrow(some: "tuple[Topic, ...]") -> None:
    picture = ElementTree.fromstring(graphviz.draw(graph(some)) or "")
    words = {element.text for element in picture.iter("{http://www.w3.org/2000/svg}text")}
    drawn = [topic for topic in some if topic.name != DIAGNOSTICS]
    assert {topic.name for topic in drawn} | {"/observer", "/UI", "/controllerObj", "/simulator"} <= words
    arrows = [e for e in picture.iter("{http://www.w3.org/2000/svg}g") if e.get("class") == "edge"]
    assert len(arrows) == sum(len(topic.publishers) + len(topic.subscribers) for topic in drawn)
