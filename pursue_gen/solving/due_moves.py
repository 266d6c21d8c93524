"""Games in which robots set off only for what is due: a promise that waits for its answer, or a place of a patrol whose
next visit is near.

While nothing is due, no robot sets off. On a patrol it sets off when the time left until the visit is that of the way
there plus a reserve, and only on ways that bring it nearer to a place that is due. Only moves of the controller are
taken away, so a strategy for such a game is one for the game itself, in whose names `in_names_of` puts it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import AbstractSet, Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.language.network_names import AT_RISK, IDLE
from pursue_gen.language.numbers import Number
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.solving.distances import times_to
from pursue_gen.synthesis.strategy import Block, Command, Move, Strategy, Zone
from pursue_gen.tga.endurance import is_battery
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Network, Objective, Test


@dataclass(frozen=True)
class Duty:
    """A deadline: its automaton, clock and length. `visits`: of a patrol, the places at which each robot ends it."""

    name: str
    clock: str
    deadline: Number
    visits: Mapping[str, Tuple[str, ...]]


@dataclass(frozen=True)
class DueMoves:
    """The game, and for its edges those that they were before."""

    network: Network
    before: Mapping[Edge, Edge]

    def in_names_of(self, strategy: Strategy) -> Strategy:
        """A strategy for this game as one for the game that it was made of."""
        return replace(strategy, blocks=tuple(map(self._block, strategy.blocks)))

    def _block(self, block: Block) -> Block:
        values = tuple(pair for pair in block.state.values if role_of(pair[0]) is not Role.DUE)
        commands: Dict[Tuple[Move, ...], Tuple[Zone, ...]] = {}
        for command in block.commands:
            moves = tuple(replace(move, edge=self.before.get(move.edge, move.edge)) for move in command.moves)
            commands[moves] = (*commands.get(moves, ()), *command.zones)
        together = tuple(Command(zones, moves) for moves, zones in commands.items())
        return replace(block, state=replace(block.state, values=values), commands=together)


def patrols(network: Network) -> FrozenSet[str]:
    """The automata whose deadlines robots begin, and nobody else: each place of a patrol has one."""
    return frozenset(automaton.name for automaton in network.automata if _is_patrol(network, automaton))


def _is_patrol(network: Network, automaton: Automaton) -> bool:
    if is_battery(automaton):
        return False
    begins = [edge for edge in automaton.edges if edge.source != AT_RISK and edge.target == AT_RISK]
    led = (sent for edge in begins for _, sent in network.senders.get(edge.channel, ()))
    return bool(begins) and all(sent.controllable and sent.enters is Role.WAY for sent in led)


def duties(network: Network, objective: Objective, known: AbstractSet[str]) -> Tuple[Duty, ...]:
    """What has a deadline of the objective's promises; `known`: those of patrols (see `patrols`)."""
    names = dict.fromkeys(name for name, _ in objective.bad)
    watching = (a for a in network.automata if a.name in names and AT_RISK in a.stays)
    return tuple(_duty(network, each, each.name in known) for each in watching)


def _duty(network: Network, automaton: Automaton, patrol: bool) -> Duty:
    visits: Dict[str, Tuple[str, ...]] = {}
    for edge in automaton.edges:
        if patrol and edge.source == AT_RISK and edge.target == IDLE:
            for name, sent in network.senders.get(edge.channel, ()):
                visits[name] = tuple(dict.fromkeys((*visits.get(name, ()), sent.target)))
    bound = automaton.stays[AT_RISK][0]
    return Duty(automaton.name, bound.clock, bound.bound, visits)


def only_due(
    network: Network, objective: Objective, visited: AbstractSet[str], reserve: Fraction
) -> Optional[DueMoves]:
    """The game in which robots set off only for what is due: for a visit when all that is left of its period is the way
    there and this part of the period. None where none of the objective's promises is for a patrol; `visited`: those
    that are."""
    known = duties(network, objective, visited)
    called = [duty for duty in known if not duty.visits]
    if len(called) == len(known):
        return None
    before: Dict[Edge, Edge] = {}
    automata: List[Automaton] = []
    for automaton in network.automata:
        telling = any(automaton.name == duty.name for duty in called)
        nearer = {duty.name: times_to(duty.visits.get(automaton.name, ()), automaton) for duty in known}
        edges: List[Edge] = []
        for edge in automaton.edges:
            some = [_telling(automaton.name, edge)] if telling else [edge]
            if _sets_off(edge):
                some = list(_for_duties(edge, automaton, known, nearer, reserve))
            before.update((new, edge) for new in some if new != edge)
            edges += some
        automata.append(replace(automaton, edges=tuple(dict.fromkeys(edges))))
    at_risk = {automaton.name for automaton in automata if automaton.initial == AT_RISK}
    variables = tuple((Role.DUE(duty.name), int(duty.name in at_risk)) for duty in called)
    return DueMoves(replace(network, automata=tuple(automata), variables=(*network.variables, *variables)), before)


def _telling(name: str, edge: Edge) -> Edge:
    """A promise's edge that also sets the variable that is 1 while the promise's deadline is running."""
    if AT_RISK not in (edge.source, edge.target) or edge.source == edge.target:
        return edge
    return edge.plus(assign=((Role.DUE(name), int(edge.target == AT_RISK)),))


def _sets_off(edge: Edge) -> bool:
    return edge.controllable and edge.enters is Role.WAY and edge.leaves is not Role.WAY


def _for_duties(
    edge: Edge,
    automaton: Automaton,
    known: Sequence[Duty],
    nearer: Mapping[str, Mapping[str, Number]],
    reserve: Fraction,
) -> Iterator[Edge]:
    """The edge with which a robot sets off, once for each patrol to whose place it leads, and for each promise."""
    ends = [other.target for other in automaton.edges if other.source == edge.target]
    called = tuple(Test(Role.DUE(duty.name), 1) for duty in known if not duty.visits)
    if called:
        yield edge.plus(called)
    for duty in known:
        far = nearer[duty.name]
        if edge.source in far and all(end in far and far[end] < far[edge.source] for end in ends):
            latest = Fraction(duty.deadline) * (1 - reserve) - Fraction(far[edge.source])
            yield edge.plus(bounds=(ClockBound(duty.clock, ">=", max(0, math.floor(latest))),))
