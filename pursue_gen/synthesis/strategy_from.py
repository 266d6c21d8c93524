"""What an engine found, as a Strategy: names for indices, exact time units, and no bound that another one implies."""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from typing import Deque, Dict, Iterable, List, Sequence, Set, Tuple

from pursue_gen.synthesis.dbm import INF, LE_ZERO, add, constant, is_strict
from pursue_gen.synthesis.game import Action, Game, RawBlock, State, initial_state, is_bad, is_goal, joint_moves
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy, Zone, ZoneKey

Matrix = Tuple[int, ...]


def to_strategy(game: Game, blocks: Iterable[RawBlock]) -> Strategy:
    """The strategy of a game from an engine's blocks, in their order; zones of one action are gathered.

    Each zone's matrix must be canonical (raw bounds, scaled as the game's; INF or more: no bound).
    """
    return Strategy(tuple(_block(game, block) for block in blocks))


def to_ranks(blocks: Iterable[RawBlock], ranks: Iterable[Sequence[int]]) -> Dict[ZoneKey, int]:
    """The ranks of the pieces by where `to_strategy` puts them: (block, "wait" or number of the command, zone)."""
    found: Dict[ZoneKey, int] = {}
    for b, ((_, _, pieces), numbers) in enumerate(zip(blocks, ranks)):
        counts: Dict[Action, int] = {}
        actions: List[Action] = []
        for (_, action), rank in zip(pieces, numbers):
            key = None if action is None else tuple(action)
            if key is not None and key not in counts:
                actions.append(key)
            zone = counts[key] = counts.get(key, -1) + 1
            found[(b, "wait" if key is None else actions.index(key), zone)] = rank
    return found


def followed(game: Game, blocks: Iterable[RawBlock]) -> Tuple[RawBlock, ...]:
    """The blocks of the discrete states that a play by the strategy can come to (clocks are not looked at)."""
    by_state: Dict[State, RawBlock] = {State(tuple(block[0]), tuple(block[1])): block for block in blocks}
    start = initial_state(game)
    met: Set[State] = {start}
    waiting: Deque[State] = deque([start])
    while waiting:
        state = waiting.popleft()
        if is_goal(game, state) or is_bad(game, state) or state not in by_state:
            continue
        commanded = {tuple(action) for _, action in by_state[state][2] if action is not None}
        for move in joint_moves(game, state):
            if move.target not in met and (not move.controllable or move.edges in commanded):
                met.add(move.target)
                waiting.append(move.target)
    return tuple(block for state, block in by_state.items() if state in met)


def _block(game: Game, block: RawBlock) -> Block:
    locations, values, pieces = block
    by_action: Dict[Action, List[Zone]] = {}
    for matrix, action in pieces:
        key = None if action is None else tuple(action)
        by_action.setdefault(key, []).append(zone_text(game, tuple(matrix)))
    state = DiscreteState(
        tuple((automaton.name, automaton.locations[k]) for automaton, k in zip(game.automata, locations)),
        tuple(zip(game.variables, values)),
    )
    commands = (
        Command(tuple(zones), tuple(_move(game, k) for k in action))
        for action, zones in by_action.items()
        if action is not None
    )
    return Block(state, tuple(by_action.get(None, ())), tuple(commands))


def _move(game: Game, edge: int) -> Move:
    return Move(game.automata[game.edges[edge].automaton].name, game.origins[edge])


def zone_text(game: Game, matrix: Matrix) -> Zone:
    """The constraints that make the zone, fewest bounds, in time units; the canonical matrix has the game's scale."""
    names = (None, *game.clocks)
    return tuple(
        Constraint(names[i], names[j], Fraction(constant(bound), game.scale), is_strict(bound))
        for i, j, bound in minimal(game.dim, matrix)
    )


def minimal(dim: int, matrix: Matrix) -> List[Tuple[int, int, int]]:
    """The bounds (i, j, raw) of a canonical matrix that the others, and clocks being >= 0, do not imply.

    Larsen, Larsson, Pettersson and Yi 1997: clocks at fixed differences form a class; each is bound to the first of its
    class, and between the first ones a bound is left out where a way round is as tight.
    """
    first = [min(j for j in range(dim) if _fixed(dim, matrix, i, j)) for i in range(dim)]
    heads = [i for i in range(dim) if first[i] == i]
    kept: List[Tuple[int, int, int]] = []
    for i in range(dim):
        for j in range(dim):
            bound = matrix[i * dim + j]
            if i == j or bound >= INF or (i == 0 and bound == LE_ZERO):
                continue
            if first[i] == first[j]:
                if first[i] in (i, j):
                    kept.append((i, j, bound))
            elif i in heads and j in heads:
                ways = (add(matrix[i * dim + k], matrix[k * dim + j]) for k in heads if k not in (i, j))
                if all(way > bound for way in ways):
                    kept.append((i, j, bound))
    return kept


def _fixed(dim: int, matrix: Matrix, i: int, j: int) -> bool:
    return i == j or add(matrix[i * dim + j], matrix[j * dim + i]) == LE_ZERO
