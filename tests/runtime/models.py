"""Models and states for tests of the UI and the simulator."""

from __future__ import annotations

from typing import Any, Dict

from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Cover, read_cover


def mover(name: str, kind: str, speed: int) -> Dict[str, Any]:
    """An agent that goes between a and b (distance `speed`) and may catch wherever it is."""
    clock, position = f"C{name}", f"P{name}"
    edges = []
    for x, y, i, j in (("a", "b", 1, 2), ("b", "a", 2, 1)):
        going = f"going_{x}_to_{y}"
        edges += [
            {"from": x, "to": going, "word": f"{name}_{x}2{y}", "sync": "send", "when": [f"{clock} > 1"],
             "set": {position: -(10 * i + j)}, "reset": [clock], "controllable": kind != "agent"},
            {"from": going, "to": y, "word": f"{name}_{going}2{y}", "sync": "own", "when": [f"{clock} > {speed}"],
             "set": {position: j}, "reset": [clock], "controllable": False},
        ]
    late = [f"{clock} <= {speed + 1}"]
    return {"name": name, "kind": kind, "initial": "a", "edges": edges,
            "locations": {"a": [], "b": [], "going_a_to_b": late, "going_b_to_a": late}}


def desk(*words: str) -> Dict[str, Any]:
    """Where people order these events."""
    edges = [{"from": "listening", "to": "listening", "word": word, "sync": "send", "if": [["order_desk_open=1"]],
              "set": {"order_desk_open": 0}, "controllable": False} for word in words]
    return {"name": "order_desk", "kind": "orders", "initial": "listening", "locations": {"listening": []},
            "edges": edges}


def worker(name: str, kind: str) -> Dict[str, Any]:
    """An agent that may screw (for 3 to 4 units, in its turn) at its station."""
    clock = f"C{name}"
    edges = [
        {"from": "s", "to": "doing_screw_in_s", "word": "screw", "sync": "send", "when": [f"{clock} > 1"],
         "if": [["Prule=0", "Prule=2"]], "set": {}, "reset": [clock], "controllable": kind != "agent"},
        {"from": "doing_screw_in_s", "to": "s", "word": "screwDONE", "sync": "send", "when": [f"{clock} > 3"],
         "set": {}, "reset": [clock], "controllable": False},
    ]
    return {"name": name, "kind": kind, "initial": "s", "edges": edges,
            "locations": {"s": [], "doing_screw_in_s": [f"{clock} <= 4"]}}


def model_data(*automata: Dict[str, Any]) -> Dict[str, Any]:
    """A model.yaml of these automata, with an objective to reach."""
    goal = {"name": "reachObj", "kind": "reach", "initial": "unlocked", "locations": {"unlocked": [], "win": []},
            "edges": [{"from": "unlocked", "to": "win", "word": "screw", "sync": "receive", "controllable": True}]}
    return {"format": 1, "scenario": "example", "clocks": [f"C{a['name']}" for a in automata] + ["Creach"],
            "variables": {"Prule": 0, **{f"P{a['name']}": 1 for a in automata}}, "automata": [*automata, goal],
            "objective": {"kind": "reach", "goal": ["reachObj", "win"], "bad": None}}


def commanding(cover: Dict[str, Any], model: Model) -> Dict[str, Any]:
    """A cover that also commands, in the zones in which it waits, whatever controllable automata can do: in the entries
    that name them, as those of parts do; in all where none does."""
    able = {
        (automaton.name, edge.word): None
        for automaton in model.automata
        for edge in automaton.edges
        if edge.sync != "receive" and edge.controllable
    }
    named = {name for entry in cover["cover"] for name in entry["state"]}
    entries = []
    for entry in cover["cover"]:
        mine = [(agent, event) for agent, event in able if agent in entry["state"] or agent not in named]
        commands = [{"agent": agent, "do": event, "when": entry["wait"]} for agent, event in mine]
        entries.append({**entry, "commands": commands})
    return {**cover, "cover": entries}


def everywhere(model: Model) -> Cover:
    """The cover of a strategy that may command anything at any time."""
    return read_cover(commanding({"cover": [{"state": {}, "wait": ["always"]}]}, model))


def state(model: Any, seq: int, stamp: float, clocks: Dict[str, float], status: str = "running", event: str = "",
          agent: str = "", reason: str = "", unit: float = 1.0, values: Any = None, **locations: str) -> Any:
    """A system state of the model: everything at its start but what is named."""
    start = model.initial()
    return SystemState(
        seq, stamp, {**start.locations, **locations}, {**start.values, **(values or {})}, {**start.clocks, **clocks},
        event, agent, status, reason, unit,
    )
