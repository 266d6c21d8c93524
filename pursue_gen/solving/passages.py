"""Robots that must never be at one place together, and have to be at several places to reach the goal: orders of
passage.

It works in rounds: a relaxed plan (`synthesis.relaxed`) that ignores who is in whose way says what has to be done next,
and where; `routes` brings the robots there. Without a goal, `passage_rounds` does so for patrols. The result is one
play. `passage_steps` makes a strategy that does the same
in each play, and lets robots that do not meet move at the same time. Where it is proven it wins; where none is found,
nothing is known.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from math import floor
from typing import AbstractSet, Dict, FrozenSet, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.language.symbols import UNDER_WAY, Role
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.checker import verify
from pursue_gen.proof.passage_times import deadlines
from pursue_gen.proof.passages import Fault, played
from pursue_gen.proof.relaxed_reachability import is_controllers
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.floors import floor_of, legs_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.passage_rounds import patrolling
from pursue_gen.solving.passage_steps import Play, strategy_of
from pursue_gen.solving.routes import routes
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import State
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.relaxed import RelaxedPlanner
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga.network import Automaton, Clause, Edge, Kind, Network, Objective
from pursue_gen.tga.part import part_of

_ROUNDS = 200
"""So many rounds at most. Measured on 30 robots that change places."""


class Crowd(NamedTuple):
    """Robots, and the places at which two of them must never be."""

    robots: Tuple[Automaton, ...]
    single: FrozenSet[str]


def won_by_passages(
    network: Network, objective: Objective, crowd: Crowd, reaction: Fraction, options: SolveOptions
) -> Optional[Strategy]:
    """A proven strategy with orders of passage; None where none is found with little work. Raises LimitHit at a
    limit."""
    if objective.reaches:
        rest = without_bad(network, objective)
        commands = _Rounds(rest, objective, crowd, reaction).commands()
        strategy = None if commands is None else strategy_of(rest, commands, crowd.single)
    else:
        strategy = patrolling(network, objective, *crowd, reaction)
    if strategy is None:
        return None
    whole = with_automata_of(network, strategy)  # proof and times look at the same course of it
    report = verify(whole, objective, strategy, reaction, limits=options.limits, progress=options.progress)
    return strategy if report.ok else None


def period_by_passages(
    network: Network, objective: Objective, patrols_of: AbstractSet[str], reaction: Fraction, options: SolveOptions
) -> Optional[int]:
    """A period, in whole time units, that patrols by these automata keep with orders of passage; None where none are
    found."""
    crowd = crowd_of(network, objective)
    strategy = None if crowd is None else patrolling(network, objective, *crowd, reaction)
    if strategy is None:
        return None
    with suppress(LimitHit, Fault):
        whole = with_automata_of(network, strategy)
        took = deadlines(played(whole, objective, strategy, LimitMonitor(options.limits)), strategy, reaction)
        return floor(max(time for name, time in took.items() if name in patrols_of)) + 1
    return None


def without_bad(network: Network, objective: Objective) -> Network:
    """The network without the automata of what is to be avoided alone."""
    names = {automaton.name for automaton in network.automata}.difference(name for name, _ in objective.bad)
    return part_of(network, names.union(name for name, _ in objective.goal))


def crowd_of(network: Network, objective: Objective) -> Optional[Crowd]:
    """The robots, if two of them must never be at one place, on the way to a goal or on patrols; else None."""
    if not (objective.avoids and (objective.reaches or patrols(network))) or network.start:
        return None
    robots = tuple(_robots(network))
    single = _single(network, objective, robots) if len(robots) > 1 else frozenset()
    return Crowd(robots, single) if single else None


def _robots(network: Network) -> List[Automaton]:
    """The agents that are commanded to go somewhere."""
    commanded = (network.automaton(name) for name in commanded_agents(network))
    return [automaton for automaton in commanded if any(place.role is Role.WAY for place in automaton.locations)]


def _single(network: Network, objective: Objective, robots: Sequence[Automaton]) -> FrozenSet[str]:
    """The places at which two of the robots must never be."""
    spots = dict(_spots(robots))
    bad = set(objective.bad)
    found: Set[str] = set()
    for automaton in network.automata:
        for edge in automaton.edges:
            if (automaton.name, edge.target) in bad and edge.sync is None and not edge.controllable:
                clauses = edge.guard.integers
                if len(clauses) == 2:
                    one, other = (_places(clause, spots) for clause in clauses)
                    found |= one & other
    return frozenset(found)


def _spots(robots: Sequence[Automaton]) -> Iterator[Tuple[str, Dict[int, str]]]:
    """For each variable that a robot sets where it arrives at a place, the places by its values."""
    for automaton in robots:
        for edge in automaton.edges:
            if edge.leaves is Role.WAY and edge.assign:
                yield edge.assign[0][0], {
                    e.assign[0][1]: e.target for e in automaton.edges if e.leaves is Role.WAY and e.assign
                }
                break


def _places(clause: Clause, spots: Mapping[str, Mapping[int, str]]) -> Set[str]:
    """The places at which the tests of a clause hold; nothing where one is of no robot."""
    if not {test.variable for test in clause} <= spots.keys():
        return set()
    return {spots[t.variable][t.value] for t in clause if t.value in spots[t.variable]}


class _Rounds:
    def __init__(self, network: Network, objective: Objective, crowd: Crowd, reaction: Fraction) -> None:
        robots, single = crowd
        self._robots = [robot.name for robot in robots]
        self._game = compile_game(network, Objective(Kind.REACH, objective.goal))
        self._planner = RelaxedPlanner(self._game)
        self._goal = objective.goal
        self._taken = network.taken_over
        self._play = Play(network)
        self._legs = legs_of(robots)
        self._floor = floor_of(robots, self._legs, single, reaction)
        self._ends: Dict[str, List[Edge]] = {}
        for robot in robots:
            for edge in robot.edges:
                if edge.leaves in UNDER_WAY:
                    self._ends.setdefault(edge.source, []).append(edge)
        self._commands: List[Tuple[str, Edge]] = []

    def commands(self) -> Optional[List[Tuple[str, Edge]]]:
        """The commands of a play that reaches the goal, in order; None where none is found."""
        for _ in range(_ROUNDS):
            if all(self._play.now[name] == place for name, place in self._goal):
                return self._commands
            deeds = self._deeds()
            # First those who are there already, who may make way then; all others at once; where no moves are found,
            # first what begins to count, then one robot after the other.
            ready = {name: edge for name, edge in deeds.items() if self._play.now[name] == edge.source}
            others = {name: edge for name, edge in deeds.items() if name not in self._robots}
            alone = ({name: edge} for name, edge in deeds.items() if len(deeds) > 1 and name not in others)
            if not any(self._do(each) for each in (ready, deeds, others, *alone) if each):
                return None
        return None

    def _do(self, deeds: Mapping[str, Edge]) -> bool:
        """Brings the robots to where they have something to do, and has it done; False where nothing was done."""
        done = len(self._commands)
        # Objectives begin to count before anybody does something for them.
        ours = sorted(deeds.items(), key=lambda deed: deed[0] in self._robots)
        if not self._go_to(deeds):
            return False
        self._commands += [(name, edge) for name, edge in ours if self._play.take(name, edge)]
        return len(self._commands) > done

    def _deeds(self) -> Dict[str, Edge]:
        """What to do next, at most one thing for each agent, and no two at a place that holds one."""
        game, now = self._game, self._play.now
        state = State(
            tuple(a.locations.index(str(now[a.name])) for a in game.automata),
            tuple(int(now[name]) for name in game.variables),
        )
        found: Dict[str, Edge] = {}
        places: Set[str] = set()
        numbers = sorted(self._planner.plan(state))
        plan = [(game.automata[game.edges[k].automaton].name, game.origins[k]) for k in numbers]
        for name, edge in plan:
            is_way = edge.enters is Role.WAY or edge.leaves in UNDER_WAY
            if name in found or is_way or not is_controllers(edge, self._taken):
                continue
            if not edge.guard.holds(now) or not self._is_heard(edge, plan):
                continue
            is_busy = name not in self._robots or edge.source in places
            if is_busy and now[name] != edge.source:
                continue
            found[name] = edge
            places.update({edge.source} & self._floor.single)
        return found

    def _is_heard(self, edge: Edge, plan: Sequence[Tuple[str, Edge]]) -> bool:
        """False for an event if its receivers in the plan, or those of its end, are not there yet."""
        channels = {each.channel for each in (edge, *self._ends.get(edge.target, ()))} - {None}
        receiving = [(name, other) for name, other in plan if other.received in channels]
        return not receiving or any(self._play.now[name] == e.source for name, e in receiving)

    def _go_to(self, deeds: Mapping[str, Edge]) -> bool:
        """Brings the robots to where they have something to do; False where that is not found."""
        at = {name: str(self._play.now[name]) for name in self._robots}
        wanted = {name: edge.source for name, edge in deeds.items() if name in at}
        if all(at[name] == place for name, place in wanted.items()):
            return True
        moves = routes(self._floor, at, wanted)
        for move in moves or ():
            edge = self._legs[move.robot][move.origin, move.target]
            if not self._play.take(move.robot, edge):
                return False
            self._commands.append((move.robot, edge))
        return moves is not None
