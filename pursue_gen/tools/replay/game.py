"""The game that a recorded mission is checked against: the scenario, its rules, and the strategy that was played; from
the recording itself, or from what a person names on the command line."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Mapping, Optional, Tuple, Union

from pursue_gen.diagnostics import PursueError, error, usage_error
from pursue_gen.files import LARGEST_TEXT, read_text
from pursue_gen.language import load, parse
from pursue_gen.language.network_names import LOSE
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.partition import partition
from pursue_gen.solving.inputs import game_of as ideal_game
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.optional import promised
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Edge, Network, Objective
from pursue_gen.tools.replay.journal import Journal
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.orders import Orders, of_strategy
from pursue_gen.tools.replay.record import MissionRecord
from pursue_runtime.bounded import BadText, read_yaml
from pursue_runtime.numbers import exact, whole

DISTRIBUTED, DEDICATED = "distributed", "dedicated"
_OTHER_PLAN = (
    "the plan that was played is not the one that is found now (it was given, or made by another solver or version); "
    "name the workspace: --workspace DIR"
)
NAME_IT = "name the scenario: pursue-gen replay FILE SCENARIO"


@dataclass(frozen=True)
class Game:
    """What is checked against. `orders` None: the strategy is not known, and `why_not` says why.

    `given`: the strategy is known to be the workspace's own.
    """

    scenario: Scenario
    network: Network
    objective: Objective
    orders: Optional[Orders]
    why_not: str = ""
    given: bool = False

    @property
    def doubt(self) -> str:
        """What else could be the reason where a mission does not fit the strategy; "" where nothing could."""
        return "" if self.given else " (if the workspace has another strategy than a new solution: --workspace)"

    def is_deadline(self, agent: str, edge: Edge) -> bool:
        """True for a step by which an objective itself, or a watcher, becomes broken, or a battery full or empty."""
        role = role_of(agent)
        passes = role is Role.SAFETY and not edge.controllable
        broken = role is Role.WATCHER and edge.target == LOSE  # of a strategy that another one has replaced
        return edge.sync is None and (passes or broken or (agent, edge.target) in self.objective.bad)

    @cached_property
    def moves(self) -> Moves:
        """The joint moves of the network."""
        return Moves(self.network)


@dataclass(frozen=True)
class Source:
    """Where a game comes from: a scenario's text, its rules, who commands, and a plan's text where there is one.

    `asked`: what the solver was asked for; `digest`: the SHA-256 of the plan that was played, empty where unknown.
    `given_up`: the numbers of the optional objectives that were not promised; None: whatever cannot be.
    """

    name: str
    text: str
    file: str
    rules: Rules
    controllers: str = DISTRIBUTED
    reach_obj: str = DEDICATED
    plan: Optional[Tuple[str, str]] = None
    asked: SolveOptions = DEFAULT
    digest: str = ""
    given_up: Optional[Tuple[int, ...]] = None


def from_data(data: Mapping[str, Any], file: str, plan: Optional[Tuple[str, str]] = None) -> Source:
    """The source that game.yaml describes. Raises PursueError (exit status 2)."""
    try:
        rules = data["rules"]
        slack = {str(agent): whole(str(units)) for agent, units in dict(rules.get("slack") or {}).items()}
        played_by = Rules(str(rules["ends"]), exact(rules["reaction"]), slack)
        name, text = str(data["name"]), str(data["scenario"])
        shape = str(data.get("controllers", DISTRIBUTED)), str(data.get("reach_obj", DEDICATED))
        made = dict(data.get("plan") or {})
        within = None if made.get("within") is None else exact(made["within"])
        given_up = tuple(int(number) for number in data.get("given_up", ()))
        optimize = None if made.get("optimize") is None else str(made["optimize"])
    except (KeyError, TypeError, ValueError, AttributeError) as problem:
        message = f"{file} does not describe a game: {problem!r}"
        raise PursueError([error("RPL005", message, hint=NAME_IT)]) from None
    asked = SolveOptions(optimize=optimize, within=within)
    return Source(name, text, file, played_by, *shape, plan, asked, str(made.get("sha256", "")), given_up)


def from_workspace(folder: Path) -> Source:
    """The source that a generated workspace holds. Raises PursueError (exit status 2)."""
    games = [path for path in sorted(folder.glob("src/*/config/game.yaml")) if path.is_file()]
    if not games:
        hint = "name a workspace that pursue-gen ws wrote, or the scenario: pursue-gen replay FILE SCENARIO"
        raise PursueError([error("RPL006", f"{folder} holds no game (src/observer/config/game.yaml)", hint=hint)])
    text = read_text(games[0], "a workspace's game.yaml")
    path = folder / "UPPAAL_plan.txt"
    plan = (read_text(path, "a plan", LARGEST_TEXT), str(path)) if path.is_file() else None
    return from_data(read_game(text, str(games[0])), str(games[0]), plan)


def read_game(text: str, file: str) -> Mapping[str, Any]:
    """The data in a game.yaml. Raises PursueError (exit status 2)."""
    try:
        data = read_yaml(text)
    except BadText as problem:
        raise PursueError([error("RPL005", f"{file} does not describe a game: {problem}", hint=NAME_IT)]) from None
    if not isinstance(data, dict):
        raise PursueError([error("RPL005", f"{file} does not describe a game", hint=NAME_IT)])
    return data


def _promised(scenario: Scenario, source: Source, asked: SolveOptions) -> Scenario:
    """The scenario with what can be promised; with nothing optional where that is not known."""
    try:
        return promised(scenario, asked, lambda some, how: solved(*ideal_game(some), source.rules, how)).scenario
    except PursueError:
        return scenario.giving_up(scenario.optional)


def game_of(source: Source, limits: Limits = NO_LIMITS, progress: Optional[Listener] = None) -> Game:
    """The game; its strategy is the plan of the source, or solved again where there is none: if it is the same plan.

    Raises PursueError for a scenario or a plan with errors; that no strategy is found is no error.
    """
    scenario = parse(source.text, source.file, source.name)
    asked = replace(source.asked, limits=limits, progress=progress)
    if source.given_up is not None:
        scenario = scenario.giving_up(source.given_up)
    elif scenario.optional:
        scenario = _promised(scenario, source, asked)
    ideal, objective = translate(scenario), scenario_objective(scenario)
    network = played(ideal, source.rules)
    strategy: Strategy
    if source.plan is not None:
        strategy = read_plan(source.plan[0], network, source.plan[1])
        network = with_automata_of(network, strategy)
    else:
        try:
            won = solved(ideal, objective, source.rules, asked)
        except PursueError as problem:
            return Game(scenario, network, objective, None, problem.diagnostics[0].message)
        plan = write_plan(won.strategy, won.network, objective)
        if source.digest not in ("", hashlib.sha256(plan.encode()).hexdigest()):
            return Game(scenario, network, objective, None, _OTHER_PLAN)
        network, strategy = won.network, won.strategy
    subs = partition(strategy, network, scenario.agents, source.controllers, source.reach_obj)
    orders = of_strategy(strategy, ((sub.controller, sub.agents) for sub in subs), source.rules.reaction)
    return Game(scenario, network, objective, orders, given=source.plan is not None or bool(source.digest))


def source_of(
    found: Union[MissionRecord, Journal],
    file: Path,
    scenario: Optional[Path],
    workspace: Optional[Path],
    request: SolveRequest,
) -> Source:
    """The source for what was `found` in the recording `file`: a workspace, a scenario, or else the recording.

    Raises PursueError (exit status 2) where there is none, and for a scenario with errors.
    """
    if workspace is not None:
        if scenario is not None or not request.is_default:
            hint = "leave out SCENARIO, --ends, --reaction and --slack"
            raise usage_error("a workspace says which game it plays", hint)
        return from_workspace(workspace)
    if scenario is not None:
        read = settled(load(str(scenario)), request)
        return Source(scenario.stem, read.text, str(scenario), request.rules(translate(read)))
    if not isinstance(found, Journal) and found.game is not None:
        return from_data(found.game, str(file))
    raise usage_error(f"{file} does not hold its scenario", f"pursue-gen replay {file} SCENARIO.pur")
