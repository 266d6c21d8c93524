"""The distribution of a strategy's commands to controllers.

A command belongs to the automaton that makes its first move. A priori ends (a timer that decides when a robot has
arrived) are for the `general` controller only: elsewhere the robot reports them (thesis, section 4.2.2). The commands
of the objectives' automata (`reachObj`, `obj`) belong to no robot: the policies for them are the thesis's three.
Robots and allies that are never commanded may be ones that the strategy does without.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Sequence, Set, Tuple

from pursue_gen.diagnostics import PursueError, error, listed
from pursue_gen.language.clauses import Domains
from pursue_gen.language.conditions import Holds, atoms
from pursue_gen.language.scenario import Agent, Scenario
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.outcomes import Invalid, NotProven
from pursue_gen.synthesis.strategy import Command, DiscreteState, Strategy
from pursue_gen.tga.network import Network

DISTRIBUTED, CENTRALIZED, GENERAL = "distributed", "centralized", "general"
"""One controller per robot; one for all; one for all that also decides the ends, as the original's does."""

DEDICATED, ALL = "dedicated", "all"
"""Objectives' commands in a controller of their own; in every robot's. (Or a robot's name: in that robot's.)"""

CONTROLLER, CONTROLLER_OBJ, UI = "controller", "controllerObj", "UI"


@dataclass(frozen=True)
class SubStrategy:
    """What one controller does: in each discrete state, in the strategy's order, its commands and no others.

    `agents` are the automata that it commands; a state in which it has nothing to do is absent. The controller `UI` is
    no program: its commands are instructions to people. `objectives` are those of `agents` that are no agents: the
    automata of objectives. `left_out_clocks`: as the strategy has them. `in_parts`: it has stages or shares.
    """

    controller: str
    agents: Tuple[str, ...]
    blocks: Tuple[Tuple[DiscreteState, Tuple[Command, ...]], ...]
    objectives: Tuple[str, ...] = ()
    left_out_clocks: Tuple[str, ...] = ()
    in_parts: bool = False

    @property
    def commands(self) -> int:
        """How many commands there are, over all states."""
        return sum(len(commands) for _, commands in self.blocks)


def partition(
    strategy: Strategy,
    network: Network,
    agents: Sequence[Agent],
    controllers: str = DISTRIBUTED,
    reach_obj: str = DEDICATED,
) -> Tuple[SubStrategy, ...]:
    """The sub-strategies: the robots' in order of declaration (or the one `controller`), `controllerObj`, `UI`.

    A robot without commands still gets its (empty) controller. `controllerObj` is there under the policy `dedicated`
    when the network has a reachObj or an objective has commands; `UI` when there are human allies. Ends are left out
    but for `general`; every other command is in exactly one sub-strategy, with `all` those of the objectives in every
    robot's.

    Raises PursueError for an unknown shape or policy (exit status 2), for a counter-strategy, and for a command of an
    uncontrollable automaton.
    """
    robots = tuple(agent.name for agent in agents if agent.is_robot)
    humans = tuple(agent.name for agent in agents if agent.controllable and agent.human)
    _check_options(controllers, reach_obj, robots)
    if strategy.counter:
        message = "a counter-strategy cannot be given to controllers: its moves are the opponent's"
        raise NotProven([error("PAR003", message, hint="use a plan whose property is satisfied")])
    names = tuple(automaton.name for automaton in network.automata)
    reach = tuple(name for name in names if role_of(name) is Role.REACH)
    safety = tuple(name for name in names if role_of(name) is Role.SAFETY)
    _check_senders(strategy, network, (*robots, *humans, *reach, *safety))
    senders = {command.moves[0].automaton for block in strategy.blocks for command in block.commands}
    objectives = tuple(n for n in names if n in reach or (n in safety and n in senders))
    owners = _owners(robots, objectives, controllers, reach_obj)
    if humans:
        owners[UI] = humans
    return tuple(
        SubStrategy(
            name,
            commanded,
            _select(strategy, commanded, controllers == GENERAL),
            tuple(automaton for automaton in commanded if automaton in objectives),
            strategy.left_out_clocks,
            strategy.in_parts,
        )
        for name, commanded in owners.items()
    )


def _owners(
    robots: Tuple[str, ...], objectives: Tuple[str, ...], controllers: str, reach_obj: str
) -> Dict[str, Tuple[str, ...]]:
    """From each controller (but UI) to the automata that it commands."""
    if controllers != DISTRIBUTED:
        return {CONTROLLER: (*robots, *objectives)}
    owners = {
        f"controller_{robot}": (robot, *objectives) if reach_obj in (ALL, robot) else (robot,) for robot in robots
    }
    if reach_obj == DEDICATED and objectives:
        owners[CONTROLLER_OBJ] = objectives
    return owners


def _select(
    strategy: Strategy, automata: Tuple[str, ...], with_ends: bool
) -> Tuple[Tuple[DiscreteState, Tuple[Command, ...]], ...]:
    """The blocks with the commands of these automata only, without the blocks where they have none."""
    blocks: List[Tuple[DiscreteState, Tuple[Command, ...]]] = []
    for block in strategy.blocks:
        commands = tuple(
            command
            for command in block.commands
            if command.moves[0].automaton in automata and (with_ends or not command.moves[0].edge.is_end)
        )
        if commands:
            blocks.append((block.state, commands))
    return tuple(blocks)


def _check_options(controllers: str, reach_obj: str, robots: Tuple[str, ...]) -> None:
    """Raises PursueError for a shape or a policy that does not exist here."""
    shapes = (DISTRIBUTED, CENTRALIZED, GENERAL)
    if controllers not in shapes:
        message = f"there are no '{controllers}' controllers; expected {', '.join(shapes)}"
        raise PursueError([error("PAR001", message, hint=f"choose {DISTRIBUTED} for one controller per robot")])
    if reach_obj not in (DEDICATED, ALL, *robots):
        message = f"'{reach_obj}' cannot have reachObj's commands; expected {', '.join((DEDICATED, ALL, *robots))}"
        raise PursueError([error("PAR002", message, hint=f"choose {DEDICATED} for a controller of their own")])
    if reach_obj == ALL and not robots:
        message = "no robot can have reachObj's commands: the scenario has no controllable robot"
        raise PursueError([error("PAR002", message, hint=f"choose {DEDICATED} for a controller of their own")])


def _check_senders(strategy: Strategy, network: Network, controlled: Tuple[str, ...]) -> None:
    """Raises PursueError where a command's automaton is neither an agent that is controlled nor an objective's."""
    known = {automaton.name for automaton in network.automata}
    for block in strategy.blocks:
        for command in block.commands:
            name = command.moves[0].automaton
            if name in controlled:
                continue
            edge = command.moves[0].edge
            what = "an agent or rule that nobody controls" if name in known else "no automaton of the network"
            message = f"the strategy commands {name}.{edge.source}->{name}.{edge.target}, but '{name}' is {what}"
            hint = f"use the plan with its own scenario, or make the agent '{name}' controllable"
            raise Invalid([error("PAR004", message, hint=hint)])


def unneeded(scenario: Scenario, strategy: Strategy) -> Tuple[Agent, ...]:
    """The controllable agents that the strategy never moves, and whose mere presence helps nobody.

    Who stands at a place of a patrol, is named in a condition, or may be needed by somebody else's event, is needed.
    So are all where people may order something.
    """
    if scenario.orders:
        return ()
    moves = [move for block in strategy.blocks for command in block.commands for move in command.moves]
    moved = {move.automaton for move in moves}
    begun = {move.edge.channel for move in moves}
    begun |= {ref.name for agent in scenario.agents if not agent.controllable for ref in agent.can_do}
    present = _present(scenario)
    return tuple(
        agent
        for agent in scenario.agents
        if agent.controllable
        and agent.name not in moved | present
        and not any(ref.name in begun for ref in agent.reacts_to)
    )


def unneeded_words(agents: Sequence[Agent]) -> str:
    """That these agents are not needed, as a sentence; "" where there are none."""
    if not agents:
        return ""
    verb, them = ("is", "it") if len(agents) == 1 else ("are", "them")
    names = listed(agent.shown for agent in agents)
    return f"{names} {verb} not needed in this mission: the strategy never commands {them}."


def _present(scenario: Scenario) -> Set[str]:
    """The agents that objectives and conditions look at where they stand."""
    domains = Domains(scenario)
    found: Set[str] = set()
    for condition, _ in scenario.conditions():
        for atom in atoms(condition):
            if not isinstance(atom, Holds):
                found.update(domains.among(atom.who))
    for patrol in scenario.patrols:
        places = patrol.order or (patrol.place.name,)
        found.update(agent.name for agent in scenario.on_patrol(patrol) if agent.location.name in places)
    return found
