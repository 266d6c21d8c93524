"""One function in front of the engines: who wins, and with which strategy."""

from __future__ import annotations

import time
from dataclasses import dataclass
from fractions import Fraction
from typing import Mapping, Optional

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.synthesis.game import compile_game
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.native import engine as native
from pursue_gen.synthesis.overtaking import without_overtaking
from pursue_gen.synthesis.reference.engine import solve_reference
from pursue_gen.synthesis.strategy import Strategy, ZoneKey
from pursue_gen.synthesis.strategy_from import to_ranks, to_strategy
from pursue_gen.tga.network import Kind, Network, Objective


@dataclass(frozen=True)
class Stats:
    """What it took: the engine (native or python), discrete states, zones of the result, seconds to decide.

    `symbolic_states` are zones whose successors were computed, as other tools count them; 0: not counted.
    """

    engine: str
    discrete_states: int
    zones: int
    seconds: float
    symbolic_states: int = 0


@dataclass(frozen=True)
class Verdict:
    """`won`: the controller wins from the initial position; then `strategy` says how (not yet checked, see `verify`).

    `ranks` (where the engine knows them): per zone of the strategy a number that every step of a reach game lowers.
    """

    won: bool
    strategy: Optional[Strategy]
    stats: Stats
    ranks: Optional[Mapping[ZoneKey, int]] = None


def solve(
    network: Network,
    objective: Objective,
    reaction: Fraction = Fraction(0),
    engine: Optional[str] = None,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
) -> Verdict:
    """Who wins the game on the network as it stands (see `tga.ends_reported` for the game with reported ends).

    `reaction` is the delay of a command in time units, `engine` "native" or "python" (default: native where it was
    built); `progress` is told a few times a second how far it is. Raises PursueError for networks that the game does
    not support, with exit status 5 at a limit, and with 6 where the native engine is asked for and was not built.
    """
    if engine == "native" and not native.available():
        hint = "install a C++17 compiler (Debian: g++ python3-dev) and then pursue-gen again, or use the python engine"
        raise PursueError([error("SYN011", "the native engine was not built", hint=hint)], exit_status=6)
    game = compile_game(network, objective, reaction)
    if engine == "native" or (engine is None and native.available()):
        found = native.solve_native(game, limits, progress)
        won, blocks, numbers = found.won, found.blocks, found.ranks
        counts = found.counts
        stats = Stats(
            "native", counts["discrete_states"], counts["zones"], found.seconds, counts["symbolic_states"]
        )
    else:
        start = time.perf_counter()
        outcome = solve_reference(game, limits=limits, progress=progress)
        won, blocks = outcome.won, outcome.raw_blocks()
        # Not ranks that hold across states, but what was found later in one of them stands later.
        numbers = tuple(tuple(range(len(pieces))) for _, _, pieces in blocks)
        stats = Stats("python", outcome.stats.states, outcome.stats.zones, time.perf_counter() - start)
    if game.delta and game.kind is not Kind.SAFETY:
        blocks, numbers = without_overtaking(game, blocks, numbers)
    ranks = to_ranks(blocks, numbers) if stats.engine == "native" else None
    return Verdict(won, to_strategy(game, blocks) if won else None, stats, ranks)
