"""What has to be reached before the goal: locations of rules without which nobody can do what leads there.

They are read off the guards, as the landmarks of a plan are (Hoffmann, Porteous, Sebastia, "Ordered landmarks in
planning", JAIR 2004). What is found is only tried: stages that do not win are not used, and a missing one costs time.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import Dict, FrozenSet, Iterable, Iterator, List, Optional, Sequence, Set, Tuple

from pursue_gen.proof.relaxed_reachability import is_controllers
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ending import owner_of
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, Edge, Network


@dataclass(frozen=True)
class Subgoal:
    """A location or value to come to, the controllable agents who can do what leads there, what is needed before."""

    place: Place
    agents: FrozenSet[str]
    before: FrozenSet[Place] = frozenset()


def subgoals(network: Network, goal: Place) -> Tuple[Subgoal, ...]:
    """The subgoals of a goal in an order in which they can be met; the goal itself is the last."""
    return _SubgoalSearch(network).of(goal)


def protections(network: Network, bad: Iterable[Place]) -> Tuple[Subgoal, ...]:
    """The values after which nobody can do what leads to the locations, each given by a controllable agent."""
    search = _SubgoalSearch(network)
    return tuple(dict.fromkeys(subgoal for place in bad for subgoal in search.against(place)))


def commanded_agents(network: Network) -> Tuple[str, ...]:
    """The agents with edges that only the controller takes."""
    taken = network.taken_over
    return tuple(a.name for a in network.automata if is_agent(a) and any(is_controllers(e, taken) for e in a.edges))


class _SubgoalSearch:
    def __init__(self, network: Network) -> None:
        self._network = network
        self._commanded = set(commanded_agents(network))
        self._initial = dict(network.variables)

    def of(self, goal: Place) -> Tuple[Subgoal, ...]:
        """The subgoals of the goal, and the goal."""
        found: Dict[Place, Subgoal] = {}
        self._visit(goal, found, set())
        return tuple(found.values())

    def against(self, bad: Place) -> Iterator[Subgoal]:
        """For each edge into the location the first value that a controllable agent can give, and that forbids it."""
        for edge in self._network.automaton(bad[0]).edges:
            if edge.target == bad[1] != edge.source:
                values = (value for fact in _common(self._moves(bad[0], edge)) for value in self._other_values(fact))
                yield from islice(values, 1)

    def _other_values(self, fact: Tuple[str, FrozenSet[int]]) -> Iterator[Subgoal]:
        variable, needed = fact
        owner = owner_of(self._network, variable)
        if owner is None or self._initial[variable] not in needed:
            return
        doers: Dict[int, Set[str]] = {}
        for edge in self._network.automaton(owner).edges:
            for name, value in edge.assign:
                if name == variable and value not in needed:
                    doers.setdefault(value, set()).update(self._doers(self._moves(owner, edge)))
        for value, some in sorted(doers.items()):
            if some:
                yield Subgoal((variable, str(value)), frozenset(some))

    def _visit(self, place: Place, found: Dict[Place, Subgoal], met: Set[Place]) -> None:
        """Add what has to be reached before the place, then the place."""
        met.add(place)
        doers: Set[str] = set()
        earlier: Set[Place] = set()
        for edge in _way_to(self._network.automaton(place[0]), place[1]):
            moves = self._moves(place[0], edge)
            doers.update(self._doers(moves))
            for before in filter(None, (self._place_of(fact, place[0]) for fact in _common(moves))):
                if before not in met:
                    self._visit(before, found, met)
                known = found.get(before)  # None where each of the two needs the other
                earlier.update([before], known.before if known else ())
        found[place] = Subgoal(place, frozenset(doers), frozenset(earlier))

    def _moves(self, automaton: str, edge: Edge) -> Sequence[Tuple[str, Edge]]:
        """Who may make the edge be taken, and by which edges."""
        return [(automaton, edge)] if edge.received is None else self._network.senders.get(edge.received, ())

    def _doers(self, moves: Iterable[Tuple[str, Edge]]) -> Iterator[str]:
        """The commanded agents who make these moves or whose position they need."""
        for name, edge in moves:
            owners = {name}.union(*(self._network.setters.get(tested, ()) for tested in edge.tested))
            yield from owners & self._commanded

    def _place_of(self, fact: Tuple[str, FrozenSet[int]], asking: str) -> Optional[Place]:
        """The one place that makes the fact true; None where it is true at first, an agent's, or not of one place."""
        variable, values = fact
        name = owner_of(self._network, variable)
        if self._initial.get(variable) in values or name in (None, asking):
            return None
        owner = self._network.automaton(name or "")
        if is_agent(owner):
            return None
        places = {e.target for e in owner.edges if any(n == variable and v in values for n, v in e.assign)}
        if len(places) != 1 or places == {owner.initial}:
            return None
        return owner.name, places.pop()


def _common(moves: Iterable[Tuple[str, Edge]]) -> List[Tuple[str, FrozenSet[int]]]:
    """The facts that all of the moves need, in order."""
    needed: Optional[List[Tuple[str, FrozenSet[int]]]] = None
    for _, edge in moves:
        facts = []
        for clause in edge.guard.integers:
            names = {test.variable for test in clause}
            if len(names) == 1:
                facts.append((names.pop(), frozenset(test.value for test in clause)))
        needed = facts if needed is None else [fact for fact in needed if fact in facts]
    return needed or []


def _way_to(automaton: Automaton, location: str) -> List[Edge]:
    """The edges of the only way from the start to a location, in order; of several ways those of their last parts."""
    way: List[Edge] = []
    place = location
    met = {location}
    while place != automaton.initial:
        edges = [e for e in automaton.edges if e.target == place != e.source]
        way = edges + way
        sources = {e.source for e in edges}
        if len(sources) != 1 or sources & met:
            break
        place = sources.pop()
        met.add(place)
    return way
