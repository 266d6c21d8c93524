"""A strategy for a safety objective without commands that no promise needs, proven like any other.

On a patrol robots wait until a place is due, as late as is won with little work: by a simple policy (see
`Engine.guess`), else in a game in which they set off only for what is due (see `due_moves`). Commands that are given
while no deadline runs are left out: all of them if the strategy still wins, else those of some robots, or half of one
robot's. Then other shares are looked for in which robots drive less (see `shared_again`). Each result has to pass the
checker; otherwise the strategy stays as it is.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Dict, FrozenSet, Iterator, List, Optional, Sequence, Set, Tuple

from pursue_gen.language.network_names import AT_RISK
from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import LIMIT, verify
from pursue_gen.proof.shares import shares_of
from pursue_gen.solving.due_moves import only_due, patrols
from pursue_gen.solving.group_games import without_hidden
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.shared_again import longest_period, shared_again
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.still_play import driven_while_still
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.strategy import Block, DiscreteState, Move, Strategy, with_automata_of
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.watchers import without_watchers

_RESERVES = tuple(Fraction(tenths, 10) for tenths in (1, 2, 3, 4, 6, 10))
"""The parts of a period that a robot has to spare when it sets off for a visit; the first that wins counts."""

_WORK, _STATES = 20_000_000, 20_000
"""The work of all games in which robots set off for what is due, and the discrete states of each. Measured on lab
scenarios 10, 12, 16 and 17, and on battery_watch."""

_SHARE, _POLICIES = 0.3, 0.15
"""The part of what is left that one of them gets, and that all policies of a game get. Measured on lab scenario 13."""

_LOOKS, _BLOCKS, _SYMBOLIC = 12, 20_000, 6_000
"""So many strategies with fewer commands are looked at for a game, which have so many blocks together, with so many
symbolic states each. Measured on EB4."""


_PERIODS, _LESS = 10, 0.9
"""What robots drive is compared in so many of the longest period, and is to be no more than this part of what it was.
Measured on lab scenarios 2, 6 and 27."""


@dataclass(frozen=True)
class _Game:
    """A game to improve: its share's `number` (None: the whole game), its strategy, its automata that are `patrols`."""

    number: Optional[int]
    network: Network
    objective: Objective
    strategy: Strategy
    patrols: FrozenSet[str]


def calm(won: Solution, options: SolveOptions) -> Solution:
    """The solution without moves that no promise needs, as far as little work finds one; the same where there is a
    goal. Within the limits; raises LimitHit at them."""
    if won.objective.reaches or won.strategy.counter or won.strategy.tours or won.strategy.passages:
        return won
    start = options.limits.now()
    won = _quieter(won, options)
    if won.strategy.shares:
        with suppress(LimitHit):  # what is proven stays so
            return _shared_again(won, options.since(start))
    return won


def _shared_again(won: Solution, options: SolveOptions) -> Solution:
    """The solution in other shares, if robots drive less so while nobody else does anything; else the same."""
    start, until = options.limits.now(), _PERIODS * longest_period(won.network, won.objective)
    driven = driven_while_still(won.network, won.strategy, until) if until else None
    if not driven:
        return won
    base, less = without_watchers(won.network, won.strategy.watchers), _LESS * driven
    how = won.reaction, options, until, less
    for strategy in shared_again(base, won.objective, won.strategy, *how):
        other = replace(won, network=with_automata_of(base, strategy), strategy=strategy)
        other = _quieter(other, options.since(start))
        takes = driven_while_still(other.network, other.strategy, until)
        if takes is not None and takes <= less:
            return other
    return won


def _quieter(won: Solution, options: SolveOptions) -> Solution:
    """The solution with the same shares, whose robots set off as late as is won, and only for what is due."""
    start = options.limits.now()
    budget = Budget(replace(options.limits, work=_WORK, states=_STATES), options.progress, options.engine)
    for game in _games(won):
        for fewer in (_put_off, _owed):
            strategy = fewer(game, won.reaction, budget, options.since(start))
            if strategy is None:
                continue
            whole = _with(won.strategy, game, strategy)
            report = verify(won.network, won.objective, whole, won.reaction, LIMIT, limits=options.limits.since(start))
            if report.ok:
                won, game = won.with_strategy(whole), replace(game, strategy=strategy)
    return won


def _games(won: Solution) -> Iterator[_Game]:
    """The game, or those of its shares, as they are played now."""
    strategy, visited = won.strategy, patrols(won.network)
    if not strategy.in_parts:
        yield _Game(None, won.network, won.objective, strategy, visited)
        return
    for part in shares_of(won.network, won.objective, strategy):
        if not part.fault:
            yield _Game(part.stage, part.game, part.objective, part.strategy, visited)


def _with(whole: Strategy, game: _Game, strategy: Strategy) -> Strategy:
    """The whole strategy with this one for the game's share."""
    if game.number is None:
        return strategy
    first = whole.shares[game.number][0]
    own = set(whole.numbers_of(game.number, first))
    others = tuple(block for number, block in enumerate(whole.blocks) if number not in own)
    return replace(whole, blocks=(*others, *without_hidden(strategy).blocks))


def _put_off(game: _Game, reaction: Fraction, budget: Budget, options: SolveOptions) -> Optional[Strategy]:
    """A proven strategy in which patrols wait until they are due; None where none is found, or there is no patrol."""
    late = game.patrols.intersection(name for name, _ in game.objective.bad)
    if budget.used_up or not late:
        return None
    free = bool(game.strategy.left_out_clocks)
    found = budget.guess(game.network, game.objective, reaction, _POLICIES, without_pauses=free, late=late)
    if found is not None:
        with suppress(LimitHit, NotProven):
            return prove(game.network, game.objective, found[0], reaction, options=options, closed=True)
    return _when_due(game, reaction, budget, options)


def _when_due(game: _Game, reaction: Fraction, budget: Budget, options: SolveOptions) -> Optional[Strategy]:
    """A proven strategy by which robots set off for what is due alone; None where none is found, or none of them is on
    a patrol."""
    free = bool(game.strategy.left_out_clocks)
    for reserve in _RESERVES:
        due = only_due(game.network, game.objective, game.patrols, reserve)
        if due is None or budget.used_up:
            return None
        try:
            verdict = budget.verdict(due.network, game.objective, reaction, _SHARE, without_pauses=free)
            if verdict.strategy is not None:
                found = due.in_names_of(verdict.strategy)
                return prove(game.network, game.objective, found, reaction, options=options)
        except (LimitHit, NotProven):
            continue
    return None


_Given = Tuple[DiscreteState, Tuple[Move, ...]]
"""A command, by the state in which it is given."""


def _owed(game: _Game, reaction: Fraction, budget: Budget, options: SolveOptions) -> Optional[Strategy]:
    """The strategy without commands that are given while no deadline runs, as far as it wins without them; None where
    all of them are needed."""
    idle = _idle(game)
    found: Optional[Strategy] = None
    groups, looks = [idle] if idle else [], 0
    most = min(_LOOKS, _BLOCKS // len(game.strategy.blocks)) if idle else 0
    while groups and looks < most:
        some, looks = groups.pop(), looks + 1
        fewer = _without(found or game.strategy, set(some))
        try:
            how = replace(options, progress=None)
            found = prove(game.network, game.objective, fewer, reaction, options=how, states=_SYMBOLIC)
        except (LimitHit, NotProven):
            groups += _smaller(some)
    return found


def _idle(game: _Game) -> List[_Given]:
    """The commands that are given while no deadline runs."""
    owed = {(name, AT_RISK) for name, _ in game.objective.bad}
    blocks = (block for block in game.strategy.blocks if owed.isdisjoint(block.state.locations))
    return [(block.state, command.moves) for block in blocks for command in block.commands]


def _smaller(some: Sequence[_Given]) -> List[List[_Given]]:
    """The commands, split by robot; those of a single robot in two halves."""
    robots: Dict[str, List[_Given]] = {}
    for given in some:
        robots.setdefault(given[1][0].automaton, []).append(given)
    if len(robots) > 1:
        return list(robots.values())
    half = len(some) // 2
    return [list(some[half:]), list(some[:half])] if half else []


def _without(strategy: Strategy, gone: Set[_Given]) -> Strategy:
    """The strategy that waits where it gave these commands."""
    return replace(strategy, blocks=tuple(_waiting(block, gone) for block in strategy.blocks))


def _waiting(block: Block, gone: Set[_Given]) -> Block:
    left_out = [command for command in block.commands if (block.state, command.moves) in gone]
    if not left_out:
        return block
    kept = tuple(command for command in block.commands if command not in left_out)
    return replace(block, wait=(*block.wait, *(zone for c in left_out for zone in c.zones)), commands=kept)
