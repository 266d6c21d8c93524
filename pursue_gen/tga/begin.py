"""A network that may begin in any of several discrete states, with any values of its clocks.

One more automaton takes it there: at first no time can pass, and the environment makes one of its moves, which leads
all automata to one of the states. Where an invariant there does not hold of the clocks, that move is not possible; what
no state allows is not possible at first either.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Dict, List, Sequence, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.tga.network import Automaton, ClockBound, Constraint, Edge, Location, Network, Sync

BEGIN = "_begin"
"""The automaton that begins, its clock, and the location in which all the others are before."""

BEGUN = "_begun"

State = Tuple[Tuple[str, ...], Tuple[int, ...]]
"""The location of every automaton and the value of every variable, in the network's order."""


def beginning_in(network: Network, states: Sequence[State]) -> Network:
    """The network that begins in one of the states. Its automata keep their order; the new one is the last."""
    channels = tuple(f"{BEGIN}{number}" for number in range(len(states)))
    assigned = [tuple(zip((name for name, _ in network.variables), values)) for _, values in states]
    bound = (ClockBound(BEGIN, "<=", 0),)
    edges = tuple(
        Edge(BEGIN, BEGUN, sync=Sync(channel, True), assign=values, controllable=False)
        for channel, values in zip(channels, assigned)
    )
    first = Automaton(BEGIN, (Location(BEGIN, bound), Location(BEGUN)), BEGIN, edges)
    automata: List[Automaton] = []
    for k, automaton in enumerate(network.automata):
        led = tuple(
            Edge(BEGIN, locations[k], sync=Sync(channel, False), controllable=False)
            for channel, (locations, _) in zip(channels, states)
        )
        places = (*automaton.locations, Location(BEGIN))
        home = automaton.home or automaton.initial
        automata.append(replace(automaton, locations=places, initial=BEGIN, edges=(*automaton.edges, *led), home=home))
    start = (Constraint(BEGIN, None, Fraction(0), False), *_latest(network, states))
    return Network(
        (*network.clocks, BEGIN), network.variables, (*network.channels, *channels), (*automata, first), start
    )


def _latest(network: Network, states: Sequence[State]) -> List[Constraint]:
    """How much the clocks may be that an invariant bounds in every state."""
    found: Dict[str, List[Tuple[Number, bool]]] = {clock: [] for clock in network.clocks}
    for locations, _ in states:
        bounds: Dict[str, List[Tuple[Number, bool]]] = {}
        for automaton, place in zip(network.automata, locations):
            for bound in automaton.stays.get(place, ()):
                bounds.setdefault(bound.clock, []).append((bound.bound, bound.op == "<="))
        for clock, some in bounds.items():
            found[clock].append(min(some))
    return [
        Constraint(clock, None, Fraction(max(some)[0]), not max(some)[1])
        for clock, some in found.items()
        if some and len(some) == len(states)
    ]
