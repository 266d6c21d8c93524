"""A network and an objective as integer tables: what an engine plays on.

Everything is an index: clocks count from 1 (0 is the constant 0), all else from 0. All bounds are scaled so that they
and the reaction delay are integers: a time t of the network is `t * scale` here. A bound is (i, j, raw), see `dbm`.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.tga.network import Edge, Kind
from pursue_gen.zones.dbm import Dbm, constant

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
    clocks. `duration` is the largest lower bound of the guard: how long the edge makes one wait. `heard`: no move where
    it changes nothing but where its automaton is, and its clocks (see `Sync`).
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
    heard: bool = False


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
    """The game. `delta` is the scaled reaction delay.

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
                    move = _joint_move(game, state, number, (k, *receivers))
                    if not edge.heard or _is_heard(move, edge, state):
                        yield move


def _receivers(game: Game, state: State, here: Sequence[Leaving], sender: GameEdge) -> List[List[int]]:
    if sender.channel == NO_CHANNEL:
        return []
    choices = (
        [k for k in receivers.get(sender.channel, ()) if _enabled(game.edges[k], state)]
        for number, (_, receivers) in enumerate(here)
        if number != sender.automaton
    )
    return [edges for edges in choices if edges]


def _is_heard(move: JointMove, sender: GameEdge, state: State) -> bool:
    """True if the move changes more than where its sender is, and its clocks."""
    moved = {k for k, (old, new) in enumerate(zip(state.locations, move.target.locations)) if old != new}
    more = move.target.values != state.values or not {*move.resets} <= {*sender.resets}
    return more or not moved <= {sender.automaton}


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
