"""Two promises that exclude each other where somebody stays: "no robot at room1 while the guest is there", and "a robot
at room1 within 60 of the guest's coming".

An agent whom nobody controls goes to a place and stays there for ever; then those who can ask for something wherever
they stay ask for it. What all the others do, wherever they are, is the controller's choice at any moment. That is more
than it has, so where the promises cannot be kept even so they are lost. No times are looked at but that what has a
deadline has to end, so this is decided at once, with any number of robots.
"""

from __future__ import annotations

from itertools import combinations, product
from math import prod
from typing import AbstractSet, Collection, Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.solving.duties import is_free
from pursue_gen.solving.stays import LostToAStay, arrivals
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import is_nobodys
from pursue_gen.tga.network import Automaton, Edge, Guard, Kind, Network, Objective

_MOST = 500
"""So many valuations of the others' variables are looked at; promises about more are left to the solver. Measured on
lab scenario 32 and a large one."""

_Places = Tuple[str, ...]
"""A location of each automaton that watches one of the promises."""

_Valuation = Mapping[str, int]


def excluded_by_a_stay(network: Network, objective: Objective) -> Optional[LostToAStay]:
    """The first two promises, places to be avoided, that cannot both be kept where one agent stays; None where none are
    found."""
    for agent, arrival in _arrivals(network) if not objective.reaches else ():
        asking = [place for place in objective.bad if _asks(network.automaton(place[0]), arrival)]
        requests = _requests(network, arrival)
        waiting = [(name, at) for name, at in objective.bad if requests & network.automaton(name).channels]
        for pair in combinations(objective.bad, 2):
            concerned = any(place in asking for place in pair) and all(place in asking + waiting for place in pair)
            if concerned and not _can_be_kept(network, pair, arrival, requests):
                return LostToAStay(Objective(Kind.SAFETY, bad=pair), agent, arrival.target)
    return None


def _arrivals(network: Network) -> Iterator[Tuple[str, Edge]]:
    """The agents whom nobody controls, with the edges by which they come to places where they may stay for ever, each
    by a way that they can take in any case."""
    for automaton in filter(is_nobodys, network.automata):
        for edge in arrivals(automaton):
            yield automaton.name, edge


def _requests(network: Network, arrival: Edge) -> Set[str]:
    """The channels on which somebody whom nobody controls can send wherever he stays, after the arrival as well."""
    found: Set[str] = set()
    for agent in filter(is_nobodys, network.automata):
        stays = [arrival.target] if arrival in agent.edges else agent.lasting
        calls = [edge for edge in agent.edges if edge.source == edge.target and is_free(edge)]
        sent = [{edge.sent for edge in calls if edge.sent is not None and edge.source == at} for at in stays]
        found |= set.intersection(*sent) if sent else set()
    return found


def _asks(automaton: Automaton, arrival: Edge) -> bool:
    """True if the automaton hears of the arrival, or asks about where it leads."""
    stay = dict(arrival.assign)
    if arrival.channel in automaton.channels:
        return True
    return any(stay.get(t.variable) == t.value for edge in automaton.edges for c in edge.guard.integers for t in c)


def _can_be_kept(network: Network, bad: Sequence[Place], arrival: Edge, requests: AbstractSet[str]) -> bool:
    """False where those who watch these promises come to what is to be avoided after the arrival, and after all these
    requests, whatever the others do."""
    watching = [network.automaton(name) for name, _ in bad]
    others = _Others(network, watching, arrival)
    if others.too_many:
        return True
    before = set(product(*([place.name for place in a.locations if (a.name, place.name) not in bad] for a in watching)))
    kept = set(before)
    while kept:
        steps = {here: _steps(watching, here, others, kept) for here in kept}
        lasting = {here for here in kept if steps[here] is not None and _ends_in_time(watching, here, steps)}
        if lasting == kept:
            break
        kept = lasting
    return any(
        there in kept and not _is_led_out(watching, there, values, kept)
        for here in before
        for values in others.valuations
        for there in (_asked(watching, then, requests) for then in _after(watching, here, values, arrival))
    )


def _asked(watching: Sequence[Automaton], here: _Places, requests: AbstractSet[str]) -> _Places:
    """Where the automata are after hearing a request, of those that begin to wait at it whatever the variables are."""
    found = []
    for automaton, place in zip(watching, here):
        hearing = (_hearing([e for e in automaton.edges if e.source == place], channel) for channel in requests)
        led = {some[0].target for some in hearing if len(some) == 1 and some[0].guard == Guard()}
        found.append(led.pop() if len(led) == 1 else place)
    return tuple(found)


def _after(watching: Sequence[Automaton], here: _Places, values: _Valuation, arrival: Edge) -> Iterator[_Places]:
    """Where the automata may be that hear of the arrival; each that can hear it does."""
    if arrival.sync is None:
        yield here
        return
    moved = {name for name, _ in arrival.assign}
    options: List[List[str]] = []
    for automaton, place in zip(watching, here):
        hearing = _hearing([e for e in automaton.edges if e.source == place], arrival.sync.channel)
        # Its tests of what the arrival sets were made before the arrival, so they may have held or not.
        sure = [e for e in hearing if moved.isdisjoint(e.tested)]
        taken = [e.target for e in hearing if e not in sure or e.guard.holds(values)]
        options.append(taken if any(e.target in taken and e.guard.holds(values) for e in sure) else [place, *taken])
    yield from product(*options)


class _Others:
    """All values of the variables that those who watch ask about, while somebody stays at a place: one of each set of
    values that they cannot tell apart. `too_many`: there are more than `_MOST`, and they were not made.

    `sending`: for each channel, what is assigned where somebody sends on it, other than whoever stays.
    """

    def __init__(self, network: Network, watching: Sequence[Automaton], arrival: Edge) -> None:
        clauses = {clause for a in watching for edge in a.edges for clause in edge.guard.integers}
        stay = dict(arrival.assign)
        edges = [edge for a in network.automata if arrival not in a.edges for edge in a.edges]
        self._classes: Dict[str, Dict[int, int]] = {}
        domains: Dict[str, Collection[int]] = {}
        for name in sorted({test.variable for clause in clauses for test in clause}):
            asked = [{test.value for test in clause if test.variable == name} for clause in clauses]
            known = [value for variable, value in network.variables if variable == name]
            known += [value for edge in edges for variable, value in edge.assign if variable == name]
            first: Dict[Tuple[bool, ...], int] = {}
            self._classes[name] = {v: first.setdefault(tuple(v in some for some in asked), v) for v in known}
            domains[name] = [stay[name]] if name in stay else list(first.values())
        sends = any(edge.sent is not None for a in watching for edge in a.edges)
        self.too_many = sends or prod(map(len, domains.values())) > _MOST
        rows = () if self.too_many else product(*domains.values())
        self.valuations: List[_Valuation] = [dict(zip(domains, row)) for row in rows]
        self.sending: Dict[str, Set[Tuple[Tuple[str, int], ...]]] = {}
        for edge in edges:
            if edge.sent is not None:
                some = tuple((name, value) for name, value in edge.assign if name in domains and name not in stay)
                self.sending.setdefault(edge.sent, set()).add(some)

    def after(self, values: _Valuation, assign: Tuple[Tuple[str, int], ...]) -> _Valuation:
        """The values when some are set."""
        return {**values, **{name: self._classes[name][value] for name, value in assign}} if assign else values


_Step = Tuple[_Places, FrozenSet[int]]
"""Where a step leads, and which automata end there what has a deadline, or begin it anew."""


def _steps(
    watching: Sequence[Automaton], here: _Places, others: _Others, kept: AbstractSet[_Places]
) -> Optional[Set[_Step]]:
    """The steps from here that stay in `kept`, None where whatever holds the environment leads out of it."""
    found: Set[_Step] = set()
    possible = False
    for values in others.valuations:
        if _is_led_out(watching, here, values, kept):
            continue
        possible = True
        taken = _taken(watching, here, values)
        alone = [
            (values, [edge if k == n else None for k in range(len(here))])
            for n, some in enumerate(taken)
            for edge in some
            if edge.sync is None
        ]
        together = [
            (others.after(values, sent), list(edges))
            for channel in {e.received for some in taken for e in some if e.received is not None}
            for sent in others.sending.get(channel, ())
            for edges in product(*([None, *_hearing(some, channel)] for some in taken))
        ]
        for then, edges in (*alone, *together):
            there = tuple(place if edge is None else edge.target for place, edge in zip(here, edges))
            if there in kept and not _is_led_out(watching, there, then, kept):
                ended = (k for k, edge in enumerate(edges) if edge is not None and _ends(watching[k], edge))
                found.add((there, frozenset(ended)))
    return found if possible else None


def _ends_in_time(watching: Sequence[Automaton], here: _Places, steps: Mapping[_Places, Optional[Set[_Step]]]) -> bool:
    """True if from here each deadline that is running can come to an end."""
    met, waiting = {here}, [here]
    ended: Set[int] = set()
    while waiting:
        for there, some in steps[waiting.pop()] or ():
            ended |= some
            if there not in met:
                met.add(there)
                waiting.append(there)
    return all(k in ended for k, (a, place) in enumerate(zip(watching, here)) if _deadline(a, place))


def _taken(watching: Sequence[Automaton], here: _Places, values: _Valuation) -> List[List[Edge]]:
    """Of each automaton the edges that can be taken there, whatever the clocks."""
    pairs = zip(watching, here)
    return [[e for e in a.edges if e.source == place and e.guard.holds(values)] for a, place in pairs]


def _hearing(edges: Sequence[Edge], channel: str) -> List[Edge]:
    return [edge for edge in edges if edge.received == channel]


def _is_led_out(watching: Sequence[Automaton], here: _Places, values: _Valuation, kept: AbstractSet[_Places]) -> bool:
    """True if the environment can at once lead one of the automata out of `kept`."""
    taken = ((k, edge) for k, some in enumerate(_taken(watching, here, values)) for edge in some)
    led = ((k, edge.target) for k, edge in taken if not (edge.controllable or edge.sync or edge.guard.clocks))
    return any((*here[:k], there, *here[k + 1 :]) not in kept for k, there in led)


def _ends(automaton: Automaton, edge: Edge) -> bool:
    return edge.target != edge.source or bool(_deadline(automaton, edge.source).intersection(edge.resets))


def _deadline(automaton: Automaton, place: str) -> Set[str]:
    """The clocks that bound a stay there."""
    return {bound.clock for bound in automaton.stays.get(place, ())}
