"""Network and strategy put together, and the searches through their plays, which are done in C++ (search.hpp)."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Dict, FrozenSet, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Invalid
from pursue_gen.proof import reasons
from pursue_gen.proof.moves import Arena, State, in_words
from pursue_gen.proof.native.tables import Tables, tables_of
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.native import not_held
from pursue_gen.synthesis.strategy import Move, Strategy, ZoneKey
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.scale import common_denominator, least_common_multiple
from pursue_gen.zones.dbm import INF, Dbm

INSTANTS = 4
"""Into so many parts a time unit is cut when instants just after another are explored (see `Rules`). Not measured."""

_UNBOUNDED = 1 << 62
"""How module.cpp writes no bound."""

Entry = Tuple[State, Dbm]
"""A discrete state and the clocks' values just after the step into it."""

Left = Tuple[int, str]
"""The number of an automaton, and the location that it leaves."""


@dataclass(frozen=True)
class Rules:
    """How the strategy is played, in scaled time units.

    `reaction`: the longest delay of a command. `must_end`: waiting has to come to an end (reach), otherwise it may last
    for ever (safety). `instant`: how long after it came into a zone without a first instant a prompt controller (see
    Depth) acts at the latest; 0: before the environment can do anything new.
    """

    reaction: int
    must_end: bool
    instant: int = 0


@dataclass(frozen=True)
class Depth:
    """How a search is done.

    `prompt`: the controller acts before anything that the environment could not do when the command's zone was entered
    becomes possible; otherwise it may act anywhere in the zone on its way. `exact`: zones are not extrapolated; at most
    `limit` symbolic states; so `many` zones of a discrete state become one (0: never).
    """

    prompt: bool
    exact: bool
    limit: int
    many: int = 0


@dataclass(frozen=True)
class Failure:
    """Why a strategy fails, the moves of the play that leads there, the discrete state, and the points of it."""

    reason: str
    play: Tuple[Tuple[Move, ...], ...]
    state: State
    zone: Dbm


@dataclass(frozen=True)
class Found:
    """The outcome of a search: so many symbolic states, the zones of the strategy that plays reach, the failure."""

    states: int
    used: FrozenSet[ZoneKey]
    failure: Optional[Failure]


@dataclass(frozen=True)
class Latest:
    """The largest (scaled) value of a clock at the goal, or where a location is left; None: nothing bounds it, it was
    not found out within the limit, or the strategy `fails` when it is played so. `states`: so many symbolic states
    before the goal were looked at."""

    value: Optional[int]
    fails: bool = False
    states: int = 0


class ClosedLoop:
    """Network and strategy in one time scale, and the searches through them: what one works out serves the next ones.

    Each search raises what the monitor does, PursueError for a strategy that speaks of clocks that the network does not
    have, and LimitHit where clocks or times are too many or too large.
    """

    def __init__(
        self,
        network: Network,
        objective: Objective,
        strategy: Strategy,
        reaction: Fraction,
        ranks: Optional[Mapping[ZoneKey, int]],
        instant: Fraction = Fraction(0),
    ) -> None:
        """`reaction` and `instant` are in time units, 0 or more; with an instant `latest` is of a prompt controller."""
        assert reaction >= 0 and instant >= 0
        scale = least_common_multiple([strategy.scale, common_denominator([reaction, *network.times])])
        scale = least_common_multiple((scale, instant.denominator)) if instant else scale * INSTANTS
        self.arena, self.strategy = Arena(network, scale), strategy
        self.rules = Rules(int(reaction * scale), objective.reaches, int(instant * scale))
        self.goal = _places(network, objective.goal) if objective.reaches else ()
        self.bad = _places(network, objective.bad) if objective.avoids else ()
        self.ranks = ranks if objective.reaches else None

    @property
    def start(self) -> Entry:
        """Where plays begin."""
        return self.arena.initial, self.arena.start

    def everything(self, depth: Depth, monitor: LimitMonitor) -> Found:
        """All that is reachable."""
        return self._found("all", depth, monitor)

    def ends(self, depth: Depth, monitor: LimitMonitor) -> Found:
        """Every play to its end, which has to be the goal."""
        return self._found("ends", depth, monitor)

    def covered(self, monitor: LimitMonitor) -> Optional[Found]:
        """All that a safety strategy covers, at once; None where plays may leave it.

        The strategy is its own certificate then: plays are not followed, but each discrete state is looked at once, as
        if every point for which the strategy says something could be entered.
        """
        result = self._searched("invariant", self.start, Depth(False, False, 0), monitor)
        return None if result["number"] is None else Found(result["number"], self._used(result), None)

    def latest(
        self,
        clock: int,
        limit: int,
        monitor: LimitMonitor,
        left: Optional[Left] = None,
        many: int = 0,
        start: Optional[Entry] = None,
    ) -> Latest:
        """When the goal is reached at the latest, or `left` is, with at most so many symbolic states; `many` as in
        Depth. `start`: from there on. Requires the number of a clock of the network, from 1."""
        assert 0 < clock < self.arena.dim
        depth = Depth(self.rules.instant > 0, False, limit, many)
        result = self._searched("latest", start or self.start, depth, monitor, clock, left)
        return Latest(result["number"], result["fault"] >= 0, result["states"])

    @cached_property
    def _tables(self) -> Tables:
        return tables_of(self.arena.network, self.strategy)

    @cached_property
    def _native(self) -> Any:
        """The loop in C++."""
        tables, rules = self._tables, self.rules
        settings: Dict[str, Any] = {
            "factor": tables.factor(self.arena.scale, max(rules.reaction, rules.instant)),
            "reaction": rules.reaction,
            "must_end": rules.must_end,
            "instant": rules.instant,
            "goal": tables.places(self.goal),
            "bad": tables.places(self.bad),
            "ranks": None if self.ranks is None else tables.numbers(self.ranks, 0),
        }
        return tables.loop(settings)

    def _searched(
        self,
        search: str,
        start: Entry,
        depth: Depth,
        monitor: LimitMonitor,
        clock: int = 0,
        left: Optional[Left] = None,
    ) -> Dict[str, Any]:
        """The result of a search in C++."""
        (locations, values), zone = start
        if any(_UNBOUNDED <= abs(bound) < INF for bound in zone.m):
            raise not_held("checker")
        task = {
            "search": search,
            "state": [n for _, n in self._tables.places(enumerate(locations))] + list(values),
            "zone": [min(bound, _UNBOUNDED) for bound in zone.m],
            "prompt": depth.prompt,
            "exact": depth.exact,
            "limit": depth.limit,
            "many": depth.many,
            "clock": clock,
            "left": self._tables.places(() if left is None else (left,)),
        }
        try:
            result: Dict[str, Any] = self._native.search(task, monitor.check)
        except OverflowError:
            raise not_held("checker") from None
        return result

    def _found(self, search: str, depth: Depth, monitor: LimitMonitor) -> Found:
        """The outcome of a search in C++, with names."""
        result = self._searched(search, self.start, depth, monitor)
        failure = None
        if result["fault"] >= 0:
            step, reason = self._moves(result["step"]), reasons.IN_ORDER[result["fault"]]
            reason = reason.format(in_words(step) if step else depth.limit)
            zone = Dbm(self.arena.dim, tuple(INF if b >= _UNBOUNDED else b for b in result["zone"]))
            failure = Failure(reason, tuple(map(self._moves, result["steps"])), self._state(result["state"]), zone)
        return Found(result["states"], self._used(result), failure)

    def _used(self, result: Mapping[str, Any]) -> FrozenSet[ZoneKey]:
        return frozenset(self._tables.keys(result["used"]))

    def _moves(self, edges: Sequence[int]) -> Tuple[Move, ...]:
        return tuple(self._tables.edges[k] for k in edges)

    def _state(self, numbers: List[int]) -> State:
        automata = self.arena.network.automata
        places = tuple(automaton.locations[n].name for automaton, n in zip(automata, numbers))
        return places, tuple(numbers[len(automata) :])


def _places(network: Network, places: Sequence[Tuple[str, str]]) -> Tuple[Tuple[int, str], ...]:
    """Pairs (automaton, location) with the numbers of the automata."""
    if not places:
        raise Invalid([error("SYN105", "the objective names no goal or no location to avoid")])
    unknown = [".".join(place) for place in places if place not in network.places]
    if unknown:
        raise Invalid([error("SYN105", f"the objective speaks of {unknown[0]}, which the network does not have")])
    numbers = {automaton.name: k for k, automaton in enumerate(network.automata)}
    return tuple((numbers[name], location) for name, location in places)
