"""The game in which the ends of movements and actions are reported by the robots, not chosen by the plan."""

from __future__ import annotations

from dataclasses import replace
from typing import Dict, Mapping, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.language.numbers import exact
from pursue_gen.language.symbols import UNDER_WAY, Role
from pursue_gen.outcomes import Invalid
from pursue_gen.tga.network import Automaton, ClockBound, Location, Network, with_controllability


def ends_reported(network: Network, slack: Mapping[str, int]) -> Network:
    """The network with every end of a movement or an action in the environment's hands.

    `slack` is how many time units later than the invariant of its `going_…` and `doing_…` locations an agent may be;
    an agent that it does not name is never late. What several do together ends when the last of them is ready: it may
    be late by the largest of their slacks. Raises PursueError for a slack that is negative or names no automaton of the
    network.
    """
    known = [automaton.name for automaton in network.automata]
    hint = f"one of {', '.join(known)}"
    problems = [
        error("TGA020", f"a slack is given for {name}, which is not here", hint=hint)
        for name in slack
        if name not in known
    ]
    hint = "a slack is a natural number of time units"
    problems += [
        error("TGA021", f"the slack of {name} is {late}", hint=hint) for name, late in slack.items() if late < 0
    ]
    if problems:
        raise Invalid(problems)
    sharing = _sharing(network)

    def late(automaton: str, location: str) -> int:
        return max(slack.get(name, 0) for name in (automaton, *sharing.get(location, ())))

    automata = tuple(
        _reported(a, {location.name: late(a.name, location.name) for location in a.locations}) for a in network.automata
    )
    return replace(network, automata=automata)


def _sharing(network: Network) -> Mapping[str, Tuple[str, ...]]:
    """For each location in which agents take part in what another one does there, these agents."""
    sharing: Dict[str, Tuple[str, ...]] = {}
    for automaton in network.automata:
        for edge in automaton.edges:
            if edge.is_end and edge.received is not None:
                sharing[edge.source] = (*sharing.get(edge.source, ()), automaton.name)
    return sharing


def is_agent(automaton: Automaton) -> bool:
    """True for the automaton of an agent: it sends, or it can be on its way or at work."""
    return any(edge.sent is not None for edge in automaton.edges) or any(
        location.role in UNDER_WAY for location in automaton.locations
    )


def is_fact(automaton: Automaton) -> bool:
    """True for the automaton of a state that is not known at first: nobody commands it, though it listens to robots."""
    return any(location.role is Role.FINDING for location in automaton.locations)


def is_nobodys(automaton: Automaton) -> bool:
    """True for the automaton of an agent whom nobody controls."""
    return is_agent(automaton) and not any(edge.controllable for edge in automaton.edges)


def has_to_come(automaton: Automaton) -> bool:
    """True for an agent that another automaton can send on its way, so that it may not stay where it is (see
    `awaited`)."""
    sent = (edge for edge in automaton.edges if edge.received is not None and not edge.controllable)
    return any(edge.enters is Role.WAY for edge in sent)


def _reported(automaton: Automaton, slack: Mapping[str, int]) -> Automaton:
    """`slack`: by which each of its locations may be left later."""
    if not is_agent(automaton):
        return automaton
    edges = (with_controllability(edge, edge.controllable and not edge.is_end) for edge in automaton.edges)
    return automaton.with_edges(edges).with_locations(lambda location: _late(location, slack[location.name]))


def _late(location: Location, slack: int) -> Location:
    if location.role not in UNDER_WAY:
        return location
    bounds = tuple(ClockBound(bound.clock, bound.op, exact(bound.bound + slack)) for bound in location.invariant)
    return replace(location, invariant=bounds)
