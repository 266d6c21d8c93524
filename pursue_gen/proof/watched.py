"""Proof that a watcher can stand for its objective: whenever the objective's automaton waits with a deadline, so does
the watcher's, with a clock that is at least as large and a deadline that is no longer. All plays are looked at,
whatever the clocks are."""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Iterator

from pursue_gen.language.network_names import AT_RISK, LOSE
from pursue_gen.proof.moves import Arena, State
from pursue_gen.tga.hidden import with_hidden
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Network
from pursue_gen.tga.part import part_of
from pursue_gen.tga.scale import common_denominator
from pursue_gen.tga.watchers import Watcher
from pursue_gen.zones.dbm import raw

_MOST = 100_000
"""So many discrete states are looked at. Measured on 40 lab scenarios."""


def why_it_may_miss(network: Network, watcher: Watcher, automata: AbstractSet[str], variables: AbstractSet[str]) -> str:
    """Why the objective may be broken though the watcher is kept; "" if it cannot.

    `automata` and `variables` are seen, the others may be anywhere (see `tga.hidden`). Requires that the watcher is one
    of the network's automata, and seen.
    """
    assert watcher.name in automata
    watched, narrower = network.automaton(watcher.objective), network.automaton(watcher.name)
    fault = _why_it_is_none(watched, narrower)
    if fault:
        return fault
    freed = network.with_each(lambda a: a.with_edges(_with_any(a, variables)) if a is watched else a)
    game = with_hidden(freed, part_of(freed, automata | {watcher.objective}, variables))
    arena = Arena(game, common_denominator(game.times))
    places = {automaton.name: k for k, automaton in enumerate(game.automata)}
    theirs, own = places[watcher.objective], places[watcher.name]
    since, own_since = (arena.clock[_deadline(automaton).clock] for automaton in (watched, narrower))

    def is_missed(state: State) -> bool:
        return state[0][theirs] == AT_RISK != state[0][own]

    found, waiting = {arena.initial}, [arena.initial]
    if is_missed(arena.initial):
        return "the objective is at risk before it is"
    longer = arena.start.m[since * arena.start.dim + own_since] > raw(0, strict=False)
    if arena.initial[0][theirs] == AT_RISK and longer:  # in the middle of a play
        return "the objective may have been at risk for longer"
    while waiting:
        state = waiting.pop()
        for move in arena.situation(state).moves:
            target = move.target
            if move.enabled is None or LOSE in (target[0][theirs], target[0][own]):
                continue  # how long each is at risk is compared by the clocks
            if is_missed(target):
                return "the objective may be at risk when it is not"
            stays = state[0][theirs] == AT_RISK and own_since not in move.resets
            if target[0][theirs] == AT_RISK and since not in move.resets and not stays:
                return "the objective may be at risk for longer"
            if target not in found:
                found.add(target)
                waiting.append(target)
        if len(found) > _MOST:
            return "there are too many states to look at"
    return ""


def _why_it_is_none(watched: Automaton, own: Automaton) -> str:
    """Why these are no automata of an objective with a deadline and its watcher; "" if they are."""
    for automaton in (watched, own):
        bounds = automaton.stays.get(AT_RISK, ())
        if len(bounds) != 1 or bounds[0].op != "<=":
            return f"{automaton.name} has no deadline"
        for edge in automaton.edges:
            if edge.target == LOSE and (edge.source != AT_RISK or edge.sync is not None or not edge.controllable):
                return f"{automaton.name} is lost otherwise than by its deadline"
            if edge.assign or edge.guard.clocks or edge.sent is not None:
                return f"{automaton.name} does more than watch"
    if _deadline(watched).bound < _deadline(own).bound:
        return f"{own.name} has a longer deadline"
    return ""


def _deadline(automaton: Automaton) -> ClockBound:
    (bound,) = automaton.stays[AT_RISK]
    return bound


def _with_any(watched: Automaton, variables: AbstractSet[str]) -> Iterator[Edge]:
    """The automaton's edges, where other variables may have any value: what tests them may happen, or not."""
    for edge in watched.edges:
        tests = tuple(c for c in edge.guard.integers if all(test.variable in variables for test in c))
        yield replace(edge, guard=Guard(edge.guard.clocks, tests))
        if len(tests) < len(edge.guard.integers):
            yield Edge(edge.source, edge.source, sync=edge.sync)
