"""Sentences for people: why the plan in force has no decision, who is late, and what happened too early or too late.

Clocks are in time units.
"""

from __future__ import annotations

from typing import AbstractSet, Tuple

from pursue_runtime.model import Automaton, Model, Move, Position
from pursue_runtime.observer.planning import stays
from pursue_runtime.sentences import MARKED, listed, marked
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Cover
from pursue_runtime.vocabulary import deed, place
from pursue_runtime.zones import INFINITY, due, last_moment

SHOWN = 4
"""So many agents are named, or one more where that names them all."""


def uncovered_reason(model: Model, cover: Cover, position: Position, tolerance: float, late: AbstractSet[str]) -> str:
    """Return why the plan has no decision at this position, for people: who is late, else where the agents are that
    matter to it. The sentence is the same while only time passes. `late`: the agents that are; `tolerance` as in
    `covers`."""
    if late:
        who = [f"{marked(name)} is late {_place(model, name, position)}" for name in sorted(late)]
        return f"{listed(who)}, and the strategy does not say what to do then"
    where = _where(model, cover, position)
    if not cover.zones(SystemState(0, 0.0, *position)):
        return f"the strategy does not say what to do now that {where}"
    if stays(cover, position, tolerance) > -INFINITY:
        return f"the moment at which the strategy goes on has passed; {where}"
    return f"this happened at another time than the strategy expects; {where}"


def uncovered_position(position: Position) -> str:
    """Return the whole position, for the log: locations, variables and clocks by their names."""
    parts = {**position.locations, **position.values}
    clocks = {clock: f"{value:.3f}" for clock, value in position.clocks.items()}
    return " ".join(f"{name}={value}" for name, value in {**parts, **clocks}.items())


def _where(model: Model, cover: Cover, position: Position) -> str:
    """Where the agents are of which the plan speaks."""
    acting = model.acting
    named = [automaton for automaton in acting if automaton.name in cover.names] or acting
    shown = named[:SHOWN] if len(named) > SHOWN + 1 else named
    parts = [f"{marked(each.name)} is {_place(model, each.name, position)}" for each in shown]
    more = len(named) - len(shown)
    return listed([*parts, f"{more} others are elsewhere"] if more else parts)


def _place(model: Model, agent: str, position: Position) -> str:
    return place(MARKED, model.automaton(agent), position.locations[agent])


def late_words(automaton: Automaton, position: Position) -> str:
    """Return that an agent is late which should have left its location by now."""
    here = place(MARKED, automaton, position.locations[automaton.name])
    return f"{marked(automaton.name)} is late: it is still {here}"


def untimely_words(automaton: Automaton, moves: Tuple[Move, ...], position: Position) -> str:
    """Return what the agent that begins these moves does, and how much too early or too late that is."""
    zones = [tuple(bound for move in moves for bound in move.edge.when)]
    early, late = due(zones, position.clocks, 0.0), -last_moment(zones, position.clocks)
    what = f"{marked(automaton.name)} {deed(MARKED, automaton, moves[0].edge).does}"
    if early:
        return f"{what} {early:.1f} time units too early; the mission goes on from there"
    if 0.0 < late < INFINITY:
        return f"{what} {late:.1f} time units too late; the mission goes on from there"
    return f"{what} at another time than it may; the mission goes on from there"
