"""What all simulated missions of a scenario have in common: the data of its nodes, and the game they play."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Mapping, Optional, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.moves import Arena
from pursue_gen.solving.solution import Solution
from pursue_gen.tga.scale import common_denominator
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.orders import of_strategy
from pursue_gen.workspace import Options, generate
from pursue_runtime.data import parse_data
from pursue_runtime.model import Model
from pursue_runtime.strategy import Cover, Strategy, read_cover


@dataclass(frozen=True)
class Stage:
    """A workspace's data as its nodes have them, and the game and strategy they were made from.

    `strategies`: each controller's, by the controller's name; `people`: the instructions for human allies.
    `reaction` is in time units. `arena`: the joint moves of the network, as the checker reads it; `game`: what missions
    are checked against. `reports`: the agents whose ends are reported by the world, not commanded. `request`: what the
    planner gets of the game (config/game.yaml); None where the workspace has no such file.
    """

    scenario: Scenario
    solution: Solution
    model: Model
    cover: Cover
    strategies: Mapping[str, Strategy]
    people: Optional[Strategy]
    reports: Tuple[str, ...]
    request: Optional[Mapping[str, Any]]
    reaction: float
    arena: Arena
    game: Game

    @property
    def robots(self) -> Tuple[str, ...]:
        """The robots, in order of declaration."""
        return tuple(agent.name for agent in self.scenario.agents if agent.is_robot)

    @property
    def opponents(self) -> Tuple[str, ...]:
        """The uncontrollable agents."""
        return tuple(agent.name for agent in self.scenario.agents if not agent.controllable)

    def controller_of(self, robot: str) -> Optional[str]:
        """The controller that commands the robot."""
        return next((name for name, strategy in self.strategies.items() if robot in strategy.agents), None)


def stage_of(scenario: Scenario, won: Solution, options: Options) -> Stage:
    """The stage of a scenario: its workspace is generated in memory. Raises what `workspace.generate` raises."""
    return stage_from(generate(scenario, won.network, won.objective, won.strategy, options), scenario, won)


def stage_from(files: Mapping[str, bytes], scenario: Scenario, won: Solution) -> Stage:
    """The stage of these files of a workspace."""
    data = _data(files)
    strategies = {path.split("/")[0]: Strategy(data[path]) for path in data if path.endswith("/strategy.yaml")}
    people = Strategy(data["UI/people.yaml"]) if "UI/people.yaml" in data else None
    return Stage(
        scenario=scenario,
        solution=won,
        model=Model(data["observer/model.yaml"]),
        cover=read_cover(data["observer/cover.yaml"]),
        strategies=strategies,
        people=people,
        reports=tuple(data["UI/ui.yaml"]["reports"]),
        request=data.get("observer/game.yaml"),
        reaction=float(won.reaction),
        arena=Arena(won.network, common_denominator(won.network.times), idle_moves=True),
        game=_game(scenario, won, strategies, people),
    )


def _game(scenario: Scenario, won: Solution, strategies: Mapping[str, Strategy], people: Optional[Strategy]) -> Game:
    """What missions are checked against: the strategy as the solver made it."""
    nodes = {**strategies, **({"UI": people} if people else {})}
    orders = of_strategy(won.strategy, ((name, node.agents) for name, node in nodes.items()), won.reaction)
    return Game(scenario, won.network, won.objective, orders, given=True)


def _data(files: Mapping[str, bytes]) -> Dict[str, Any]:
    """package/file → content, of the data files that the nodes read."""
    wanted = ("strategy.yaml", "model.yaml", "cover.yaml", "people.yaml", "game.yaml", "ui.yaml")
    found = {}
    for path, content in sorted(files.items()):
        parts = path.split("/")
        if len(parts) == 4 and parts[2] == "config" and parts[3] in wanted:
            found[f"{parts[1]}/{parts[3]}"] = parse_data(content, path)
    return found
