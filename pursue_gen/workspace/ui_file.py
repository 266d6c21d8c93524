"""What the UI reads: its settings and the simulator's (ui.yaml), the strategies (strategies.yaml). docs/run_time.md has
the formats."""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import Any, Dict, List, Mapping, Optional, Sequence

from pursue_gen.drawing.floor import Floor
from pursue_gen.language.lifts import doors_of, rides_of
from pursue_gen.language.scenario import Connection, Scenario
from pursue_gen.language.sentences import objective_sentence, objective_words
from pursue_gen.language.times import unit_name
from pursue_gen.partition import SubStrategy
from pursue_gen.partition.strategy_data import number, strategy_data
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.solving.answers import told
from pursue_gen.tga.network import Network
from pursue_gen.tga.objectives import stated
from pursue_gen.vocabulary.promises import promise_names, short_name
from pursue_gen.vocabulary.statuses import statuses
from pursue_gen.workspace.context import Options
from pursue_gen.workspace.spots import Placing
from pursue_runtime.locations import movement

LARGEST = 2_000
"""States of strategies that a UI reads at most: it starts with the mission."""


def render(
    scenario: Scenario,
    network: Network,
    where: Placing,
    options: Options,
    controllers: Sequence[str],
    reported: Sequence[str],
    generator: str,
    idle: Sequence[str] = (),
) -> bytes:
    """The text of ui.yaml: the nodes that the UI waits for, the agents whose ends are `reported`, the connections of
    the map with their lengths, what is to be achieved and in which time, what times count, the robots' spots that are
    not the pose of their place, what all but agents is at, in words, and the `idle` agents that the strategy does
    without."""
    spots = {
        robot: {name: inline([pose.x, pose.y]) for name, pose in table.items() if pose != where.places[name]}
        for robot, table in where.spots.items()
    }
    data: Dict[str, Any] = {
        "format": 1,
        "nodes": inline(("observer", *controllers, "simulator")),
        "reports": inline(reported),
        "connections": inline([_connection(way) for way in scenario.connections]),
        "spots": {robot: table for robot, table in spots.items() if table},
        "objectives": inline(_objectives(scenario, options.answers)),
    }
    if scenario.unit is not None:
        data["counts"] = unit_name(scenario.unit)
    for kind, some in (("doors", _doors(scenario)), ("lifts", _lifts(scenario))):
        if some:
            data["nodes"] = inline(("observer", *controllers, "simulator", "doors"))
            data[kind] = {name: inline(one) for name, one in some.items()}
    if options.guarantee is not None:
        data["guarantee"] = number(Fraction(ceil(options.guarantee * 1000), 1000))  # a decimal, and never too little
    if idle:
        data["not_needed"] = inline(idle)
    data["statuses"] = [
        inline(
            {"of": each.of, "label": each.label, "texts": dict(each.texts), **({"inside": True} if each.inside else {})}
        )
        for each in statuses(scenario, network)
    ]
    head = f"Written by pursue-gen {generator} for the UI and the simulator of {scenario.name}."
    return yaml_text(data, [head]).encode()


def render_strategies(
    controllers: Sequence[SubStrategy], scenario: Scenario, reaction: Fraction, generator: str
) -> Optional[bytes]:
    """The text of strategies.yaml: what the controllers do, from which the page says what is next, and why; None for
    large strategies. Each strategy is one line: strategy.yaml of its controller has it for people."""
    if sum(len(sub.blocks) for sub in controllers) > LARGEST:
        return None
    found = {sub.controller: inline(strategy_data(sub, reaction)) for sub in controllers}
    head = f"What the controllers of {scenario.name} do, written by pursue-gen {generator} for the page of the UI."
    return yaml_text({"format": 1, "strategies": found}, [head]).encode()


def floor_files(floor: Floor, generator: str) -> Dict[str, bytes]:
    """The floor plan in the package of the UI: its picture, where that is on the map, and the paths of ways on it."""
    data: Dict[str, Any] = {
        "format": 1,
        "width": floor.width,
        "height": floor.height,
        "resolution": floor.resolution,
        "origin": inline([floor.x, floor.y, floor.yaw]),
    }
    if floor.paths:
        lines = {ends: [[round(x, 2), round(y, 2)] for x, y in line] for ends, line in floor.paths.items()}
        data["paths"] = inline([[*ends, line] for ends, line in lines.items()])
    head = "The floor plan under the map of the page: width and height in pixels, metres per pixel, lower left corner."
    text = yaml_text(data, [f"{head} Written by pursue-gen {generator}."]).encode()
    return {"map/floor.yaml": text, "map/floor.png": floor.picture}


def _connection(way: Connection) -> List[Any]:
    """A connection in ui.yaml: its ends, its length, and `one_way` where it goes from the first to the second only."""
    return [way.a, way.b, number(way.distance), *(["one_way"] if way.one_way else [])]


def _doors(scenario: Scenario) -> Dict[str, Dict[str, Any]]:
    """The doors in ui.yaml that are opened for somebody: within how many time units, and in which locations of whom."""
    found: Dict[str, Dict[str, Any]] = {}
    for agent in scenario.agents:
        for way, doors in doors_of(scenario, agent).items():
            for door in scenario.doors:
                if door.name in doors:
                    one = found.setdefault(door.name, {"within": number(door.opens_within), "asked_by": {}})
                    one["asked_by"].setdefault(agent.name, []).append(movement(*way))
    return found


def _lifts(scenario: Scenario) -> Dict[str, Dict[str, Any]]:
    """The lifts in ui.yaml that robots call: within how many time units each comes, and then is at another floor, its
    floors, and from which to which of them it is needed in which locations of whom."""
    found: Dict[str, Dict[str, Any]] = {}
    for agent in scenario.agents:
        for way, lift in rides_of(scenario, agent).items():
            floors = [ref.name for ref in lift.floors]
            times = {"within": number(lift.comes_within), "takes": number(lift.ride[1])}
            one = found.setdefault(lift.name, {**times, "floors": floors, "rides": {}})
            one["rides"].setdefault(agent.name, {})[movement(*way)] = list(way)
    return found


def _objectives(scenario: Scenario, answers: Mapping[str, Fraction]) -> List[Dict[str, Any]]:
    """What is to be achieved: a sentence for each statement, a short name, and the automata that watch it; none if it
    is given up. Where it is known for all of these, how late it is kept at worst."""
    watched, names = stated(scenario), promise_names(scenario)
    found: List[Dict[str, Any]] = []
    for sentence, statement in zip(objective_words(scenario), scenario.statements):
        automata = [name for name, objective in watched.items() if any(objective is each for each in statement)]
        found.append({"name": short_name([names[name] for name in automata]), "says": sentence, "of": automata})
        due = [(answers[name], watched[name]) for name in automata if name in answers]
        times = [told(worst, each) for worst, each in due]
        if times and len(times) == len(automata):
            found[-1]["worst"] = number(Fraction(max(times)))
    found += [{"says": objective_sentence(scenario, one.objective), "of": []} for one in scenario.given_up]
    return found
