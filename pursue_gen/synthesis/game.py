"""A network and an objective as integer tables: what both engines play on.

Everything is an index: clocks count from 1 (0 is the constant 0), all else from 0. All bounds are scaled so that they
and the reaction delay are integers: a time t of the network is `t * scale` here. A bound is (i, j, raw), see `dbm`.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Network, Objective
from pursue_gen.tga.scale import common_denominator
from pursue_gen.zones.dbm import Dbm, constant, raw

Bound = Tuple[int, int, int]
"""`x_i - x_j` within a raw bound: (i, j, raw)."""

Clause = Tuple[Tuple[int, int], ...]
"""At least one of the variables has the value beside it: ((variable, value), …)."""

NO_CHANNEL = -1

Action = Optional[Tuple[int, ...]]
"""What to do: a joint move by its edges, the sender's (or tau) first, or None: wait."""

RawBlock = Tuple[Tuple[int, ...], Tuple[int, ...], Sequence[Tuple[Tuple[int, ...], Action]]]
"""A discrete state's part of a strategy as engines hand it over: locations, values, (matrix of a zone, action)s."""


Leaving = Tuple[Sequence[int], Mapping[int, Sequence[int]]]
"""The edges that leave a location: those that send or move by themselves, and by their channel those that receive."""


@dataclass(frozen=True)
class GameEdge:
    """An edge of an automaton.

    `bounds` are the clock guard, `clauses` the integer guard (all of them hold), `channel` is NO_CHANNEL for a step of
    its own (then `sends` is true as well: the edge moves by itself), `assignments` are (variable, value), `resets` are
    clocks. `duration` is the largest lower bound of the guard: how long the edge makes one wait.
    """

    automaton: int
    source: int
    target: int
    bounds: Tuple[Bound, ...]
    clauses: Tuple[Clause, ...]
    channel: int
    sends: bool
    assignments: Tuple[Tuple[int, int], ...]
    resets: Tuple[int, ...]
    controllable: bool
    duration: int


@dataclass(frozen=True)
class GameAutomaton:
    """An automaton: `invariants[location]` are upper bounds (clock, raw); `edges` are indices into the game's.

    It starts in `initial`, and is in `home` when nothing has begun.
    """

    name: str
    locations: Tuple[str, ...]
    initial: int
    home: int
    invariants: Tuple[Tuple[Tuple[int, int], ...], ...]
    edges: Tuple[int, ...]


@dataclass(frozen=True)
class Game:
    """The game. `delta` is the scaled reaction delay; `max_constants[i]` the largest scaled constant of clock i.

    `goal` and `bad` are pairs (automaton, location), as the objective has them. `edges[k]` is made from `origins[k]`,
    an edge of the network. `start` bounds the clocks at the start (see `start_zone`); empty: they are 0. `unseen` and
    `unseen_clocks`: what cannot matter, indices of automata and, behind them, of variables; and of clocks.
    """

    kind: Kind
    goal: Tuple[Tuple[int, int], ...]
    bad: Tuple[Tuple[int, int], ...]
    scale: int
    delta: int
    clocks: Tuple[str, ...]
    max_constants: Tuple[int, ...]
    variables: Tuple[str, ...]
    initial_values: Tuple[int, ...]
    channels: Tuple[str, ...]
    automata: Tuple[GameAutomaton, ...]
    edges: Tuple[GameEdge, ...]
    origins: Tuple[Edge, ...]
    start: Tuple[Bound, ...] = ()
    unseen: Tuple[int, ...] = ()
    unseen_clocks: Tuple[int, ...] = ()

    def time(self, bound: int) -> Fraction:
        """The constant of a raw bound in time units."""
        return Fraction(constant(bound), self.scale)

    @property
    def dim(self) -> int:
        """The dimension of the zones: the clocks and the constant 0."""
        return len(self.clocks) + 1

    @cached_property
    def leaving(self) -> Tuple[Tuple[Leaving, ...], ...]:
        """The edges that leave each location of each automaton."""
        found: List[List[Tuple[List[int], Dict[int, List[int]]]]] = []
        for automaton in self.automata:
            found.append([([], {}) for _ in automaton.locations])
            for k in automaton.edges:
                edge = self.edges[k]
                senders, receivers = found[-1][edge.source]
                (senders if edge.sends else receivers.setdefault(edge.channel, [])).append(k)
        return tuple(tuple(locations) for locations in found)


@dataclass(frozen=True)
class State:
    """A discrete state: the location of every automaton and the value of every variable."""

    locations: Tuple[int, ...]
    values: Tuple[int, ...]


@dataclass(frozen=True)
class JointMove:
    """A joint move from a discrete state: the edges (sender or tau first), and all that happens.

    `bounds` is the clock guard of all the edges; it says nothing of the target's invariant.

    `changes_nothing`: it leads to the same state again, with all clocks as they were; a command also if it is unseen.
    It is no move to solver and checker: whoever makes it, and however often, nothing has happened. So it makes no
    command stale, and is no way out at the bound of an invariant: nobody keeps time from passing by it.

    `is_unseen`: it changes at most what cannot matter. A strategy for the whole game has to follow such a move of the
    environment, but it is no way out either: without what cannot matter it would be no move.
    """

    edges: Tuple[int, ...]
    target: State
    bounds: Tuple[Bound, ...]
    resets: Tuple[int, ...]
    controllable: bool
    owner: int
    changes_nothing: bool
    is_unseen: bool


def compile_game(
    network: Network, objective: Objective, reaction: Fraction = Fraction(0), part: Optional[Network] = None
) -> Game:
    """The tables of a network and an objective, with a reaction delay in time units.

    `part`: the part of the network that can matter, if that is not all of it.

    Raises PursueError with everything that the game does not support: clock guards on receiving edges, invariants that
    are not upper bounds with <=, unknown names, a start that no clock values satisfy.
    """
    problems: List[Diagnostic] = []
    if reaction < 0:
        problems.append(error("SYN001", f"the reaction delay is {reaction}, expected 0 or more time units"))
    scale = common_denominator([reaction, *network.times])
    tables = _Tables(network, scale, problems)
    goal, bad = tables.positions(objective.goal), tables.positions(objective.bad)
    if objective.kind is not Kind.SAFETY and not objective.goal:
        problems.append(error("SYN002", "the objective names no location to reach"))
    if objective.kind is not Kind.REACH and not objective.bad:
        problems.append(error("SYN003", "the objective names no location to avoid"))
    automata: List[GameAutomaton] = []
    edges: List[GameEdge] = []
    for number, automaton in enumerate(network.automata):
        first = len(edges)
        edges += [tables.edge(number, automaton, edge) for edge in automaton.edges]
        automata.append(tables.automaton(automaton, range(first, len(edges))))
    start = tables.start(network)
    if problems:
        raise PursueError(problems)
    return Game(
        kind=objective.kind,
        goal=goal if objective.kind is not Kind.SAFETY else (),
        bad=bad if objective.kind is not Kind.REACH else (),
        scale=tables.scale,
        delta=int(reaction * tables.scale),
        clocks=network.clocks,
        max_constants=_max_constants(len(network.clocks) + 1, automata, edges),
        variables=tuple(name for name, _ in network.variables),
        initial_values=tuple(value for _, value in network.variables),
        channels=network.channels,
        automata=tuple(automata),
        edges=tuple(edges),
        origins=tuple(edge for automaton in network.automata for edge in automaton.edges),
        start=start,
        unseen=() if part is None else _unseen(network, part),
        unseen_clocks=() if part is None else tuple(_others(network.clocks, part.clocks, 1)),
    )


def _unseen(network: Network, part: Network) -> Tuple[int, ...]:
    """The indices in a discrete state of what the part does not have."""
    automata, some = [a.name for a in network.automata], [a.name for a in part.automata]
    variables, others = [name for name, _ in network.variables], [name for name, _ in part.variables]
    return (*_others(automata, some), *_others(variables, others, len(automata)))


def _others(names: Sequence[str], some: Sequence[str], first: int = 0) -> Iterator[int]:
    return (k for k, name in enumerate(names, first) if name not in some)


class _Tables:
    """Names to indices, with the problems met on the way; an unknown name becomes index 0 and a problem."""

    def __init__(self, network: Network, scale: int, problems: List[Diagnostic]) -> None:
        self.scale = scale
        self._problems = problems
        self._clocks = {name: k + 1 for k, name in enumerate(network.clocks)}
        self._variables = {name: k for k, (name, _) in enumerate(network.variables)}
        self._channels = {name: k for k, name in enumerate(network.channels)}
        self._automata = {automaton.name: k for k, automaton in enumerate(network.automata)}
        self._locations = [_numbers(automaton) for automaton in network.automata]

    def _index(self, names: Mapping[str, int], kind: str, name: str) -> int:
        if name not in names:
            known = ", ".join(names) or "none"
            self._problems.append(error("SYN004", f"unknown {kind} {name!r}; the network has: {known}"))
        return names.get(name, 0)

    def positions(self, places: Sequence[Tuple[str, str]]) -> Tuple[Tuple[int, int], ...]:
        """Pairs (automaton, location) by their names."""
        found: List[Tuple[int, int]] = []
        for name, location in places:
            automaton = self._index(self._automata, "automaton", name)
            if self._locations:
                found.append((automaton, self._index(self._locations[automaton], f"location of {name}", location)))
        return tuple(found)

    def automaton(self, automaton: Automaton, edges: Sequence[int]) -> GameAutomaton:
        """The table of one automaton whose edges have these indices."""
        number = self._automata[automaton.name]
        invariants: List[Tuple[Tuple[int, int], ...]] = []
        for location in automaton.locations:
            for bound in location.invariant:
                if bound.op != "<=":
                    text = f"{bound.clock} {bound.op} {bound.bound}"
                    place = f"{automaton.name}.{location.name}"
                    hint = "write the invariant as an upper bound, clock <= constant"
                    self._problems.append(error("SYN005", f"invariant {text} of {place} is not supported", hint=hint))
            bounds = [self._bounds(bound)[0] for bound in location.invariant]
            invariants.append(tuple((i, bound) for i, _, bound in bounds))
        return GameAutomaton(
            name=automaton.name,
            locations=tuple(location.name for location in automaton.locations),
            initial=self._place(number, automaton.name, automaton.initial),
            home=self._place(number, automaton.name, automaton.home or automaton.initial),
            invariants=tuple(invariants),
            edges=tuple(edges),
        )

    def start(self, network: Network) -> Tuple[Bound, ...]:
        """The bounds on the clocks at the start."""
        bounds = tuple(
            (
                0 if c.left is None else self._index(self._clocks, "clock", c.left),
                0 if c.right is None else self._index(self._clocks, "clock", c.right),
                raw(int(c.bound * self.scale), c.strict),
            )
            for c in network.start
        )
        if Dbm.of(len(network.clocks) + 1, (bound for bound in bounds if bound[0] != bound[1])) is None:
            hint = "give bounds that the clocks can have together, all of them 0 or more"
            self._problems.append(error("SYN008", "no values of the clocks satisfy the bounds at the start", hint=hint))
        return bounds

    def _place(self, number: int, automaton: str, location: str) -> int:
        return self._index(self._locations[number], f"location of {automaton}", location)

    def edge(self, number: int, automaton: Automaton, edge: Edge) -> GameEdge:
        """The table of one edge."""
        locations = self._locations[number]
        receives = edge.sync is not None and not edge.sync.sends
        if receives and edge.guard.clocks:
            place = f"{automaton.name}: {edge.source} -> {edge.target}"
            hint = "put the clock guard on the sending edge"
            self._problems.append(error("SYN006", f"a receiving edge has a clock guard ({place})", hint=hint))
        bounds = tuple(bound for clock in edge.guard.clocks for bound in self._bounds(clock))
        return GameEdge(
            automaton=number,
            source=self._index(locations, f"location of {automaton.name}", edge.source),
            target=self._index(locations, f"location of {automaton.name}", edge.target),
            bounds=bounds,
            clauses=self._clauses(edge.guard),
            channel=NO_CHANNEL if edge.sync is None else self._index(self._channels, "channel", edge.sync.channel),
            sends=not receives,
            assignments=tuple((self._index(self._variables, "variable", name), value) for name, value in edge.assign),
            resets=tuple(self._index(self._clocks, "clock", name) for name in edge.resets),
            controllable=edge.controllable,
            duration=max((-constant(bound) for i, _, bound in bounds if i == 0), default=0),
        )

    def _clauses(self, guard: Guard) -> Tuple[Clause, ...]:
        return tuple(
            tuple((self._index(self._variables, "variable", test.variable), test.value) for test in clause)
            for clause in guard.integers
        )

    def _bounds(self, bound: ClockBound) -> Tuple[Bound, ...]:
        clock, scaled = self._index(self._clocks, "clock", bound.clock), int(bound.bound * self.scale)
        above, below = (clock, 0), (0, clock)
        table: Dict[str, Tuple[Bound, ...]] = {
            "<": ((*above, raw(scaled, True)),),
            "<=": ((*above, raw(scaled, False)),),
            ">": ((*below, raw(-scaled, True)),),
            ">=": ((*below, raw(-scaled, False)),),
            "==": ((*above, raw(scaled, False)), (*below, raw(-scaled, False))),
        }
        if bound.op not in table:
            self._problems.append(
                error("SYN007", f"unknown comparison {bound.op!r}, expected one of {' '.join(table)}")
            )
        return table.get(bound.op, table["<="])


def _numbers(automaton: Automaton) -> Dict[str, int]:
    return {location.name: k for k, location in enumerate(automaton.locations)}


def _max_constants(dim: int, automata: Sequence[GameAutomaton], edges: Sequence[GameEdge]) -> Tuple[int, ...]:
    largest = [0] * dim
    compared = [(i or j, bound) for edge in edges for i, j, bound in edge.bounds]
    compared += [pair for automaton in automata for invariant in automaton.invariants for pair in invariant]
    for clock, bound in compared:
        largest[clock] = max(largest[clock], abs(constant(bound)))
    return tuple(largest)


def initial_state(game: Game) -> State:
    """Where the game starts; for the clocks there see `start_zone`."""
    return State(tuple(automaton.initial for automaton in game.automata), game.initial_values)


def start_zone(game: Game) -> Dbm:
    """The clocks where the game starts."""
    zone = Dbm.of(game.dim, game.start) if game.start else Dbm.zero(game.dim)
    assert zone is not None, "compile_game rejects it"
    return zone


def invariant(game: Game, state: State) -> Tuple[Bound, ...]:
    """The upper bounds that hold as long as the game is in the state."""
    return tuple(
        (clock, 0, bound)
        for automaton, location in zip(game.automata, state.locations)
        for clock, bound in automaton.invariants[location]
    )


def is_goal(game: Game, state: State) -> bool:
    """True if the state is one to reach."""
    return bool(game.goal) and all(state.locations[automaton] == location for automaton, location in game.goal)


def is_bad(game: Game, state: State) -> bool:
    """True if the state is one to avoid."""
    return any(state.locations[automaton] == location for automaton, location in game.bad)


def joint_moves(game: Game, state: State) -> Iterator[JointMove]:
    """The joint moves from a discrete state whose integer guards hold, in the order of system and edges.

    One sending (or tau) edge, and of every other automaton with an enabled receiving edge exactly one of those.
    """
    here = [game.leaving[number][location] for number, location in enumerate(state.locations)]
    for number, (senders, _) in enumerate(here):
        for k in senders:
            edge = game.edges[k]
            if _enabled(edge, state):
                for receivers in product(*_receivers(game, state, here, edge)):
                    yield _joint_move(game, state, number, (k, *receivers))


def _receivers(game: Game, state: State, here: Sequence[Leaving], sender: GameEdge) -> List[List[int]]:
    if sender.channel == NO_CHANNEL:
        return []
    choices = (
        [k for k in receivers.get(sender.channel, ()) if _enabled(game.edges[k], state)]
        for number, (_, receivers) in enumerate(here)
        if number != sender.automaton
    )
    return [edges for edges in choices if edges]


def _enabled(edge: GameEdge, state: State) -> bool:
    """True if the integer guard of an edge from here holds."""
    return all(any(state.values[variable] == value for variable, value in clause) for clause in edge.clauses)


def _joint_move(game: Game, state: State, owner: int, numbers: Tuple[int, ...]) -> JointMove:
    locations, values = list(state.locations), list(state.values)
    edges = [game.edges[k] for k in numbers]
    for edge in edges:
        locations[edge.automaton] = edge.target
        for variable, value in edge.assignments:
            values[variable] = value
    resets = tuple(sorted({clock for edge in edges for clock in edge.resets}))
    controllable = all(edge.controllable for edge in edges)
    before, after = (*state.locations, *state.values), (*locations, *values)
    changed = [k for k, (old, new) in enumerate(zip(before, after)) if old != new]
    is_unseen = all(k in game.unseen for k in changed) and all(x in game.unseen_clocks for x in resets)
    return JointMove(
        edges=numbers,
        target=State(tuple(locations), tuple(values)),
        bounds=tuple(bound for edge in edges for bound in edge.bounds),
        resets=resets,
        controllable=controllable,
        owner=owner,
        changes_nothing=is_unseen if controllable else not (changed or resets),
        is_unseen=is_unseen,
    )
