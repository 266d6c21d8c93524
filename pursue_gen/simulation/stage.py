"""What all simulated missions of a scenario have in common: the generated code and its data, and the game they play."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.moves import Arena
from pursue_gen.simulation.code import load, sources
from pursue_gen.simulation.commands import Commands, commands_of
from pursue_gen.solving.solution import Solution
from pursue_gen.workspace import Options, generate

_MODULES = ("observer_core", "controller_core", "observer_journal", "simulator_core", "ui_core", "ui_players")


@dataclass(frozen=True)
class Stage:
    """The workspace's modules and their data as its nodes have them, and the game and strategy they were made from.

    `strategies`: each controller's, by the controller's name; `people`: what human allies are told. `reaction` is in
    time units. `arena`: the joint moves of the network, as the checker reads it; `commands`: those of the strategy
    as the solver made it. `reports`: the agents whose ends are reported by the world, not commanded. `request`: what
    planning again is told of the game (config/game.yaml); None where the workspace has no such file.
    """

    scenario: Scenario
    solution: Solution
    pursue_library: Any
    pursue_strategy: Any
    observer_core: Any
    controller_core: Any
    simulator_core: Any
    ui_core: Any
    ui_players: Any
    observer_journal: Any
    model: Any
    cover: Any
    strategies: Mapping[str, Any]
    people: Optional[Any]
    reports: Tuple[str, ...]
    request: Optional[Mapping[str, Any]]
    reaction: float
    arena: Arena
    commands: Commands

    @property
    def robots(self) -> Tuple[str, ...]:
        """The robots, in order of declaration."""
        return tuple(agent.name for agent in self.scenario.agents if agent.is_robot)

    @property
    def opponents(self) -> Tuple[str, ...]:
        """The agents that nobody controls."""
        return tuple(agent.name for agent in self.scenario.agents if not agent.controllable)

    def controller_of(self, robot: str) -> Optional[str]:
        """The controller that commands the robot."""
        return next((name for name, strategy in self.strategies.items() if robot in strategy.agents), None)


def stage_of(scenario: Scenario, won: Solution, options: Options) -> Stage:
    """The stage of a scenario: its workspace is generated in memory. Raises what `workspace.generate` raises."""
    return stage_from(generate(scenario, won.network, won.objective, won.strategy, options), scenario, won)


def stage_from(files: Mapping[str, bytes], scenario: Scenario, won: Solution) -> Stage:
    """The stage of these files of a workspace. Raises PursueError (exit status 6) where a Python module is missing."""
    try:
        texts = sources(files)
        modules = load(texts, _MODULES)
        data = _data(files)
    except ImportError as problem:
        hint = "install it for the Python that runs pursue-gen: pip install pyyaml transitions"
        raise PursueError([error("SIM001", f"the generated code cannot run here: {problem}", hint=hint)], 6) from None
    strategies = modules["pursue_strategy"]
    people = data.get("UI/people.yaml")
    return Stage(
        scenario=scenario,
        solution=won,
        pursue_library=modules["pursue_library"],
        pursue_strategy=strategies,
        observer_core=modules["observer_core"],
        controller_core=modules["controller_core"],
        simulator_core=modules["simulator_core"],
        ui_core=modules["ui_core"],
        ui_players=modules["ui_players"],
        observer_journal=modules["observer_journal"],
        model=modules["pursue_model"].Model(data["observer/model.yaml"]),
        cover=strategies.read_cover(data["observer/cover.yaml"]),
        strategies={name: strategies.Strategy(data[f"{name}/strategy.yaml"]) for name in _controllers(data)},
        people=None if people is None else strategies.Strategy(people),
        reports=tuple(data["UI/ui.yaml"]["reports"]),
        request=data.get("observer/game.yaml"),
        reaction=float(won.reaction),
        arena=Arena(won.network, 1),
        commands=commands_of(won.strategy),
    )


def _controllers(data: Mapping[str, Any]) -> List[str]:
    return [path.split("/")[0] for path in data if path.endswith("/strategy.yaml")]


def _data(files: Mapping[str, bytes]) -> Dict[str, Any]:
    """package/file → content, of the data files that the nodes read."""
    import yaml

    wanted = ("strategy.yaml", "model.yaml", "cover.yaml", "people.yaml", "game.yaml", "ui.yaml")
    found = {}
    for path, content in sorted(files.items()):
        parts = path.split("/")
        if len(parts) == 4 and parts[2] == "config" and parts[3] in wanted:
            found[f"{parts[1]}/{parts[3]}"] = yaml.load(content, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    return found
