"""What an engine found, as a Strategy: names for indices, exact time units, and no bound that another one implies."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

from pursue_gen.synthesis.game import Action, Bound, Game, RawBlock
from pursue_gen.synthesis.native.engine import core
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
from pursue_gen.zones.dbm import constant, is_strict

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
