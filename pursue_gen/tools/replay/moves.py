"""Which joint moves of a network a word can mean, where they lead, how far clocks are from allowing them, and what of
assumptions and objectives is broken."""

from __future__ import annotations

from itertools import chain, product
from typing import Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_gen.language.network_names import assumption_clock
from pursue_gen.language.symbols import Role, Symbol, role_of
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import ClockBound, Edge, Network, Objective, Test
from pursue_runtime.state import SystemState

EXACT = 1e-6
"""Time units by which a moment may be missed by rounding."""

Part = Tuple[str, Edge]
"""An automaton and its edge."""

Move = Tuple[Part, ...]
"""The mover's part, then each receiver's."""


class DiscreteState(NamedTuple):
    """Where every automaton is, and the variables."""

    locations: Mapping[str, str]
    values: Mapping[str, int]

    @property
    def facts(self) -> Mapping[str, object]:
        """Both, by name."""
        return {**self.locations, **self.values}


def place_of(state: SystemState) -> DiscreteState:
    """The discrete part of a state of a mission."""
    return DiscreteState(dict(state.locations), dict(state.values))


class Untimely(NamedTuple):
    """By how many time units the clocks miss a move (0: they do not), and whether it comes too late for them."""

    amount: float
    late: bool


class Moves:
    """The joint moves of one network. `clocks`: those of each automaton; `assumed`: of assumptions."""

    def __init__(self, network: Network) -> None:
        self.network = network
        self.initial = DiscreteState(
            {automaton.name: automaton.initial for automaton in network.automata}, dict(network.variables)
        )
        self.clocks = {automaton.name: automaton.clocks for automaton in network.automata}
        self._edges: Dict[Tuple[str, str], List[Edge]] = {}
        self._invariants: Dict[Tuple[str, str], Tuple[ClockBound, ...]] = {}
        for automaton in network.automata:
            for location in automaton.locations:
                self._invariants[automaton.name, location.name] = location.invariant
            for edge in automaton.edges:
                self._edges.setdefault((automaton.name, edge.source), []).append(edge)
        self._names = [automaton.name for automaton in network.automata]
        assumed = (Symbol.of(name) for name, _ in network.variables if role_of(name) is Role.ASSUMPTION)
        self.assumed: Dict[str, str] = {name: assumption_clock(int(name.parts[0])) for name in assumed}

    def knows(self, place: DiscreteState) -> bool:
        """True where the place names these automata with locations of theirs, and these variables."""
        return (
            set(place.locations) == set(self._names)
            and set(place.values) == set(self.initial.values)
            and all(part in self._invariants for part in place.locations.items())
        )

    def of(self, place: DiscreteState, word: str, agent: str = "") -> Iterator[Move]:
        """What the word (of this agent, or of anybody) can do there, whatever the clocks.

        The end of what several do together is the move of the one who does it, whoever reports it last.
        """
        able = self.sharing(place, word, agent) or ((agent,) if agent else self._names)
        for name in self._names:
            if name not in able:
                continue
            for edge in self._enabled(name, place):
                receives = edge.sync is not None and not edge.sync.sends
                if not receives and event_word(name, edge) == word:
                    yield from self._joint(name, edge, place)

    def sharing(self, place: DiscreteState, word: str, agent: str) -> Tuple[str, ...]:
        """Who does something together there that ends with the word, the agent among them; () where that is nobody."""
        here = place.locations.get(agent, "")
        if role_of(here) is not Role.WORK:
            return ()
        ends = {
            name: [edge for edge in self._edges.get((name, here), ()) if edge.sync and edge.sync.channel == word]
            for name in self._names
            if place.locations.get(name) == here
        }
        receiving = any(not edge.sync.sends for edges in ends.values() for edge in edges if edge.sync)
        return tuple(name for name, edges in ends.items() if edges) if receiving and ends.get(agent) else ()

    def internal(self, place: DiscreteState, objective: Objective) -> Iterator[Move]:
        """The steps by which objectives themselves become broken."""
        for name, bad in objective.bad:
            for edge in self._enabled(name, place):
                if edge.sync is None and edge.target == bad:
                    yield ((name, edge),)

    def is_withdrawn(self, event: str, place: DiscreteState, later: DiscreteState) -> bool:
        """True where the objectives that an order begins change as if it had been answered, and nothing else does."""
        move: List[Part] = []
        for name, there in later.locations.items():
            if there != place.locations[name]:
                move += [(name, edge) for edge in self._answers(event, name, place) if edge.target == there][:1]
        return bool(move) and after(tuple(move), place)[0] == later

    def withdrawn(self, event: str, place: DiscreteState) -> DiscreteState:
        """Where that leads: each of them as if the one that waits longest had its answer."""
        move = ((name, next(iter(self._answers(event, name, place)), None)) for name in self._names)
        return after(tuple((name, edge) for name, edge in move if edge is not None), place)[0]

    def _answers(self, event: str, name: str, place: DiscreteState) -> List[Edge]:
        """What an objective that this order begins can hear there, but for another such order."""
        own = [edge for (of, _), edges in self._edges.items() if of == name for edge in edges if edge.sync]
        asks = any(edge.sync and _receives(edge, event) for edge in own)
        heard = [edge for edge in self._enabled(name, place) if edge.sync and not edge.sync.sends]
        return [edge for edge in heard if not _receives(edge, event)] if asks else []

    def way_back(self, place: DiscreteState, robot: str) -> Optional[Part]:
        """How a robot that moves there would set out on the same way in the other direction; None if it cannot."""
        here = place.locations.get(robot, "")
        origins = {source for (name, source) in self._edges if name == robot and here in self._targets(robot, source)}
        for end in self._targets(robot, here):
            for edge in self._edges.get((robot, end), ()):
                if edge.enters is Role.WAY and origins & set(self._targets(robot, edge.target)):
                    return robot, edge
        return None

    def _targets(self, name: str, source: str) -> List[str]:
        return [edge.target for edge in self._edges.get((name, source), ())]

    def possible(self, place: DiscreteState) -> List[str]:
        """The words that can happen there, whatever the clocks."""
        words = {
            event_word(name, edge): None
            for name in self._names
            for edge in self._enabled(name, place)
            if edge.sync is None or edge.sync.sends
        }
        return list(words)

    def untimely(self, move: Move, place: DiscreteState, clocks: Mapping[str, float]) -> Untimely:
        """How far the clocks are from the mover's guard and from the invariant of the place that it leaves."""
        name, edge = move[0]
        bounds = (*edge.guard.clocks, *self._bounds((name, edge.source), place))
        worst = Untimely(0.0, False)
        for bound in bounds:
            value = clocks.get(bound.clock, 0.0)
            early, late = bound.bound - value, value - bound.bound
            misses = {"<": late, "<=": late, ">": early, ">=": early, "==": max(early, late)}[bound.op]
            if misses > worst.amount:
                worst = Untimely(misses, misses == late)
        return worst

    def overdue(self, place: DiscreteState, clocks: Mapping[str, float]) -> Dict[str, float]:
        """Who should have moved already, and the time units since then."""
        late: Dict[str, float] = {}
        for name, _, by in self._exceeded(place, clocks):
            late[name] = max(late.get(name, 0.0), by)
        return {name: by for name, by in late.items() if by > 0.0}

    def overstayed(self, place: DiscreteState, clocks: Mapping[str, float]) -> Tuple[str, ...]:
        """The variables of the assumptions by which somebody should have left by now."""
        late = {clock: by for _, clock, by in self._exceeded(place, clocks)}
        return tuple(name for name in _holding(place.values) if late.get(self.assumed[name], -1.0) >= 0)

    def _exceeded(self, place: DiscreteState, clocks: Mapping[str, float]) -> Iterator[Tuple[str, str, float]]:
        """Whose stay there is bounded by which clock, and by how many time units that is past its bound; below 0: it is
        not."""
        for name, here in place.locations.items():
            for bound in self._bounds((name, here), place):
                yield name, bound.clock, clocks.get(bound.clock, 0.0) - bound.bound

    def is_due(self, move: Move, place: DiscreteState, clocks: Mapping[str, float]) -> bool:
        """True unless the mover may stay where it is for some time: a deadline is missed at its end, not before."""
        name, edge = move[0]
        bounds = self._bounds((name, edge.source), place)
        return all(clocks.get(bound.clock, 0.0) >= bound.bound - EXACT for bound in bounds)

    def _bounds(self, part: Tuple[str, str], place: DiscreteState) -> Sequence[ClockBound]:
        """The invariant of an automaton's location, without the bounds of assumptions that have been broken."""
        bounds = self._invariants.get(part, ())
        broken = {clock for variable, clock in self.assumed.items() if place.values.get(variable) == 0}
        return [bound for bound in bounds if bound.clock not in broken] if broken else bounds

    def _enabled(self, name: str, place: DiscreteState) -> Iterator[Edge]:
        for edge in self._edges.get((name, place.locations.get(name, "")), ()):
            if all(any(place.values.get(t.variable) == t.value for t in clause) for clause in edge.guard.integers):
                yield edge

    def _joint(self, mover: str, edge: Edge, place: DiscreteState) -> Iterator[Move]:
        """The edge with every choice of one receiving edge for each automaton that has one."""
        answers: List[Sequence[Part]] = []
        if edge.sync is not None:
            for name in self._names:
                channel = edge.sync.channel
                enabled = self._enabled(name, place) if name != mover else []
                receiving = [(name, e) for e in enabled if _receives(e, channel)]
                if receiving:
                    answers.append(receiving)
        for chosen in product(*answers):
            yield ((mover, edge), *chosen)


def _receives(edge: Edge, channel: str) -> bool:
    return edge.sync is not None and not edge.sync.sends and edge.sync.channel == channel


def after(move: Move, place: DiscreteState) -> Tuple[DiscreteState, Tuple[str, ...]]:
    """Where the move leads, and the clocks that it resets."""
    locations, values = dict(place.locations), dict(place.values)
    resets: Dict[str, Optional[str]] = {}
    for name, edge in move:
        locations[name] = edge.target
        values.update(edge.assign)
        resets.update(dict.fromkeys(edge.resets))
    return DiscreteState(locations, values), tuple(resets)


Found = Tuple[DiscreteState, List[Move]]
"""The place with the variables of broken assumptions at 0, and the moves that are possible there."""


def newly_broken(before: Mapping[str, int], now: Mapping[str, int]) -> Tuple[str, ...]:
    """The variables of the assumptions that hold among the values before, and not among those now."""
    return tuple(name for name in _holding(before) if now.get(name) == 0)


def _holding(values: Mapping[str, int]) -> List[str]:
    return [name for name, value in values.items() if value and role_of(name) is Role.ASSUMPTION]


def without(place: DiscreteState, broken: Sequence[str]) -> DiscreteState:
    """The place with these variables at 0."""
    return place._replace(values={**place.values, **dict.fromkeys(broken, 0)})


def breach(moves: Moves, place: DiscreteState, word: str, agent: str) -> Found:
    """What a word does that only assumptions exclude; no moves where something else excludes it.

    One assumption is broken where that suffices, else all that hold, as the observer has it.
    """
    standing = _holding(place.values)
    for some in chain(([name] for name in standing), [standing] if len(standing) > 1 else []):
        found = list(moves.of(without(place, some), word, agent))
        if found:
            return without(place, some), found
    return place, []


class Broken:
    """The edges by which objectives become broken without anybody's doing, by the first test of each."""

    def __init__(self, network: Network, objective: Objective) -> None:
        self._edges: Dict[Test, List[Tuple[str, Edge]]] = {}
        bad = set(objective.bad)
        for name, edge in network.edges:
            clauses = edge.guard.integers
            if (name, edge.target) in bad and edge.sync is None and clauses and not edge.guard.clocks:
                for test in clauses[0]:
                    self._edges.setdefault(test, []).append((name, edge))

    def of(self, locations: Mapping[str, str], values: Mapping[str, int]) -> str:
        """The automaton of an objective that is broken in a state; "" where none is, or it is marked already."""
        for item in values.items():
            for name, edge in self._edges.get(Test(*item), ()):
                if locations.get(name) == edge.source and edge.guard.holds(values):
                    return name
        return ""
