"""The nodes of a generated mission and the topics between them, as rqt_graph would draw them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

from pursue_gen.language.lifts import doors_of, rides_of
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import SubStrategy
from pursue_gen.partition.split import UI
from pursue_gen.tools.report import graphviz
from pursue_gen.tools.report.graphviz import Graph, arrow, node, quoted
from pursue_gen.tools.report.html import Section, rendered

EVENTS, STATE, TEXT, PLAN = "/pursue/events", "/pursue/state", "/pursue/system_state", "/pursue/plan"
ORDERS, ANSWERS = "/pursue/orders", "/pursue/answers"
SEEN, DOORS, ABOARD = "/pursue/seen", "/pursue/doors", "/pursue/aboard"
DIAGNOSTICS = "/diagnostics"
_STATE = "pursue_msgs/SystemState"
_STRING, _POSE, _STATUS = "std_msgs/String", "geometry_msgs/PoseStamped", "diagnostic_msgs/DiagnosticArray"
_OBSERVER, _SIMULATOR, _DOORS = "/observer", "/simulator", "/doors"


@dataclass(frozen=True)
class Topic:
    """A topic, its type, and the names of the nodes that publish and subscribe to it."""

    name: str
    kind: str
    publishers: Tuple[str, ...]
    subscribers: Tuple[str, ...]


def topics(scenario: Scenario, subs: Sequence[SubStrategy]) -> Tuple[Topic, ...]:
    """The topics of a mission with simulated robots, launched without options; `subs` are its controllers.

    docs/run_time.md describes the topics.
    """
    controllers = tuple(f"/{sub.controller}" for sub in subs if sub.controller != UI)
    robots = {agent.name for agent in scenario.agents if agent.is_robot}
    by_lift = {agent.name for agent in scenario.agents if rides_of(scenario, agent)}
    through = by_lift | {agent.name for agent in scenario.agents if agent.is_robot and doors_of(scenario, agent)}
    doors = (_DOORS,) if by_lift or any(doors_of(scenario, agent) for agent in scenario.agents) else ()
    nodes = (_OBSERVER, *controllers, _SIMULATOR, f"/{UI}")
    result = [
        Topic(EVENTS, _STRING, nodes, (_OBSERVER, f"/{UI}")),
        Topic(STATE, _STATE, (_OBSERVER,), (*controllers, _SIMULATOR, *doors, f"/{UI}")),
        Topic(TEXT, _STRING, (_OBSERVER,), ()),
        Topic(PLAN, _STRING, (_OBSERVER,), (*controllers, _SIMULATOR, *doors, f"/{UI}")),
        Topic(ORDERS, _STRING, (f"/{UI}",), (_OBSERVER,)),
        Topic(ANSWERS, "pursue_msgs/OrderAnswer", (_OBSERVER,), (f"/{UI}",)),
        Topic(SEEN, _STATE, (*controllers, _SIMULATOR, *doors, f"/{UI}"), (_OBSERVER,)),
        Topic(DIAGNOSTICS, _STATUS, (*nodes, *doors), (_OBSERVER, _SIMULATOR, *doors, f"/{UI}")),
    ]
    if doors:
        waiting, riding = (
            tuple(f"/{sub.controller}" for sub in subs if sub.controller != UI and some & set(sub.agents))
            for some in (through, by_lift)
        )
        result.append(Topic(DOORS, _STRING, doors, (*waiting, f"/{UI}")))
        if by_lift:
            posed = any(each.pose is not None for each in scenario.lifts)
            result.append(Topic(ABOARD, _STRING, riding if posed else (), doors))
    for sub in subs:
        for robot in (agent for agent in sub.agents if agent in robots and sub.controller != UI):
            for name, kind in ((f"/{robot}/move_base_simple/goal", _POSE), (f"/{robot}/pursue/actions", _STRING)):
                result.append(Topic(name, kind, (f"/{sub.controller}",), (_SIMULATOR,)))
    return tuple(result)


def graph(some: Sequence[Topic]) -> Graph:
    """Nodes are ellipses, topics boxes; each robot's topics stand in a frame. /diagnostics is left out: all have it."""
    drawn = [topic for topic in some if topic.name != DIAGNOSTICS]
    names: Dict[str, str] = {}
    for topic in drawn:
        for name in (*topic.publishers, *topic.subscribers):
            names.setdefault(name, f"ros-n{len(names)}")
    lines = [node(ident, name, shape="ellipse", style="filled") for name, ident in names.items()]
    spaces: Dict[str, List[str]] = {}
    for k, topic in enumerate(drawn):
        space = topic.name.split("/")[1]
        spaces.setdefault(space, []).append(node(f"ros-t{k}", topic.name, style="filled", fillcolor="#eef1f4"))
    for k, (space, inside) in enumerate(spaces.items()):
        frame = f'id={quoted(f"ros-space{k}")} label={quoted("/" + space)} color="#8a8f98" style="rounded,dashed"'
        lines += [f"subgraph {quoted(f'cluster_{k}')} {{ {frame}", *inside, "}"]
    count = 0
    for k, topic in enumerate(drawn):
        for source, target in (
            *((names[name], f"ros-t{k}") for name in topic.publishers),
            *((f"ros-t{k}", names[name]) for name in topic.subscribers),
        ):
            lines.append(arrow(source, target, f"ros-e{count}"))
            count += 1
    return Graph("ros-graph", "ROS graph", f"{len(names)} nodes and {len(drawn)} topics", lines, sideways=True)


def section(some: Sequence[Topic]) -> Section:
    """The graph on the page, and the same as a table."""
    rows = [(t.name, t.kind, ", ".join(t.publishers), ", ".join(t.subscribers)) for t in some]
    body = rendered("ros_graph", picture=graphviz.draw(graph(some)), rows=rows, how_to_get=graphviz.HOW_TO_GET)
    return Section("ros", "The ROS graph", body)
