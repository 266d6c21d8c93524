"""The model: its automata, as model.yaml holds them, and which of them an event moves."""

from __future__ import annotations

from copy import copy
from fractions import Fraction
from typing import AbstractSet, Any, Dict, FrozenSet, Iterator, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.data import reading
from pursue_runtime.locations import breaks_off, ends_part, is_end, part_of
from pursue_runtime.numbers import whole
from pursue_runtime.zones import EPSILON, Zone, holds, parse_zone

ORDER_DESK = "orders"
"""The kind of the automaton of what people order."""

ACTING = ("robot", "human", "agent")
"""The kinds of agents."""


class Edge(NamedTuple):
    """An edge: from `source` to `target` on `word`; `sync` is send, receive or own (a step without partners)."""

    source: str
    target: str
    word: str
    sync: str
    when: Zone
    tests: Tuple[Tuple[Tuple[str, int], ...], ...]
    assign: Dict[str, int]
    resets: Tuple[str, ...]
    controllable: bool

    @property
    def breaks_off(self) -> bool:
        """True where it breaks off an action."""
        return breaks_off(self.source, self.word)

    @property
    def ends_part(self) -> bool:
        """True where it ends a part of an action that is not the last one."""
        return ends_part(self.source, self.word)

    @property
    def is_end(self) -> bool:
        """True where it ends a movement or an action, or finds something out; not where it breaks one off."""
        return is_end(self.source, self.target) and not self.breaks_off

    def allowed(self, values: Mapping[str, int]) -> bool:
        """True where the variables let it be taken."""
        return all(any(values[name] == value for name, value in clause) for clause in self.tests)


class Automaton(NamedTuple):
    """One automaton; `invariants` gives the upper bounds on clocks of each location."""

    name: str
    kind: str
    initial: str
    invariants: Dict[str, Zone]
    edges: Tuple[Edge, ...]
    by_source: Dict[str, Tuple[Edge, ...]]
    reacts_to: FrozenSet[str] = frozenset()
    """The collaborative events of others in which a robot takes part."""

    @property
    def acts(self) -> bool:
        """True for an agent: a robot, a person or another one."""
        return self.kind in ACTING

    @property
    def is_robot(self) -> bool:
        """True for a robot."""
        return self.kind == "robot"

    @property
    def is_person(self) -> bool:
        """True for somebody who follows instructions."""
        return self.kind == "human"

    def edges_from(self, location: str) -> Tuple[Edge, ...]:
        """Its edges there, in order."""
        return self.by_source.get(location, ())


class Assumption(NamedTuple):
    """What is assumed of an agent: its variable is 1, and 0 once it has been broken; `clock` is "" for those that are
    not about times."""

    variable: str
    clock: str
    says: str


class Ends(NamedTuple):
    """When a mission ends in which nothing is to be reached: after so many time units (None: at any time); `answered`:
    once no answer is due."""

    after: Optional[float]
    answered: bool


class Promised(NamedTuple):
    """What an automaton watches in such a mission, in the scenario's words; `kept` is what happens in time where
    something is due, as in `answered`; `is_answered`: an end waits for that."""

    says: str
    kept: str
    is_answered: bool


class Written(NamedTuple):
    """An order that a person has written: its event, what is to hold or to happen, within how many time units."""

    event: str
    says: str
    within: float


class Move(NamedTuple):
    """One automaton's part of what an event does."""

    automaton: str
    edge: Edge


class Position(NamedTuple):
    """Where the automata are, the variables, and the clocks of now."""

    locations: Dict[str, str]
    values: Dict[str, int]
    clocks: Dict[str, float]

    def aged(self, delay: float) -> Position:
        """This position after so many time units in which nothing happens."""
        return self._replace(clocks={clock: value + delay for clock, value in self.clocks.items()})


class Model:
    """The network of the mission, in system order."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        with reading("model.yaml"):
            self.scenario = str(data["scenario"])
            self.reaction = float(Fraction(str(data.get("reaction", 0))))
            """Time units that the strategy allows a command; 0: not known."""
            self.clocks: Tuple[str, ...] = tuple(data["clocks"])
            self.variables: Dict[str, int] = dict(data["variables"])
            self.automata = tuple(_automaton(automaton) for automaton in data["automata"])
            self.assumptions = tuple(
                Assumption(str(each["variable"]), str(each.get("clock", "")), str(each["says"]))
                for each in data.get("assumptions", ())
            )
            self.labels = {str(name): str(label) for name, label in dict(data.get("labels") or {}).items()}
            """What people read in place of names of places, events and agents."""
            objective = data["objective"]
            self.objective = str(objective["kind"])
            self.goal = places_of(objective["goal"])
            """Automata and their locations: the goal is reached where all of them are there at once."""
            self.bad = places_of(objective["bad"])
            """The same: the mission is lost where any of them is there."""
            self.says = {str(name): str(text) for name, text in dict(objective.get("says") or {}).items()}
            """What the automata of objectives watch, in the scenario's words; empty where there is one objective."""
            self.promises = {str(name): _promised(each) for name, each in (objective.get("promises") or {}).items()}
            """What the automata of objectives watch where nothing is to be reached, in system order."""
            self.ends = _ends(data.get("ends"))
            """When the mission ends; None: its scenario does not say so."""
            self.given_up = tuple(str(text) for text in objective.get("given_up") or ())
            """Optional objectives that the mission does not promise."""
        self.written: Tuple[Written, ...] = ()
        """The orders that people have written so far; their events are behind those of the scenario."""
        self._by_name = {automaton.name: automaton for automaton in self.automata}

    @property
    def orders(self) -> Tuple[str, ...]:
        """What people can order, in the order of the scenario."""
        words = tuple(edge.word for automaton in self.of_kind(ORDER_DESK) for edge in automaton.edges)
        return words[: len(words) - len(self.written)]

    def extended(self, data: Mapping[str, Any]) -> Model:
        """Return the model with what a plan adds for orders that people have written. Raises DataError."""
        model = copy(self)
        model._extend(data)
        return model

    def become(self, other: Model) -> None:
        """Be as another model of the scenario, which has more or less of what people have written, for all who hold
        this one."""
        vars(self).update(vars(other))

    def _extend(self, data: Mapping[str, Any]) -> None:
        with reading("what a plan adds"):
            new = {each.name: each for each in map(_automaton, data["automata"])}
            heard = {tuple(map(str, each)) for each in data["heard"]}
            automata = [new.pop(each.name) if each.name in new else _heard(each, heard) for each in self.automata]
            clocks, variables = map(str, data["clocks"]), dict(data["variables"])
            objective = data["objective"]
            goal, bad = places_of(objective["goal"]), places_of(objective["bad"])
            says = {str(name): str(text) for name, text in dict(objective["says"]).items()}
            promises = {str(name): _promised(each) for name, each in dict(objective["promises"]).items()}
            written = tuple(
                Written(str(each["event"]), str(each["says"]), float(each["within"])) for each in data["written"]
            )
            self.clocks = tuple(dict.fromkeys((*self.clocks, *clocks)))
        self.automata = (*automata, *new.values())
        self.variables = {**self.variables, **variables}
        self.goal, self.bad = goal, tuple(dict.fromkeys((*self.bad, *bad)))
        self.says, self.promises, self.written = {**self.says, **says}, {**self.promises, **promises}, written
        self.labels = {**self.labels, **{each.event: f"{each.says} within {each.within:g}" for each in written}}
        self._by_name = {automaton.name: automaton for automaton in self.automata}

    def completed(self, position: Position) -> Position:
        """Return the position with what this model has more, as at the start."""
        first = self.initial()
        return Position(
            {**first.locations, **position.locations},
            {**first.values, **position.values},
            {**first.clocks, **position.clocks},
        )

    def automaton(self, name: str) -> Automaton:
        """The automaton of that name. Raises KeyError."""
        return self._by_name[name]

    def has(self, name: str) -> bool:
        """True if an automaton has that name."""
        return name in self._by_name

    def shown(self, name: str) -> str:
        """What people read for a name: its label, or the name itself."""
        return self.labels.get(name, name)

    @property
    def acting(self) -> List[Automaton]:
        """The agents, in system order."""
        return self.of_kind(*ACTING)

    def of_kind(self, *kinds: str) -> List[Automaton]:
        """The automata of these kinds, in system order."""
        return [automaton for automaton in self.automata if automaton.kind in kinds]

    def initial(self) -> Position:
        """Where everything starts, clocks at zero."""
        locations = {automaton.name: automaton.initial for automaton in self.automata}
        return Position(locations, dict(self.variables), dict.fromkeys(self.clocks, 0.0))

    def bounds_of(self, automaton: str, location: str, values: Mapping[str, int]) -> Zone:
        """The upper bounds on clocks of a location, without those of assumptions that have been broken."""
        bounds = self._by_name[automaton].invariants[location]
        broken = {each.clock for each in self.assumptions if values[each.variable] == 0}
        return tuple(bound for bound in bounds if bound.left not in broken) if broken else bounds

    def joint_move(
        self, position: Position, word: str, agent: str = "", timed: bool = True
    ) -> Optional[Tuple[Move, ...]]:
        """What `word` (by `agent`, or the first automaton that can) does here: the mover's part, then each receiver's.

        None: it cannot happen. Untimed, bounds on clocks do not count: a robot may be earlier or later than its model.
        """
        for automaton in self.automata:
            if agent and automaton.name != agent:
                continue
            for edge in automaton.edges_from(position.locations[automaton.name]):
                if edge.word != word or edge.sync == "receive" or not self._enabled(edge, position, timed):
                    continue
                moves = (Move(automaton.name, edge), *self._receivers(automaton, edge, position))
                if not timed or self._fits(moves, position):
                    return moves
        return None

    def reported(self, position: Position, word: str, agent: str = "") -> str:
        """What the report of an end ends here: where parts of an action are left, the word of the end of a part."""
        part = part_of(word)
        ends_part = part and self.joint_move(position, word, agent, timed=False) is None
        return part if ends_part and self.joint_move(position, part, agent, timed=False) is not None else word

    def possible(self, position: Position, timed: bool = True) -> List[str]:
        """The words that can happen here, each once, in system order."""
        words: Dict[str, None] = {}
        for automaton in self.automata:
            for edge in automaton.edges_from(position.locations[automaton.name]):
                if edge.sync != "receive" and self.joint_move(position, edge.word, automaton.name, timed):
                    words[edge.word] = None
        return list(words)

    @staticmethod
    def after(moves: Tuple[Move, ...], position: Position) -> Position:
        """The position that the moves lead to."""
        locations, values, clocks = dict(position.locations), dict(position.values), dict(position.clocks)
        for name, edge in moves:
            locations[name] = edge.target
            values.update(edge.assign)
            clocks.update(dict.fromkeys(edge.resets, 0.0))
        return Position(locations, values, clocks)

    @staticmethod
    def _enabled(edge: Edge, position: Position, timed: bool) -> bool:
        return edge.allowed(position.values) and (not timed or holds(edge.when, position.clocks, EPSILON))

    def _receivers(self, mover: Automaton, edge: Edge, position: Position) -> Iterator[Move]:
        if edge.sync != "send":
            return
        for automaton in self.automata:
            if automaton is mover:
                continue
            for answer in automaton.edges_from(position.locations[automaton.name]):
                if answer.word == edge.word and answer.sync == "receive" and answer.allowed(position.values):
                    yield Move(automaton.name, answer)
                    break

    def _fits(self, moves: Tuple[Move, ...], position: Position) -> bool:
        """True where the invariants hold that the moves lead to."""
        after = self.after(moves, position)
        return all(
            holds(self.bounds_of(name, edge.target, after.values), after.clocks, EPSILON) for name, edge in moves
        )


def places_of(data: Any) -> Tuple[Tuple[str, str], ...]:
    """Automata and locations as data files have them: one pair, a list of pairs, or nothing."""
    pairs = [data] if data and isinstance(data[0], str) else data or []
    return tuple((str(automaton), str(location)) for automaton, location in pairs)


def _promised(data: Mapping[str, Any]) -> Promised:
    return Promised(str(data["says"]), str(data.get("kept", "")), bool(data.get("answered", False)))


def _ends(data: Optional[Mapping[str, Any]]) -> Optional[Ends]:
    if data is None:
        return None
    after = data.get("after")
    return Ends(None if after is None else float(Fraction(str(after))), bool(data.get("answered", False)))


def _automaton(data: Mapping[str, Any]) -> Automaton:
    invariants = {str(name): _bounds(bounds) for name, bounds in data["locations"].items()}
    edges = tuple(_edge(edge) for edge in data["edges"])
    unknown = {place for edge in edges for place in (edge.source, edge.target)} - set(invariants)
    if unknown or data["initial"] not in invariants:
        raise ValueError(f"{data['name']}: unknown location among {sorted(unknown) or data['initial']}")
    by_source = {location: tuple(edge for edge in edges if edge.source == location) for location in invariants}
    named = str(data["name"]), str(data["kind"]), str(data["initial"])
    return Automaton(*named, invariants, edges, by_source, frozenset(map(str, data.get("reacts_to", ()))))


def _heard(automaton: Automaton, heard: AbstractSet[Tuple[str, ...]]) -> Automaton:
    """The automaton, with steps of its own that others hear of now."""
    edges = tuple(
        edge._replace(sync="send") if (automaton.name, edge.source, edge.target, edge.word) in heard else edge
        for edge in automaton.edges
    )
    if edges == automaton.edges:
        return automaton
    by_source = {place: tuple(edge for edge in edges if edge.source == place) for place in automaton.invariants}
    return automaton._replace(edges=edges, by_source=by_source)


def _edge(data: Mapping[str, Any]) -> Edge:
    tests = tuple(tuple(_test(test) for test in clause) for clause in data.get("if", ()))
    return Edge(
        source=str(data["from"]),
        target=str(data["to"]),
        word=str(data["word"]),
        sync=str(data["sync"]),
        when=_bounds(data.get("when", ())),
        tests=tests,
        assign=dict(data.get("set", {})),
        resets=tuple(data.get("reset", ())),
        controllable=bool(data["controllable"]),
    )


def _bounds(texts: Any) -> Zone:
    return tuple(constraint for text in texts for constraint in parse_zone(text))


def _test(text: str) -> Tuple[str, int]:
    name, _, value = text.partition("=")
    return name.strip(), whole(value.strip())
