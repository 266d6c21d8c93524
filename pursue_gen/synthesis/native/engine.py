"""The native engine (C++): game tables in, an outcome out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Callable, ClassVar, Collection, Dict, Optional

from pursue_gen.synthesis.engine import Engine, Outcome, Stats, not_guessed
from pursue_gen.synthesis.game import Game
from pursue_gen.synthesis.limits import NO_LIMITS, NOTHING_YET, Limits, Listener, Progress, limit_reached
from pursue_gen.synthesis.native import not_built

try:
    from pursue_gen.synthesis.native import _core
except ImportError:  # no compiler when the package was installed
    _core = None  # type: ignore[assignment]

_CLOCKS, _NO_BOUND, _VALUES = 127, 1 << 29, 1 << 31
"""The bounds of module.cpp: clocks, raw bounds, values of variables."""


def core() -> Any:
    """The module in C++. Raises Unavailable where it was not built with the package."""
    if _core is None:
        raise not_built("solver")
    return _core


@dataclass(frozen=True)
class NativeEngine(Engine):
    """The engine in C++17, see `module.cpp`.

    `small_budget` is the work, in zones, that a game gets as it is, before searches with few zones or few moves take
    turns: some tenths of a second. 0: they take turns at once; else a reach game goes on as it is while that is cheap.
    """

    name: ClassVar[str] = "native"
    small_budget: float = 5e5

    def holds(self, game: Game) -> bool:
        """True up to 127 clocks, while sums along a path through all clocks stay below 2²⁹, and values in 32 bits."""
        times = [b for _, _, b in game.start]
        times += [b for automaton in game.automata for place in automaton.invariants for _, b in place]
        times += [b for edge in game.edges for _, _, b in edge.bounds]
        values = [*game.initial_values, *(value for edge in game.edges for _, value in edge.assignments)]
        values += [value for edge in game.edges for clause in edge.clauses for _, value in clause]
        largest = max([game.delta, *(abs(b >> 1) + 1 for b in times)])
        path = (len(game.clocks) + 2) * (2 * largest + 2 * game.delta + 2)
        return len(game.clocks) <= _CLOCKS and path < _NO_BOUND and all(-_VALUES <= v < _VALUES for v in values)

    def giving_first(self, work: int) -> NativeEngine:
        """With a larger `small_budget`."""
        return replace(self, small_budget=max(self.small_budget, work))

    def guess(
        self,
        game: Game,
        limits: Limits = NO_LIMITS,
        progress: Optional[Listener] = None,
        late: Collection[str] = (),
        turns: bool = False,
    ) -> Outcome:
        """Try simple policies, see `Engine`."""
        put_off = [k for k, automaton in enumerate(game.automata) if automaton.name in late]
        if game.goal or (late and not put_off):
            return not_guessed(self)
        return self._run(game, limits, progress, partial(core().guess, late=put_off, turns=turns))

    def solve(
        self,
        game: Game,
        limits: Limits = NO_LIMITS,
        progress: Optional[Listener] = None,
        soonest: bool = False,
    ) -> Outcome:
        """Decide the game, see `Engine`."""
        search = partial(core().solve, small_budget=self.small_budget, soonest=soonest)
        return self._run(game, limits, progress, search)

    @staticmethod
    def _run(
        game: Game, limits: Limits, progress: Optional[Listener], search: Callable[..., Dict[str, Any]]
    ) -> Outcome:
        reached = NOTHING_YET

        def report(states: int, waiting: int, seconds: float, memory: int) -> None:
            nonlocal reached
            reached = Progress(states, waiting, seconds, memory)
            if progress is not None:
                progress(reached)

        try:
            most = limits.left, limits.states, limits.memory, limits.work, limits.wall and bool(limits.seconds)
            return _outcome(search(_tables(game), *most, report))
        except _core.LimitReached as limit:
            raise limit_reached(str(limit), limits, reached) from None
        except MemoryError:
            raise limit_reached("memory", limits, reached) from None


def _outcome(result: Dict[str, Any]) -> Outcome:
    counts = (result[count] for count in ("discrete_states", "zones", "seconds", "symbolic_states", "work"))
    return Outcome(result["won"], result["blocks"], result["ranks"], Stats(NativeEngine.name, *counts))


def _tables(game: Game) -> Dict[str, Any]:
    def edge(k: int) -> Dict[str, Any]:
        e = game.edges[k]
        return {
            "id": k,
            "source": e.source,
            "target": e.target,
            "guard": e.bounds,
            "clauses": e.clauses,
            "channel": e.channel,
            "sends": e.sends,
            "heard": e.heard,
            "assign": e.assignments,
            "resets": e.resets,
            "controllable": e.controllable,
        }

    return {
        "kind": game.kind.value,
        "clocks": len(game.clocks),
        "delta": game.delta,
        "variables": list(game.initial_values),
        "start": game.start,
        "unseen": game.unseen,
        "unseen_clocks": game.unseen_clocks,
        "goal": game.goal,
        "bad": game.bad,
        "automata": [
            {
                "initial": automaton.initial,
                "home": automaton.home,
                "invariants": [[(clock, 0, bound) for clock, bound in location] for location in automaton.invariants],
                "edges": [edge(k) for k in automaton.edges],
            }
            for automaton in game.automata
        ],
    }
