"""A part of a network: some of its automata and variables, and what belongs to them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import AbstractSet, Optional, Sequence, Tuple

from pursue_gen.tga.network import Automaton, Constraint, Network


def part_of(network: Network, automata: AbstractSet[str], variables: Optional[AbstractSet[str]] = None) -> Network:
    """The network of these automata and variables alone; None: of all variables.

    Of their edges those are left out that test or set another variable; clocks go that only left-out automata name, and
    what `start` says of these; channels that are on no edge any more. All else, and every order, stays. The network
    itself where nothing is left out.
    """
    variables = dict(network.variables).keys() if variables is None else variables
    if len(automata) == len(network.automata) and len(variables) == len(network.variables):
        return network
    some = (automaton for automaton in network.automata if automaton.name in automata)
    kept = tuple(a.with_edges(edge for edge in a.edges if variables >= {*edge.variables}) for a in some)
    gone = {clock for a in network.automata if a.name not in automata for clock in a.clocks}
    gone -= {clock for a in kept for clock in a.clocks}
    clocks = tuple(clock for clock in network.clocks if clock not in gone)
    used = {channel for automaton in kept for channel in automaton.channels}
    return Network(
        clocks,
        tuple((name, value) for name, value in network.variables if name in variables),
        tuple(channel for channel in network.channels if channel in used),
        kept,
        start_of(network, clocks),
    )


def beside(network: Network, automaton: Optional[Automaton]) -> Network:
    """The network with one automaton more, behind its own; the network itself where there is none."""
    return network if automaton is None else replace(network, automata=(*network.automata, automaton))


def without_unnamed_clocks(network: Network) -> Network:
    """The network without the clocks that none of its automata names."""
    named = {clock for automaton in network.automata for clock in automaton.clocks}
    clocks = tuple(clock for clock in network.clocks if clock in named)
    return network if clocks == network.clocks else replace(network, clocks=clocks, start=start_of(network, clocks))


def start_of(network: Network, clocks: Sequence[str]) -> Tuple[Constraint, ...]:
    """What the network says of these clocks at the start; a clock of which it says nothing may have any value."""
    names = {None, *clocks}
    start = tuple(c for c in network.start if c.left in names and c.right in names)
    if network.start and not start and clocks:
        return (Constraint(None, clocks[0], Fraction(0), False),)  # without any bound all clocks would be 0
    return start
