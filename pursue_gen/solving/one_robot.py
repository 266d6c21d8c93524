"""Promises that only one robot can keep, and that it cannot keep together: a small game, without the other robots.

With fewer promises the controller has less to do, so if these are lost, all are. What several robots are to avoid each
of them has to avoid itself.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Callable, Iterable, Iterator, Optional, Sequence, Tuple

from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.freer import asking_only, punctual, standing, with_one_walk, without_others, without_turns
from pursue_gen.solving.lost_promises import only_promises, watched
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.pauses import acting_at_most

_WORK = 200_000_000, 100_000_000
"""The work that is spent on all games, and on one of them. Measured on lab scenarios 6, 16, 27, 28 and 33."""

_EACH = 0.3
"""The part of a budget that is spent on one of the games of all promises. Not measured."""

_STATE = 2_000
"""A discrete state of one of them costs as much as so much work. Measured on the same scenarios."""


def _as_it_is(game: Network, robot: str) -> Iterable[Network]:
    return (game,)


def lost_for_one(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions, work: Sequence[int] = _WORK,
    starts: Callable[[Network, str], Iterable[Network]] = _as_it_is,
) -> Tuple[Objective, ...]:  # fmt: skip
    """Promises that only one robot can keep and that it cannot keep together, as few as are found; () where so much
    work for all games, and for one of them, finds none.

    `starts`: the games in place of one of a robot; that one of them is lost is enough.
    """
    in_all, most = work
    limits = replace(options.limits, work=in_all, states=in_all // _STATE)
    budget = Budget(limits, options.progress, options.engine)
    for robot, alone in _alone(network, objective):
        own = (place for place in objective.bad if not _others_answer(network, place, robot))
        owned = [place for place in own if _able(alone, objective, place) == (robot,)]
        for size in dict.fromkeys((2, len(owned))) if owned else ():
            for some in combinations(owned, size):
                wanted = Objective(Kind.SAFETY, bad=some)
                games = (each for game in _games(alone, wanted, objective, robot) for each in starts(game, robot))
                if any(_is_lost(game, wanted, reaction, budget, most) for game in games):
                    return (wanted,)
                if budget.used_up:
                    return ()
    return ()


def robot_alone(network: Network, objective: Objective) -> Optional[str]:
    """The robot of several that alone can do something about all of a safety objective; None where there is none."""
    if objective.reaches or len(commanded_agents(network)) < 2:
        return None
    return next((robot for robot, _ in _with_all(network, objective)), None)


def lost_game(network: Network, objective: Objective, reaction: Fraction, budget: Budget) -> Optional[Network]:
    """A smaller game in which one robot cannot keep all of what nobody else can keep, with few moves of the
    environment; None where the budget is not enough for one, or others can."""
    for robot, alone in _with_all(network, objective):
        for game in _games(alone, objective, objective, robot):
            if _is_lost(game, objective, reaction, budget, _EACH * budget.work):
                return game
    return None


def _with_all(network: Network, objective: Objective) -> Iterator[Tuple[str, Network]]:
    """The robot that alone can do something about each place to be avoided, if there is one, as `_alone` has it."""
    for robot, alone in _alone(network, objective):
        if all(_able(alone, objective, place) == (robot,) for place in objective.bad):
            yield robot, alone


def _alone(network: Network, objective: Objective) -> Iterator[Tuple[str, Network]]:
    """Each robot, and the network in which the others bring nothing to what is to be avoided."""
    robots = commanded_agents(network)
    for robot in robots:
        yield robot, without_others(network, objective.bad, frozenset(robots) - {robot})


def _games(network: Network, wanted: Objective, objective: Objective, robot: str) -> Iterator[Network]:
    """Games of some promises of an objective in which the environment has fewer moves."""
    game = _game(network, objective, wanted)
    walks = tuple(with_one_walk(game, watched(wanted)))
    yield from (acting_at_most(walk, wanted, 1) for walk in walks)
    yield from (cone_of_influence(punctual(walk, robot), wanted) for walk in (standing(game), *walks))
    yield acting_at_most(game, wanted, 1)


def _is_lost(game: Network, wanted: Objective, reaction: Fraction, budget: Budget, most: float) -> bool:
    """True if it is known to be lost. Few moves of the environment are enough as a rule: searches take turns."""
    try:
        return not budget.verdict(game, wanted, reaction, min(1.0, most / max(1.0, budget.work)), first=0).won
    except LimitHit:
        return False


def _others_answer(network: Network, place: Place, robot: str) -> bool:
    """True if the automaton that watches a promise hears another robot, too: then that one can do something about it.
    To find out by `_able` takes long."""
    robots = {*commanded_agents(network)} - {robot}
    heard = {edge.received for edge in network.automaton(place[0]).edges}
    return any(sender in robots for channel in heard if channel for sender, _ in network.senders.get(channel, ()))


def _able(network: Network, objective: Objective, place: Place) -> Tuple[str, ...]:
    """The robots that can do something about what is to be avoided there."""
    wanted = Objective(Kind.SAFETY, bad=(place,))
    return tuple(commanded_agents(_game(network, objective, wanted)))


def _game(network: Network, objective: Objective, wanted: Objective) -> Network:
    """The game of these promises, in which agents ask for nothing else, and rules about other things are left out."""
    game = only_promises(network, objective, wanted)
    watching = watched(wanted)
    return cone_of_influence(without_turns(asking_only(game, watching), watching), wanted)
