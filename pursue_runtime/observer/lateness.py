"""Who is late, and what happened too early or too late: sentences for people. `position` has the clocks, in time units.
"""

from __future__ import annotations

from typing import Tuple

from pursue_runtime.model import Automaton, Move, Position
from pursue_runtime.sentences import MARKED, marked
from pursue_runtime.vocabulary import deed, place
from pursue_runtime.zones import INFINITY, due, last_moment


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
