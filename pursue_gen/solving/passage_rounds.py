"""Patrols by robots that must never be at one place together: rounds after which all are back where they began.

Who visits what, and in which order, is looked for as if nobody were in anybody's way (`rounds`); `routes` brings all
robots to their next visits, and home at last. What comes after that is the same again.
"""

from __future__ import annotations

from fractions import Fraction
from typing import AbstractSet, Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.floors import Floor, Move, floor_of, legs_of
from pursue_gen.solving.passage_steps import strategy_of
from pursue_gen.solving.rounds import rounds
from pursue_gen.solving.routes import routes
from pursue_gen.solving.walkers import patrol_of
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Automaton, Kind, Network, Objective
from pursue_gen.tga.part import part_of


def patrolling(
    network: Network, objective: Objective, robots: Sequence[Automaton], single: AbstractSet[str], reaction: Fraction
) -> Optional[Strategy]:
    """A strategy for the patrols of the objective, not proven yet; None where none is found."""
    known = patrols(network)
    visited = Objective(Kind.SAFETY, bad=tuple(place for place in objective.bad if place[0] in known))
    avoided = {name for name, _ in objective.bad} - known
    rest = part_of(network, {automaton.name for automaton in network.automata} - avoided)
    patrol = patrol_of(rest, visited, reaction) if visited.bad else None
    if patrol is None:
        return None
    some = rounds([walker.robot for walker in patrol.walkers], patrol.visits)
    if some is None:
        return None
    legs = legs_of(robots)
    at = {robot.name: robot.initial for robot in robots}
    stops = {
        walker.automaton.name: [patrol.visits[k].place for k in mine] for walker, mine in zip(patrol.walkers, some)
    }
    moves = _round(floor_of(robots, legs, single, reaction), at, stops)
    if not moves:
        return None
    play = [(move.robot, legs[move.robot][move.origin, move.target]) for move in moves]
    return strategy_of(rest, play, single, again=True)


def _round(floor: Floor, home: Mapping[str, str], stops: Mapping[str, Sequence[str]]) -> Optional[List[Move]]:
    """Moves by which each robot comes to its stops, one after the other, and home."""
    at, moves = dict(home), []
    left: Dict[str, Tuple[str, ...]] = {name: (*stops.get(name, ()), place) for name, place in home.items()}
    while any(left.values()):
        wanted: Dict[str, str] = {}
        for name in sorted(left, key=lambda name: -len(left[name])):
            if left[name] and left[name][0] not in wanted.values():
                wanted[name] = left[name][0]
        some = routes(floor, at, wanted)
        if some is None:
            return None
        moves += some
        at.update((move.robot, move.target) for move in some)
        for name in wanted:
            left[name] = left[name][1:] or (() if all(len(rest) < 2 for rest in left.values()) else (home[name],))
    return moves if at == dict(home) else None
