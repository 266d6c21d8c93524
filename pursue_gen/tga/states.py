"""States: one automaton that keeps every state's variable."""

from __future__ import annotations

from typing import Dict, Optional, Sequence

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import State
from pursue_gen.tga.network import Automaton, Edge, Location, Sync

_BASE = "base"


def states_automaton(states: Sequence[State]) -> Optional[Automaton]:
    """The automaton of all states; None where no event sets one.

    An event that sets several states does so by one edge: an automaton takes one edge in a move.
    """
    assigned: Dict[str, Dict[str, int]] = {}
    for state in states:
        for value, events in ((1, state.true_if), (0, state.false_if)):
            for event in events:
                assigned.setdefault(event.name, {})[names.state_value(state.name)] = value
    edges = tuple(
        Edge(_BASE, _BASE, sync=Sync(names.event(event), sends=False), assign=tuple(values.items()))
        for event, values in assigned.items()
    )
    return Automaton(names.STATES, (Location(_BASE),), _BASE, edges) if edges else None
