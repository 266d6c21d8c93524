"""The context of the templates: names and numbers, no decisions left to make.

A template that uses anything else is an error (jinja2's StrictUndefined). Every template has

- `scenario`, the scenario's name; `generator`, the version of the generator;
- `package`, the package's name, and `controller`, the same in a controller; `summary` of its manifest;
- `free_agents`, the names of the uncontrollable agents; `robots`, those of the robots; `facts`, the states that are
  found out on the way;
- `controllers`, the controllers' names in order: their packages and their nodes have them;
- `reported`, the agents whose ends come from the world: all of them, but for those whose ends a controller decides;
- `doors`: there are ways through doors that open by themselves, or by lifts;
- `reaches`: the mission has a goal to reach; `bringup`: the name of the package with the launch files;
- `time_unit`: the default length of a time unit in seconds;
- `machines`, for each node of the mission its name and {host, user, env_loader} of the machine that runs it;
- `docker`, `systemd`: whether the workspace has files for containers, for services;
- `plays`: the arguments of each launch test; `view`: the centre and the scale of rviz's view.

The manifests and CMakeLists.txt also have `exec_depends`, `test_depends`, `nodes` (files of `scripts/`),
`python_packages` (in `src/`) and the `folders` that are installed as they are.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Dict, Mapping, Optional, Sequence

from pursue_gen import __version__
from pursue_gen.drawing.floor import Floor
from pursue_gen.language.lifts import doors_of, rides_of
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import SubStrategy
from pursue_gen.tga.network import Objective
from pursue_gen.workspace.machines import ONE_MACHINE, Machines, nodes_of
from pursue_gen.workspace.spots import SPOT_DISTANCE, Table


@dataclass(frozen=True)
class Options:
    """How a workspace is made.

    `controllers`: distributed (one per robot), centralized (one, without a-priori ends) or general (one, with them, as
    the original has it). `reach_obj`: who gets the commands of the objective: dedicated (a controller of their own),
    all, or a robot's name. `reaction`: how late a command may come, in time units, as the strategy was made for;
    `ends` and `slack`: the rest of the rules of that game (see `solving.rules.Rules`), for new plans.
    `optimize` and `within`: what its solver was asked for (see `solving.options.SolveOptions`), to solve it again.
    `margin`: how late it may come at most, in sentences for the README; empty where that was not computed.
    `floor`: a floor plan that lies under the map of the UI's page.
    `guarantee`: in how many time units the strategy comes to the goal at worst; None where that is not known.
    `answers`: by automata, how many time units after they are due promises are kept at worst, as far as it is known.
    `machines`: which machine runs which node; `docker` and `systemd`: with files for containers, and for services.
    `spot_distance`: metres between the robots at one place where the scenario does not say where they stand; `spare`:
    robot → place → pose that it alone may take if need be; `levels`: those that have maps of their own, with their
    elevations (metres).
    """

    controllers: str = "distributed"
    reach_obj: str = "dedicated"
    reaction: Fraction = Fraction(1, 10)
    ends: str = "reported"
    slack: Mapping[str, int] = field(default_factory=dict)
    optimize: Optional[str] = None
    within: Optional[Fraction] = None
    margin: str = ""
    guarantee: Optional[Fraction] = None
    answers: Mapping[str, Fraction] = field(default_factory=dict)
    floor: Optional[Floor] = None
    machines: Machines = ONE_MACHINE
    docker: bool = False
    systemd: bool = False
    spot_distance: float = SPOT_DISTANCE
    spare: Mapping[str, Table] = field(default_factory=dict)
    levels: Mapping[str, float] = field(default_factory=dict)


def bringup_of(scenario: Scenario) -> str:
    """The name of the package with the launch files."""
    return f"{scenario.name}_bringup"


def common(
    scenario: Scenario, objective: Objective, options: Options, controllers: Sequence[SubStrategy]
) -> Dict[str, Any]:
    """The values that every template of a workspace has (but for `package` and `summary`)."""
    first_moves = [command.moves[0] for sub in controllers for _, block in sub.blocks for command in block]
    decided = {move.automaton for move in first_moves if move.edge.is_end}
    return {
        "scenario": scenario.name,
        "generator": __version__,
        "robots": [agent.name for agent in scenario.agents if agent.is_robot],
        "free_agents": [agent.name for agent in scenario.agents if not agent.controllable],
        "facts": list(scenario.facts),
        "controllers": [sub.controller for sub in controllers],
        "reported": [agent.name for agent in scenario.agents if agent.name not in decided] + [*scenario.facts],
        "doors": any(doors_of(scenario, agent) or rides_of(scenario, agent) for agent in scenario.agents),
        "reaches": objective.reaches,
        "bringup": bringup_of(scenario),
        "time_unit": float(scenario.unit or 1),
        "machines": [(node, options.machines.of(node)) for node in nodes_of([sub.controller for sub in controllers])],
        "docker": options.docker,
        "systemd": options.systemd,
    }
