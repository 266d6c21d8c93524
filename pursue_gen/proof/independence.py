"""What a strategy does not name: the checker's own test, from the network's tables, that it cannot matter.

A strategy may speak of a part of the network: its blocks then name some of the automata and variables. It is proven for
that part alone (`named_part`), and what `why_it_matters` finds is held against it. Where that finds nothing, each play
of the network shows the part as one of its own plays: what is left out changes nothing in the part, takes no command
from the controller, and cannot stop time. A move that changes nothing in the part is no move there (see `moves`).
Edges that can never be taken while only the strategy commands change nothing at all: they are dead (see
`relaxed_reachability`).

A strategy may also leave out clocks of that part. It is then proven for the part without them, and without the bounds
on them: they may only have kept the environment from acting.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, List, Optional, Sequence, Set, Tuple

from pursue_gen.proof.moves import Arena, Bound
from pursue_gen.proof.relaxed_reachability import Places, commanded, live
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.hidden import is_loosened, why_not_hidden
from pursue_gen.tga.network import Automaton, Edge, Network, Objective
from pursue_gen.tga.part import part_of, start_of
from pursue_gen.tga.pauses import without_clocks
from pursue_gen.tga.scale import common_denominator
from pursue_gen.zones.dbm import Dbm, raw


def named_part(network: Network, strategy: Strategy) -> Network:
    """The part of the network that the strategy speaks of; the network itself where it names everything, or has stages,
    shares or passages.

    The first block says what is named: one that names something else covers nothing. The clocks that it leaves out are
    not in the part.
    """
    if strategy.shares or strategy.passages:
        return network
    names = _names(network, strategy)
    part = network if names is None else with_clocks_of(part_of(network, *names), network, strategy)
    return without_clocks(part, strategy.left_out_clocks)


def proven_part(network: Network, objective: Objective, strategy: Strategy) -> Tuple[Network, str]:
    """The same without dead edges, and why what it leaves out may matter; "" if it cannot."""
    part, why = _named_of(network, objective, strategy)
    compared = _compared(strategy)
    for clock in strategy.left_out_clocks:
        why = why or _why_a_clock_matters(clock, part, compared)
    return (part, why) if why else (without_clocks(part, strategy.left_out_clocks), "")


def _named_of(network: Network, objective: Objective, strategy: Strategy) -> Tuple[Network, str]:
    """The same, with all clocks of the part."""
    names = _names(network, strategy)
    if names is None:
        return network, ""
    alive, extent = live(network, commanded(strategy.blocks))
    part = with_clocks_of(part_of(alive, *names), network, strategy)
    return part, why_it_matters(alive, objective, part, extent.places)


def _why_a_clock_matters(clock: str, part: Network, compared: AbstractSet[Optional[str]]) -> str:
    """Why the controller, which compares these clocks, may need a clock; "" where bounds on it do nothing but keep the
    environment from acting.

    Each bound on it has to be a lower one, on a move that the environment begins and is never obliged to make.
    """
    if clock in compared:
        return f"it compares {clock}, which it leaves out"
    for automaton in part.automata:
        if any(bound.clock == clock for bounds in automaton.stays.values() for bound in bounds):
            return f"{clock} bounds a stay of {automaton.name}"
        for edge in automaton.edges:
            what = f"{automaton.name} goes from {edge.source} to {edge.target}"
            if edge.controllable and clock in edge.resets:
                return f"the controller resets {clock} where {what}"
            for bound in edge.guard.clocks:
                if bound.clock != clock:
                    continue
                if edge.controllable or edge.received is not None:
                    return f"{clock} is compared where {what}, which the environment does not begin"
                if bound.op not in (">", ">=") or edge.source in automaton.stays:
                    return f"{clock} may oblige {automaton.name} to go from {edge.source} to {edge.target}"
    return ""


def _compared(strategy: Strategy) -> Set[Optional[str]]:
    """The clocks that the strategy compares."""
    return {name for constraint in strategy.constraints for name in (constraint.left, constraint.right)}


def with_clocks_of(part: Network, network: Network, strategy: Strategy) -> Network:
    """The part with the clocks that the strategy compares, though only dead edges of the part's automata may.

    Where the network says how its clocks start, all clocks of these automata stay: it may say so by differences.
    """
    compared = _compared(strategy)
    if network.start:
        names = {automaton.name for automaton in part.automata}
        compared.update(clock for a in network.automata if a.name in names for clock in a.clocks)
    clocks = tuple(clock for clock in network.clocks if clock in part.clocks or clock in compared)
    return part if clocks == part.clocks else replace(part, clocks=clocks, start=start_of(network, clocks))


def _names(network: Network, strategy: Strategy) -> Optional[Tuple[AbstractSet[str], AbstractSet[str]]]:
    """The automata and variables that a strategy names; None where these are all, or it names unknown ones."""
    if not strategy.blocks or strategy.in_parts:
        return None
    automata, variables = strategy.blocks[0].state.names
    if not automata.issubset(a.name for a in network.automata):
        return None
    variables = variables.intersection(name for name, _ in network.variables)
    if len(automata) == len(network.automata) and len(variables) == len(network.variables):
        return None
    return automata, variables


def why_it_matters(
    network: Network,
    objective: Objective,
    part: Network,
    places: Optional[Places] = None,
    before: Optional[Network] = None,
    hiding: bool = False,
) -> str:
    """Why what the part of the network leaves out may matter in it; "" if it cannot.

    `places`: where its automata may come to (see `relaxed_reachability`); None: where they may without commands.
    `before`: the network with all that may have been done before, where they are in the middle of a play; None: they
    begin in their initial locations. `hiding`: what is left out may do to the part what `tga.hidden` lets it do.
    """
    places = live(network, frozenset())[1].places if places is None else places
    kept = {automaton.name: automaton for automaton in part.automata}
    for name, _ in (*objective.goal, *objective.bad):
        if name not in kept:
            return f"the objective is about {name}"
    for automaton in network.automata:
        if automaton.name in kept:
            why = _why_an_edge_matters(automaton, kept[automaton.name], part, hiding)
        else:
            why = why_not_hidden(automaton, part) if hiding else _why_it_is_seen(automaton, part)
            why = why or _why_it_may_stop_time(automaton, network, places[automaton.name], before)
        if why:
            return f"{automaton.name} {why}"
    return ""


def _why_an_edge_matters(automaton: Automaton, kept: Automaton, part: Network, hiding: bool) -> str:
    """Why an edge of the automaton that the part does not have may change something there, other than by a move of the
    environment."""
    variables, known = {name for name, _ in part.variables}, set(kept.edges)
    for edge in automaton.edges if kept is not automaton else ():
        if edge in known or (hiding and is_loosened(edge, automaton, kept)):
            continue
        what = f"may go from {edge.source} to {edge.target}"
        if edge.source != edge.target or edge.resets or any(name in variables for name, _ in edge.assign):
            return f"{what}, by an edge that is left out"
        if any(name != automaton.name for name, _ in part.receivers.get(edge.sent, ())):
            return f"sends {edge.sent} by an edge that is left out"
        rival = any(e.sync == edge.sync and e.source == edge.source for e in kept.edges)
        if edge.received is not None and (rival or not edge.controllable):
            return f"receives {edge.received} by an edge that is left out"
    return ""


def _why_it_is_seen(automaton: Automaton, part: Network) -> str:
    """Why the part may notice what an automaton does that is not in it."""
    variables = dict(part.variables)
    for edge in automaton.edges:
        for name, _ in edge.assign:
            if name in variables:
                return f"sets {name}"
        for clock in edge.resets:
            if clock in part.clocks:
                return f"resets {clock}"
        if edge.sent in part.receivers:
            return f"sends {edge.sent}"
        if edge.received in part.senders and not edge.controllable:
            return f"takes {edge.received} out of the controller's hands"
    return ""


def _why_it_may_stop_time(
    automaton: Automaton, network: Network, places: AbstractSet[str], before: Optional[Network]
) -> str:
    """Why time may have to stop because of an automaton that nobody commands.

    At the end of each stay the environment must be able to lead it away, whatever the variables are; and every stay but
    the first may last some time, so that these moves leave time its way. Each stay begins with its clocks at 0, but
    one at the network's start with those of that. `places`: where it may be.
    """
    stays = automaton.stays
    if places.isdisjoint(stays):
        return ""
    whole = network if before is None else before
    own = tuple(sorted(whole.automaton(automaton.name).clocks))
    start = start_of(network, own)
    alone = Network(own, network.variables, network.channels, (whole.automaton(automaton.name),), start)
    arena = Arena(alone, common_denominator(alone.times))
    for name in sorted(places & stays.keys()):
        bounds = [(0, i, bound) for i, _, bound in arena.limits(stays[name])]
        clocks = {bound.clock for bound in stays[name]}
        stay = Dbm.of(arena.dim, [(i, 0, bound) for _, i, bound in bounds])
        if before is None and name == automaton.initial and (stay is None or not stay.includes(arena.start)):
            return f"may not stay in {name} at the start"
        entering = [edge for edge in automaton.edges if edge.target == name != edge.source]
        if any(not clocks.issubset(edge.resets) for edge in entering):
            return f"may come to {name} without time to stay"
        if any(bound.op == "<" for bound in stays[name]):
            return f"has no last instant in {name}"
        if any(bound.bound <= 0 for bound in stays[name]):
            return f"has no time to stay in {name}"
        ways = [edge for edge in automaton.edges if edge.source == name != edge.target and _is_free(edge)]
        later = None if stay is None else _with_what_has_passed(arena, stay, clocks, automaton.name, name, whole)
        pieces = [later]
        if name == automaton.initial and network.start:
            at_first = before is None and _only_passes(automaton.name, name, arena, whole)
            pieces = [later, arena.start.up().intersect(stay)] if at_first and stay is not None else [stay]
        if any(one is None or _left_at(arena, one, bounds, ways) for one in pieces):
            return f"may have to leave {name} and not be able to"
    return ""


def _only_passes(name: str, place: str, arena: Arena, network: Network) -> bool:
    """True if nothing resets the automaton's clocks while it stays at the place."""
    then = (edge for other, edge in network.edges if other != name or edge.source == edge.target == place)
    return all(arena.clock.keys().isdisjoint(edge.resets) for edge in then)


def _with_what_has_passed(
    arena: Arena, stay: Dbm, clocks: AbstractSet[str], name: str, place: str, network: Network
) -> Optional[Dbm]:
    """The points of a stay of the automaton at the place that began with these clocks at 0: any other of its clocks
    shows as much as they do, unless a move of the stay has reset it alone, and then less by what they show at that move
    at most."""
    loops = [edge for edge in network.automaton(name).edges if edge.source == edge.target == place]
    foreign = {clock for other, edge in network.edges if other != name for clock in edge.resets}
    found: Optional[Dbm] = stay
    for bounding in sorted(clocks):
        for other in sorted(arena.clock.keys() - foreign - {bounding}):
            most = raw(0, strict=False)
            for edge in loops:
                zone = stay.constrained_all(arena.limits(edge.guard.clocks))
                if zone is not None and other in edge.resets and bounding not in edge.resets:
                    most = max(most, zone.m[arena.clock[bounding] * arena.dim])
            found = found and found.constrained(arena.clock[bounding], arena.clock[other], most)
    return found


def _left_at(arena: Arena, stay: Dbm, bounds: Sequence[Bound], ways: Sequence[Edge]) -> List[Dbm]:
    """The points at the end of the stay from which none of the ways leads."""
    rest: List[Dbm] = []
    for _, clock, bound in bounds:
        last = stay.constrained(0, clock, raw(-(bound >> 1), strict=False))
        rest += [] if last is None else [last]
    for edge in ways:
        free: Optional[Dbm] = stay.constrained_all(arena.limits(edge.guard.clocks))
        rest = rest if free is None else [part for piece in rest for part in piece.minus(free)]
    return rest


def _is_free(edge: Edge) -> bool:
    """True for an edge that the environment can take whatever the variables are."""
    return not edge.controllable and not edge.guard.integers and edge.received is None
