"""Patrols of many places beside other promises: robots that nobody else needs go round them, each on a tour (see
`tours`), and the others keep the rest, in a game of their own.

Whether they are in each other's way is for the checker to say, which takes both apart as shares (see `proof.shares`).
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import AbstractSet, FrozenSet, Optional

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.solving.due_moves import duties, patrols
from pursue_gen.solving.found import Found
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.shares import won_in_shares
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.solving.tours import PATROL, proven_tours, tours_of
from pursue_gen.solving.tours_again import Now, going_on
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.part import part_of

_WORK = 20_000_000
"""The work that may be spent on the other promises: about a second. Measured on two robots that patrol twelve rooms
while a third one answers calls."""


def won_beside_tours(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Optional[Found]:
    """A proven strategy in which robots that no other promise needs go round the places of all patrols; None where
    there are no such robots, or few places, or none is found with little work."""
    start = options.limits.now()
    known = patrols(network) if not objective.reaches and not network.start else frozenset()
    visited = tuple(place for place in objective.bad if place[0] in known)
    rest = Objective(Kind.SAFETY, bad=tuple(place for place in objective.bad if place[0] not in known))
    if len(visited) < PATROL or not rest.bad:
        return None
    busy = _needed(network, rest) - _only_ones(network, replace(rest, bad=visited), known)
    tours = tours_of(network, replace(rest, bad=visited), reaction, busy)
    if tours is None:
        return None
    game = _without(network, {tour.robot for tour in tours.tours}.union(name for name, _ in visited))
    others = won_in_shares(game, rest, reaction, replace(options, limits=replace(options.limits, work=_WORK)))
    if others is None:
        return None
    return proven_tours(network, objective, _together(tours, others.strategy), reaction, options, start)


def goes_on(
    network: Network, objective: Objective, reaction: Fraction, own: Strategy, now: Now, excused: FrozenSet[str],
    patrolled: AbstractSet[str], options: SolveOptions,
) -> Optional[Strategy]:
    """A proven strategy by which robots go on with the tours of `own` in the middle of a play (see `tours_again`), and
    the others keep what else is promised; None where none is found with little work. `patrolled`: the automata of
    patrols."""
    visited = tuple(place for place in objective.bad if place[0] in patrolled)
    rest = tuple(place for place in objective.bad if place[0] not in patrolled)
    if objective.reaches:
        return None
    on_tour = {tour.robot for tour in own.tours}
    away = excused.union(name for name in commanded_agents(network) if rest and name not in on_tour)
    strategy = going_on(network, replace(objective, bad=visited), reaction, own, now, away)
    if strategy is None:
        return None
    if rest:
        followed = {tour.name for tour in own.tours}.union(watcher.name for watcher in own.watchers)
        game = _without(network, on_tour | followed.union(name for name, _ in visited))
        limited = replace(options, limits=replace(options.limits, work=_WORK))
        others = won_in_shares(game, replace(objective, bad=rest), reaction, limited)
        if others is None:
            return None
        strategy = _together(strategy, others.strategy)
    with suppress(NotProven, LimitHit):
        return prove(network, objective, strategy, reaction, options=options)
    return None


def _only_ones(network: Network, visited: Objective, known: AbstractSet[str]) -> AbstractSet[str]:
    """The robots that alone can make one of these visits."""
    able = (duty.visits for duty in duties(network, visited, known))
    return {name for some in able if len(some) == 1 for name in some}


def _needed(network: Network, rest: Objective) -> AbstractSet[str]:
    """The robots that can do something which the automata of these promises hear."""
    names = {name for name, _ in rest.bad}
    heard = {channel for automaton in network.automata if automaton.name in names for channel in automaton.channels}
    return {name for name in commanded_agents(network) if heard & network.automaton(name).channels}


def _without(network: Network, gone: AbstractSet[str]) -> Network:
    """The network without these automata, and what their edges alone set."""
    kept = [automaton for automaton in network.automata if automaton.name not in gone]
    setters = network.setters
    variables = {name for name, _ in network.variables if not setters[name] or setters[name] - gone}
    return part_of(network, {automaton.name for automaton in kept}, variables)


def _together(tours: Strategy, others: Strategy) -> Strategy:
    """The strategy with the shares of both."""
    return replace(
        tours,
        blocks=(*tours.blocks, *others.blocks),
        shares=(*tours.shares, *others.shares),
        watchers=(*tours.watchers, *others.watchers),
        left_out_clocks=others.left_out_clocks,
    )
