"""Patrols by robots that must never be at one place together: rounds after which all are back where they began.

Who visits what, and in which order, is looked for as if nobody were in anybody's way (`rounds`); `routes` brings all
robots to their next visits, and home at last. What comes after that is the same again.
"""

from __future__ import annotations

from fractions import Fraction
from typing import AbstractSet, Dict, Iterator, List, Mapping, Optional, Sequence

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
    left = {name: [stop for stop in stops.get(name, ()) if stop != place] for name, place in home.items()}
    while any(left.values()):
        wanted: Dict[str, str] = {}
        for name in sorted(left, key=lambda name: -len(left[name])):
            if left[name] and left[name][0] not in wanted.values():
                wanted[name] = left[name][0]
        # All at once; where no moves are found, one after the other: who has been there may make way.
        some = next(filter(None, (routes(floor, at, each) for each in (wanted, *_alone(wanted)))), None)
        if some is None:
            return None
        moves += some
        for move in some:
            at[move.robot] = move.target
            if left[move.robot] and left[move.robot][0] == move.target:
                left[move.robot].pop(0)
    back = routes(floor, at, home) or _turned(floor, moves)
    return None if back is None else [*moves, *back]


def _alone(wanted: Mapping[str, str]) -> Iterator[Mapping[str, str]]:
    if len(wanted) > 1:
        yield from ({name: place} for name, place in wanted.items())


def _turned(floor: Floor, moves: Sequence[Move]) -> Optional[List[Move]]:
    """The same moves back; None where a way leads in one direction only."""
    back = [Move(move.robot, move.target, move.origin) for move in reversed(moves)]
    return back if all(move.target in floor.ways[move.robot][move.origin] for move in back) else None
