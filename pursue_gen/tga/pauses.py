"""Pauses of the environment: clocks that only say how soon one of its agents may act again.

An agent that nobody controls rests one time unit between two of its events. Its clock then matters to its own next
event alone. An environment without that rest can do all that it could before, at the same times and others, so what is
won against it is won. Where such agents may call at any time the rests are what makes a game large: they cut the
clocks' values into slices, one for each call that may come before.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Collection, List, Tuple

from pursue_gen.language.symbols import Symbol
from pursue_gen.tga.network import Automaton, Edge, Location, Network, Objective
from pursue_gen.tga.part import start_of


def pauses(network: Network) -> Tuple[str, ...]:
    """The clocks of the network that are pauses of the environment alone.

    Such a clock bounds no stay, and only from below when its agent may send, or act alone, where no invariant obliges
    it to; no edge of the controller names it.
    """
    tested = {bound.clock for a in network.automata for edge in a.edges for bound in edge.guard.clocks}
    others = {clock for automaton in network.automata for clock in _compared_otherwise(automaton)}
    return tuple(clock for clock in network.clocks if clock in tested and clock not in others)


def with_calls_that_are_heard(network: Network) -> Network:
    """The network in which a call that does nothing but begin a pause is no move; itself where there is none.

    Such a move makes commands stale, but not those of a strategy that leaves the clock of the pause out.
    """
    clocks = frozenset(pauses(network))
    return network.with_each(lambda a: a.with_each(lambda edge: _heard(edge, clocks)) if clocks & a.clocks else a)


def _heard(edge: Edge, clocks: AbstractSet[str]) -> Tuple[Edge, ...]:
    """The edge, if it may be a move; a loop that resets pauses alone is one where somebody hears it."""
    if edge.source != edge.target or edge.controllable or edge.assign or not clocks >= {*edge.resets}:
        return (edge,)
    if edge.sync is None:
        return ()
    return (replace(edge, sync=replace(edge.sync, heard=True)) if edge.sync.sends else edge,)


def without_clocks(network: Network, clocks: Collection[str]) -> Network:
    """The network without these clocks: no edge tests or resets them. No invariant may name them."""
    gone = frozenset(clocks)
    if not gone:
        return network
    kept = tuple(clock for clock in network.clocks if clock not in gone)
    rest = network.with_each(lambda a: a.with_edges(_without(edge, gone) for edge in a.edges))
    return replace(rest, clocks=kept, start=start_of(network, kept))


def _compared_otherwise(automaton: Automaton) -> AbstractSet[str]:
    """The clocks that the automaton names in another way than a pause is named."""
    found = {bound.clock for bounds in automaton.stays.values() for bound in bounds}
    for edge in automaton.edges:
        tests = edge.guard.clocks
        if edge.controllable:
            found.update(edge.resets)
        if edge.controllable or edge.received is not None or edge.source in automaton.stays:
            found.update(bound.clock for bound in tests)
        found.update(bound.clock for bound in tests if bound.op not in (">", ">="))
    return found


def _without(edge: Edge, clocks: AbstractSet[str]) -> Edge:
    if clocks.isdisjoint(edge.resets) and all(bound.clock not in clocks for bound in edge.guard.clocks):
        return edge
    tests = tuple(bound for bound in edge.guard.clocks if bound.clock not in clocks)
    resets = tuple(clock for clock in edge.resets if clock not in clocks)
    return replace(edge, guard=replace(edge.guard, clocks=tests), resets=resets)


def acting_at_most(network: Network, objective: Objective, times: int) -> Network:
    """The network in which each agent that rests (see `pauses`) does so little: at most so many of the moves for which
    it has to rest, of which those that nobody hears are none. The environment has fewer moves, none of which it is ever
    obliged to make.

    Locations get copies, so automata that the objective names stay as they are.
    """
    clocks = frozenset(pauses(network))
    named = {name for name, _ in (*objective.goal, *objective.bad)}
    heard = with_calls_that_are_heard(network)
    return heard.with_each(lambda a: a if a.name in named else _counting(a, clocks, times))


def _counting(automaton: Automaton, clocks: AbstractSet[str], times: int) -> Automaton:
    """The automaton with a copy of each location for each number of such moves that were made."""
    if all(bound.clock not in clocks for edge in automaton.edges for bound in edge.guard.clocks):
        return automaton

    def after(name: str, count: int) -> str:
        return Symbol.of(name).called(f"{name} {count}") if count else name

    locations: List[Location] = []
    edges: List[Edge] = []
    for count in range(times + 1):
        locations += [replace(location, name=after(location.name, count)) for location in automaton.locations]
        for edge in automaton.edges:
            more = count + any(bound.clock in clocks for bound in edge.guard.clocks)
            if more <= times:
                edges.append(replace(edge, source=after(edge.source, count), target=after(edge.target, more)))
    return replace(automaton, locations=tuple(locations), edges=tuple(edges))
