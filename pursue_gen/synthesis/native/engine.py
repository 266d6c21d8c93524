"""The native engine (`core/`, C++): the same game tables in, the same kind of outcome out as the Python reference."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Tuple

from pursue_gen.synthesis.game import Action, Game, RawBlock
from pursue_gen.synthesis.limits import NO_LIMITS, NOTHING_YET, Limits, Listener, Progress, limit_reached

try:
    from pursue_gen.synthesis.native import _core
except ImportError:  # no compiler when the package was installed: the Python reference serves
    _core = None  # type: ignore[assignment]


def available() -> bool:
    """True if the native engine was built with the package and the game's zones fit it."""
    return _core is not None


@dataclass(frozen=True)
class Outcome:
    """Whether the controller wins, and how: per block the ranks of its pieces (reach: each step leads to lower ranks).

    The pieces of a block are disjoint. `counts`: discrete_states, symbolic_states (zones whose successors were
    computed), zones (of the result), evaluations. `seconds`: what exploring and deciding took.
    """

    won: bool
    blocks: Tuple[RawBlock, ...]
    ranks: Tuple[Tuple[int, ...], ...]
    counts: Mapping[str, int]
    seconds: float


def solve_native(
    game: Game,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    states: int = 0,
    moment: float = 5e5,
) -> Outcome:
    """Decides the game.

    `moment` is the work (pairs of zones looked at) that a safety game gets as it is, before searches with few moves
    take turns: some tenths of a second. `states` (discrete ones, 0 for none) is one more limit; a limit that is hit
    raises PursueError with exit status 5.
    Ctrl-C raises KeyboardInterrupt at once.
    """
    reached = NOTHING_YET

    def told(states: int, waiting: int, seconds: float, memory: int) -> None:
        nonlocal reached
        reached = Progress(states, waiting, seconds, memory)
        if progress is not None:
            progress(reached)

    try:
        result = _core.solve(_tables(game), limits.left, states, limits.memory, told, moment)
    except _core.LimitReached as limit:
        raise limit_reached(str(limit), limits, reached, states) from None
    except MemoryError:
        raise limit_reached("memory", limits, reached) from None
    count = len(game.automata)
    blocks: List[RawBlock] = [
        (tuple(d[:count]), tuple(d[count:]), tuple((_matrix(matrix), _action(edges)) for matrix, edges, _ in pieces))
        for d, pieces in result["states"]
    ]
    ranks = tuple(tuple(rank for _, _, rank in pieces) for _, pieces in result["states"])
    counts = {key: int(result[key]) for key in ("discrete_states", "symbolic_states", "zones", "evaluations")}
    return Outcome(bool(result["won"]), tuple(blocks), ranks, counts, float(result["seconds"]))


def _matrix(bounds: bytes) -> Tuple[int, ...]:
    return tuple(array("i", bounds))


def _action(edges: Any) -> Action:
    return None if edges is None else tuple(edges)


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
