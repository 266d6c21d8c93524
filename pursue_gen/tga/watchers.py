"""Automata that watch for some robots alone what an objective's automaton watches for all.

Who has to be at a place in time, whoever else comes by, follows an automaton of its own: the one that the objective
would have if its robots alone could keep it. That is at risk whenever the objective's is, and not shorter: who keeps it
keeps the objective (see `proof.watched`). What others do for the objective changes nothing in it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import AbstractSet, Iterable, Iterator, Optional, Set, Tuple

from pursue_gen.language.network_names import AT_RISK, IDLE, LOSE
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.tga.ends import is_agent, is_fact
from pursue_gen.tga.network import Automaton, Clause, Edge, Guard, Location, Network


@dataclass(frozen=True)
class Watcher:
    """What watches for the robots of a team, in the network's order, whether they keep an objective."""

    objective: str
    team: Tuple[str, ...]

    @property
    def name(self) -> str:
        """Its automaton's name."""
        return Symbol(f"{self.objective}_for_{'_'.join(self.team)}", Role.WATCHER, (self.objective, *self.team))

    @property
    def clock(self) -> str:
        """Its automaton's clock."""
        return f"C{self.name}"


def with_watchers(network: Network, watchers: Iterable[Watcher]) -> Network:
    """The network with the automata of these watchers, each behind that of its objective; one that is there already, or
    that nobody can be (see `watched_by`), is left out."""
    for watcher in watchers:
        automaton = watched_by(network, watcher)
        if automaton is not None:
            place = next(k for k, each in enumerate(network.automata, 1) if each.name == watcher.objective)
            automata = (*network.automata[:place], automaton, *network.automata[place:])
            network = replace(network, automata=automata, clocks=(*network.clocks, watcher.clock))
    return network


def without_watchers(network: Network, watchers: Iterable[Watcher]) -> Network:
    """The network without the automata of these watchers, and their clocks."""
    names = {watcher.name: watcher.clock for watcher in watchers}
    clocks = tuple(clock for clock in network.clocks if clock not in names.values())
    return replace(network, automata=tuple(a for a in network.automata if a.name not in names), clocks=clocks)


def watched_by(network: Network, watcher: Watcher) -> Optional[Automaton]:
    """The automaton of a watcher. None where its names are taken, where the objective has no deadline or sets a
    variable, where it would watch the same, or in the middle of a play."""
    watched = next((each for each in network.automata if each.name == watcher.objective), None)
    if network.start or watched is None or {watcher.name, watcher.clock} & network.names or not _has_deadline(watched):
        return None
    (clock,) = watched.clocks
    channels, variables = _only_of_others(network, watcher.team)
    edges = tuple(_narrowed(watched.edges, channels, variables))
    if edges == watched.edges:
        return None
    return Automaton(
        watcher.name,
        tuple(_renamed(location, clock, watcher.clock) for location in watched.locations),
        IDLE if watched.initial == IDLE and _is_kept_at_start(network, watched, watcher.team) else AT_RISK,
        tuple(replace(edge, resets=(watcher.clock,) if edge.resets else ()) for edge in edges),
    )


def _has_deadline(automaton: Automaton) -> bool:
    """True for an automaton with a deadline, its only clock, that sends, tests no clock, and sets nothing."""
    if {location.name for location in automaton.locations} != {IDLE, AT_RISK, LOSE} or len(automaton.clocks) != 1:
        return False
    return not any(e.assign or e.guard.clocks or e.sent is not None for e in automaton.edges)


def _only_of_others(network: Network, team: Iterable[str]) -> Tuple[Set[str], Set[str]]:
    """The channels on which only other robots send, and the variables that only they set."""
    sent: Tuple[Set[str], Set[str]] = set(), set()
    assigned: Tuple[Set[str], Set[str]] = set(), set()
    for automaton in network.automata:
        other = is_agent(automaton) and automaton.name not in team and not is_fact(automaton)
        other = other and any(edge.controllable for edge in automaton.edges)
        assigned[other].update(automaton.assigned)
        sent[other].update(edge.sent for edge in automaton.edges if edge.sent is not None)
    return sent[True] - sent[False], assigned[True] - assigned[False]


def _narrowed(edges: Iterable[Edge], channels: AbstractSet[str], variables: AbstractSet[str]) -> Iterator[Edge]:
    """The edges as if nobody sent on these channels: towards the risk whatever these variables are, away from it only
    because of others."""
    for edge in edges:
        if edge.channel in channels:
            continue
        clauses = edge.guard.integers
        tests = [(clause, tuple(test for test in clause if test.variable not in variables)) for clause in clauses]
        if edge.target == AT_RISK:
            kept: Tuple[Clause, ...] = tuple(clause for clause, own in tests if own == clause)
        else:
            kept = tuple(own for _, own in tests)
        if all(kept):
            yield replace(edge, guard=Guard(edge.guard.clocks, kept))


def _renamed(location: Location, clock: str, new: str) -> Location:
    bounds = (replace(bound, clock=new) if bound.clock == clock else bound for bound in location.invariant)
    return replace(location, invariant=tuple(bounds))


def _is_kept_at_start(network: Network, watched: Automaton, team: Iterable[str]) -> bool:
    """True if one of the team keeps the objective at the start; or none of them ever breaks it by going away."""
    feared = {edge.sync.channel for edge in watched.edges if edge.target == AT_RISK and edge.sync is not None}
    robots = [automaton for automaton in network.automata if automaton.name in team]
    leaving = [(a.initial, edge) for a in robots for edge in a.edges if edge.channel in feared]
    return not leaving or any(edge.source == initial for initial, edge in leaving)
