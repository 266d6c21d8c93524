"""One function in front of the engine: who wins, and with which strategy.

What an engine finds becomes a Strategy: names for indices, exact time units, and no bound that another one implies.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from typing import AbstractSet, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import LimitHit
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.engine import Engine
from pursue_gen.synthesis.engine import Stats as Stats
from pursue_gen.synthesis.game import Action, Bound, Game, RawBlock
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.native import not_held
from pursue_gen.synthesis.native.engine import NativeEngine, core
from pursue_gen.synthesis.overtaking import ended_earlier, without_overtaking
from pursue_gen.synthesis.strategy import (
    Block,
    Command,
    Constraint,
    DiscreteState,
    Move,
    Place,
    Strategy,
    Zone,
    ZoneKey,
)
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.pauses import pauses, with_calls_that_are_heard, without_clocks
from pursue_gen.zones.dbm import constant, is_strict


def _none() -> None:
    """No other strategy."""


@dataclass(frozen=True)
class Verdict:
    """`won`: the controller wins from the initial position; then, and only then, `strategy` says how (not yet checked,
    see `verify`).

    `ranks` (where the engine knows them): per zone of the strategy a number that every step of a reach game lowers.
    `cautious` makes another strategy, in which no command can be overtaken by one of a higher rank, and which has no
    ranks; None where there is none.
    """

    won: bool
    strategy: Optional[Strategy]
    stats: Stats
    ranks: Optional[Mapping[ZoneKey, int]] = None
    cautious: Callable[[], Optional[Strategy]] = _none

    def __post_init__(self) -> None:
        assert self.won == (self.strategy is not None)


NATIVE = NativeEngine()
"""The engine, where no other is given: tests give its readable twin."""


def solve(
    network: Network,
    objective: Objective,
    reaction: Fraction = Fraction(0),
    engine: Engine = NATIVE,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    whole: bool = False,
    soonest: bool = False,
    without_pauses: bool = False,
    first: Optional[int] = None,
) -> Verdict:
    """Who wins the game on the network as it stands (see `tga.ends_reported` for the game with reported ends).

    What cannot matter is left out of the game first, and not named in the strategy (`cone`), unless `whole` is set.
    `soonest`: for a quick strategy, with more work (see `Engine.solve`). `without_pauses`: against an environment that
    takes none (see `tga.pauses`): what is won so is won, and the strategy names the clocks that it leaves out; what is
    lost so may be won. The other way round, a call that only begins a pause makes commands stale, but not those of a
    strategy that leaves its clock out: what is lost with the only pause and without it is lost; where there are
    several, what is lost where such calls are no moves, and between the two nothing is known. `first`: the least work
    for the game as it is, before searches take turns (see `Engine`); None: all that the limits give it, as searches in
    turn would use up more than half of that in vain.

    `reaction` is the delay of a command in time units; `progress` is called a few times a second. Raises PursueError
    for networks that the game does not support, LimitHit at a limit, where the engine does not hold the game, and where
    nothing is known, Unavailable where it was not built.
    """
    game, gone = _compiled(network, objective, reaction, engine, whole, without_pauses)
    start = limits.now()
    outcome = engine.giving_first(limits.work if first is None else first).solve(game, limits, progress, soonest)
    stats = outcome.stats
    if not outcome.won:
        part = cone_of_influence(network, objective)
        heard = part if without_pauses or not reaction else with_calls_that_are_heard(part)
        if heard is part:
            return Verdict(False, None, stats)
        work, alone = stats.work, len(pauses(part)) == 1  # a strategy names that one clock, or leaves it out
        for each, free in ((network, True),) if alone else ((heard, False), (network, True)):
            left = replace(limits.since(start), work=limits.work and max(1, limits.work - work))
            other = solve(each, objective, reaction, engine, left, progress, whole, soonest, free, first)
            work += other.stats.work
            if alone or other.won is free:
                return replace(other, stats=replace(other.stats, work=work))
        message = "no verdict: it is lost to calls that change nothing, but make the robots' commands late"
        hint = "give the limits of time a reaction delay more for each command that is needed"
        raise LimitHit([error("SYN010", message, hint=hint)])
    blocks, ranks = outcome.blocks, outcome.ranks
    cautious: Callable[[], Optional[Strategy]] = _none
    if game.delta and game.goal:
        # Without ranks that hold across states: within one state, what was won later stands later.
        order = tuple(tuple(range(len(pieces))) for _, _, pieces in blocks) if ranks is None else ranks
        blocks, order = without_overtaking(game, blocks, order)
        cautious = partial(_cautious, game, blocks, order, gone)
        ranks = None if ranks is None else order
    known = None if ranks is None else to_ranks(blocks, ranks)
    return Verdict(True, to_strategy(game, blocks, gone), stats, known, cautious)


def guess(
    network: Network,
    objective: Objective,
    reaction: Fraction = Fraction(0),
    engine: Engine = NATIVE,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    whole: bool = False,
    without_pauses: bool = False,
    late: AbstractSet[str] = frozenset(),
    turns: bool = False,
) -> Tuple[Optional[Strategy], Stats]:
    """A strategy for a safety game by a simple policy (see `Engine.guess`), None: none of those that are known wins.

    `late`: the automata of patrols; by one by which these wait until they are due. `turns`: only by one by which robots
    leave their homes in turns. Other arguments, and what it raises, as for `solve`. An engine that does not guess finds
    none.
    """
    game, gone = _compiled(network, objective, reaction, engine, whole, without_pauses)
    outcome = engine.guess(game, limits, progress, late, turns)
    return to_strategy(game, outcome.blocks, gone) if outcome.won else None, outcome.stats


def _compiled(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    engine: Engine,
    whole: bool,
    without_pauses: bool,
) -> Tuple[Game, Tuple[str, ...]]:
    """The game, which the engine holds, and the clocks that it leaves out."""
    game = compile_game(network, objective, reaction)
    part = cone_of_influence(network, objective)
    gone = pauses(part) if without_pauses else ()
    if gone or part is not network:
        part = without_clocks(part, gone)
        game = compile_game(without_clocks(network, gone) if whole else part, objective, reaction, part)
    if not engine.holds(game):
        raise not_held("solver")
    return game, gone


def _cautious(
    game: Game, blocks: Tuple[RawBlock, ...], ranks: Tuple[Tuple[int, ...], ...], gone: Tuple[str, ...]
) -> Optional[Strategy]:
    earlier = ended_earlier(game, blocks, ranks)
    return None if earlier is None else to_strategy(game, earlier, gone)


Matrix = Tuple[int, ...]


@dataclass(frozen=True)
class _Known:
    """Of each automaton its name beside each location; constraints by their bounds, zones by their matrices, moves by
    their edges: few of them stand in very many places."""

    places: Tuple[Tuple[Place, ...], ...] = ()
    constraints: Dict[Bound, Constraint] = field(default_factory=dict)
    zones: Dict[Matrix, Zone] = field(default_factory=dict)
    moves: Dict[Tuple[int, ...], Tuple[Move, ...]] = field(default_factory=dict)


def to_strategy(game: Game, blocks: Iterable[RawBlock], left_out_clocks: Sequence[str] = ()) -> Strategy:
    """The strategy of a game from an engine's blocks, in their order; zones of one action are gathered.

    `left_out_clocks`: those of the network that are not in the game. Each zone's matrix must be canonical (raw bounds,
    scaled as the game's; INF or more: no bound).
    """
    known = _Known(tuple(tuple((a.name, place) for place in a.locations) for a in game.automata))
    named = tuple(_block(game, block, known) for block in blocks)
    return Strategy(named, left_out_clocks=tuple(left_out_clocks))


def to_ranks(blocks: Iterable[RawBlock], ranks: Iterable[Sequence[int]]) -> Dict[ZoneKey, int]:
    """The ranks of the pieces by where `to_strategy` puts them: (block, "wait" or number of the command, zone).

    Requires a rank of each piece of each block.
    """
    found: Dict[ZoneKey, int] = {}
    for b, ((_, _, pieces), numbers) in enumerate(zip(blocks, ranks)):
        assert len(pieces) == len(numbers)
        counts: Dict[Action, int] = {}
        actions: List[Action] = []
        for (_, action), rank in zip(pieces, numbers):
            key = None if action is None else tuple(action)
            if key is not None and key not in counts:
                actions.append(key)
            zone = counts[key] = counts.get(key, -1) + 1
            found[(b, "wait" if key is None else actions.index(key), zone)] = rank
    return found


def _block(game: Game, block: RawBlock, known: _Known) -> Block:
    locations, values, pieces = block
    by_action: Dict[Action, List[Zone]] = {}
    for matrix, action in pieces:
        key = None if action is None else tuple(action)
        by_action.setdefault(key, []).append(zone_text(game, tuple(matrix), known))
    places = tuple([each[k] for each, k in zip(known.places, locations)])
    state = DiscreteState(places, tuple(zip(game.variables, values)))
    commands = (
        Command(tuple(zones), _moves(game, action, known))
        for action, zones in by_action.items()
        if action is not None
    )
    return Block(state, tuple(by_action.get(None, ())), tuple(commands))


def _moves(game: Game, edges: Tuple[int, ...], known: _Known) -> Tuple[Move, ...]:
    found = known.moves.get(edges)
    if found is None:
        named = ((game.automata[game.edges[k].automaton].name, game.origins[k]) for k in edges)
        found = known.moves[edges] = tuple(Move(name, edge) for name, edge in named)
    return found


def zone_text(game: Game, matrix: Matrix, known: Optional[_Known] = None) -> Zone:
    """The constraints that make the zone, fewest bounds, in time units; the canonical matrix has the game's scale."""
    known = known or _Known()
    found = known.zones.get(matrix)
    if found is not None:
        return found
    zone: List[Constraint] = []
    for bound in minimal(game.dim, matrix):
        constraint = known.constraints.get(bound)
        if constraint is None:
            i, j, limit = bound
            names = (None, *game.clocks)
            time = Fraction(constant(limit), game.scale)
            constraint = known.constraints[bound] = Constraint(names[i], names[j], time, is_strict(limit))
        zone.append(constraint)
    result = known.zones[matrix] = tuple(zone)
    return result


def minimal(dim: int, matrix: Matrix) -> List[Bound]:
    """The bounds (i, j, raw) of a matrix that the others, and clocks being >= 0, do not imply. Requires that it is
    canonical, with so many rows."""
    assert len(matrix) == dim * dim
    found: List[Bound] = core().minimal(dim, matrix)
    return found
