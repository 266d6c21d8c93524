"""Networks that end where a milestone is reached: a location of an automaton, or a value of a variable.

A value is reached by the edges that give it to the variable. Where one automaton alone sets the variable, these edges
can lead to a location of their own, which then stands for the value.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Mapping, NamedTuple, Optional, Tuple

from pursue_gen.tga.network import Edge, Location, Network

REACHED = "_reached"
"""The location to which edges lead that give a variable its value."""

Milestone = Tuple[str, str]
"""An automaton and its location, or a variable and its value."""


class Ending(NamedTuple):
    """A network that ends at a milestone, the location that stands for it, and the edges that were changed for that,
    each with its automaton."""

    network: Network
    goal: Tuple[str, str]
    changed: Mapping[Tuple[str, Edge], Edge]


def ending_at(network: Network, milestone: Milestone, owner: Optional[str] = None) -> Ending:
    """The network that ends at the milestone; the network itself where that is a location.

    `owner`: the one automaton that sets the variable (see `owner_of`), where the edges that do so may be left out.
    Raises ValueError for a variable that not exactly one automaton sets.
    """
    name, value = milestone
    if name not in dict(network.variables):
        return Ending(network, milestone, {})
    owner = owner or owner_of(network, name)
    if owner is None:
        raise ValueError(f"{name} is not set by one automaton alone")
    automaton = network.automaton(owner)
    giving = [edge for edge in automaton.edges if dict(edge.assign).get(name) == int(value)]
    changed = {(owner, edge): replace(edge, target=REACHED) for edge in giving}
    edges = tuple(changed.get((owner, edge), edge) for edge in automaton.edges)
    ended = replace(automaton, locations=(*automaton.locations, Location(REACHED)), edges=edges)
    return Ending(network.with_each(lambda a: ended if a.name == owner else a), (owner, REACHED), changed)


def owner_of(network: Network, variable: str) -> Optional[str]:
    """The one automaton that sets the variable; None where none does, or several."""
    setters = network.setters.get(variable, frozenset())
    return min(setters) if len(setters) == 1 else None


def is_value(network: Network, milestone: Milestone) -> bool:
    """True for a value that edges of one automaton alone give a variable, whatever the clocks are that they leave.

    Where they lead, no invariant may forbid them: in the location that stands for the value there is none.
    """
    name, value = milestone
    owner = owner_of(network, name)
    if owner is None or any(automaton.name == name for automaton in network.automata):
        return False
    automaton = network.automaton(owner)
    giving = [edge for edge in automaton.edges if value == str(dict(edge.assign).get(name))]
    stays = ((edge, bound) for edge in giving for bound in automaton.stays.get(edge.target, ()))
    return bool(giving) and all(bound.op == "<=" and bound.clock in edge.resets for edge, bound in stays)
