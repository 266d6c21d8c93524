"""Promises shared out among the robots: each group of robots keeps some of them, in a game of its own.

A promise goes to one robot, or to two where none can keep it alone; robots that have one in common are a group. At
first each group's game is played as if all the others stood still. Then what they are commanded comes into it, as moves
of the environment, where it matters, until nothing changes any more; groups that cannot be played so are joined. Which
robot keeps which promise is tried in turn, those with least to do first, of these the nearest; groups that were found
to clash are not tried again. Whatever wins so wins the game, in which it is
proven (see `proof.shares`); where nothing does, nothing is known.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from itertools import chain, combinations, islice
from typing import Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import verify
from pursue_gen.proof.relaxed_reachability import Commanded, commanded
from pursue_gen.solving.distances import time_to_help
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.efforts import EFFORTS, Effort
from pursue_gen.solving.found import Found, stats_of_all
from pursue_gen.solving.group_games import (
    ALL,
    NEEDED,
    NOBODY,
    PEOPLE,
    PLACES,
    Group,
    GroupGames,
    avoided,
    each_once,
    have,
    without_hidden,
)
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.budget import Budget, TooLarge
from pursue_gen.synthesis.solve import Stats
from pursue_gen.synthesis.strategy import Place, Strategy
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.pauses import pauses
from pursue_gen.tga.watchers import Watcher, watched_by

_WAYS = 30
"""So many ways to share out the promises are tried. Measured on twenty lab scenarios."""

_TIMES = 8
"""So many times each group is looked at again, as the others' commands have changed. Measured on ten large labs."""

_MORE = 5
"""Policies that were tried in vain are tried again with so many times the work: of those that win nine in ten take less
than a twentieth of what they may. Measured on 30 callers, whom eight times left undecided."""

_Game = Tuple[Network, Tuple[Place, ...], Tuple[Watcher, ...], bool]
"""A group's game, what it avoids there, the watchers that it follows, and whether it is played without pauses."""


class Known:
    """Who can do something about a promise, strategies of games, games that are known to be lost, whatever the effort,
    and those that are too large, with how much work policies were tried in vain, and what all of it took."""

    def __init__(self) -> None:
        self.able: Dict[Place, Tuple[str, ...]] = {}
        self.won: Dict[_Game, Strategy] = {}
        self.lost: Set[_Game] = set()
        self.large: List[TooLarge] = []
        self.guessed: Dict[Tuple[Network, Tuple[Place, ...], bool, bool], float] = {}
        self.stats: List[Stats] = []


def can_be_shared(network: Network, objective: Objective) -> bool:
    """True for a safety objective, places to be avoided, that several robots may keep."""
    return not objective.reaches and len(commanded_agents(network)) > 1


def won_in_shares(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    options: SolveOptions,
    efforts: Sequence[Effort] = EFFORTS,
    known: Optional[Known] = None,
) -> Optional[Found]:
    """A proven strategy in shares; None where none is found with so much work, or less if the options say so.

    `known`: what less effort has found, and what this one finds.
    """
    start, left = options.limits.now(), options.limits.work or sum(effort.work for effort in efforts)
    known = Known() if known is None else known
    for effort in efforts:
        work = min(effort.work, left)
        if work < 1 or not (effort.free or pauses(network)):
            continue
        search = SharesSearch(network, objective, reaction, options.since(start), replace(effort, work=work), known)
        with suppress(LimitHit):
            strategy = search.found()
            if strategy is not None:
                return Found(strategy, stats_of_all(known.stats))
        left -= work - max(0, int(search.budget.work))
    return None


class SharesSearch:
    """A search for groups of robots that keep the promises. `known`: what is known from less effort."""

    def __init__(
        self,
        network: Network,
        objective: Objective,
        reaction: Fraction,
        options: SolveOptions,
        effort: Effort,
        known: Optional[Known] = None,
    ) -> None:
        self._network, self._objective, self._reaction = network, objective, reaction
        self._options, self._effort = options, effort
        limits = replace(options.limits, work=effort.work, states=effort.states)
        self._known = Known() if known is None else known
        self.budget = Budget(limits, options.progress, options.engine, whole=True, large=self._known.large)
        names, commands = dict(objective.goal), commanded_agents(network)
        self._robots = tuple(name for name in commands if name not in names)
        self._unlocking = NOBODY.union(commands).difference(self._robots)
        visited = patrols(network)
        self._places = (*objective.bad, *objective.goal)
        self._goal = tuple(place for place in self._places if place[0] in names)
        self._visits = frozenset(place for place in objective.bad if place[0] in visited)
        self._games = GroupGames(network, objective)
        self._tried: Set[_Game] = set()
        self._watched: Dict[Group, Tuple[Watcher, ...]] = {}
        self._alone: Dict[Group, bool] = {}
        self._clashes: List[FrozenSet[Group]] = []

    def found(self, having: Tuple[Group, ...] = ()) -> Optional[Strategy]:
        """The first strategy that is found, by groups of which these have some of the promises; raises LimitHit where
        the budget is used up."""
        had = {*self._goal[1:], *(place for group in having for place in group.places)}
        able = {place: self.able(place) for place in self._places if place not in had}
        if self._objective.reaches and (self._effort.few or self._effort.turns):
            return None
        if self._effort.few:
            return self._by_few(able)
        if self._effort.turns:
            return self._by_policy(self._robots, turns=True)
        order = sorted(able, key=lambda place: len(able[place]))
        turns = range(len(order) + 1) if self._effort.varied else (len(order),)
        ways = chain.from_iterable(self._ways(order, able, having, most) for most in turns)
        for groups in islice(each_once(ways), _WAYS):
            strategy = self.won_by(groups)
            if strategy is not None:
                return strategy
        return None

    def _by_few(self, able: Mapping[Place, Tuple[str, ...]]) -> Optional[Strategy]:
        """A strategy in which half as many robots as promises keep them all, while the others stand still."""
        needed = [place for place in self._objective.bad if not self._is_won(Group(NOBODY, (place,)))]
        few = self._robots[: -(-len(needed) // 2)]
        if not 1 < len(few) < len(self._robots) or any(len(able[place]) < len(self._robots) for place in needed):
            return None
        return self._by_policy(few)

    def _by_policy(self, team: Sequence[str], turns: bool = False) -> Optional[Strategy]:
        """A strategy by which this team keeps all promises, while the others stand still. `turns`: by taking turns."""
        group = Group(frozenset(team), self._objective.bad)
        game = self._games.game(group, frozenset(), NEEDED)
        wanted = Objective(Kind.SAFETY, bad=self._objective.bad)
        strategy = self._guess(game, wanted, 1.0, free=bool(pauses(game)), turns=turns)
        return None if strategy is None else self._proven({group: without_hidden(strategy)})

    def won_by(self, groups: Sequence[Group]) -> Optional[Strategy]:
        """A proven strategy of just these groups, or of some of them together; None where none is found. Raises
        LimitHit where the budget is used up."""
        if self._are_known_to_clash(groups) or not all(map(self._is_won, groups)):
            return None
        return self._together(groups)

    def able(self, place: Place) -> Tuple[str, ...]:
        """The robots that can do something about what is to be avoided there."""
        if place not in self._known.able:
            game = self._games.game(self._having(frozenset(self._robots), place), frozenset())
            names = {automaton.name for automaton in game.automata}
            self._known.able[place] = tuple(name for name in self._robots if name in names)
        return self._known.able[place]

    def _ways(
        self, promises: Sequence[Place], able: Mapping[Place, Tuple[str, ...]], groups: Tuple[Group, ...], turns: int
    ) -> Iterator[Tuple[Group, ...]]:
        """The ways to share out these promises among groups that have some already; each group wins its game alone.

        `turns`: so many promises at most do not go to the first who may keep them.
        """
        if not promises:
            yield groups
            return
        (first, *rest), other = promises, 0
        for team in self._teams(first, able[first], groups):
            if self._are_known_to_clash(groups) or other > turns:
                return
            grown = self._grown(groups, team, first)
            if not self._are_known_to_clash(grown) and self._is_won(grown[-1]):
                yield from self._ways(rest, able, grown, turns - other)
                other = 1

    def _teams(self, promise: Place, able: Sequence[str], groups: Sequence[Group]) -> Iterator[FrozenSet[str]]:
        """Who may keep the promise: nobody, if that is an effort's way; one robot, those with least to do first, of
        these the nearest; two where no one can alone, or where an effort lets two."""
        timed = any(place.invariant for place in self._network.automaton(promise[0]).locations)
        if self._effort.nobody and not timed and self._is_won(self._having(NOBODY, promise)):
            yield NOBODY
        own = {name: [place for group in groups if name in group.team for place in group.places] for name in able}
        rounds = {name: sum(place in self._visits for place in own[name]) * (promise in self._visits) for name in able}
        nearest = sorted(
            able, key=lambda name: (rounds[name], len(own[name]), time_to_help(self._network, name, promise))
        )
        alone = [frozenset([name]) for name in nearest]
        yield from alone or [NOBODY]
        if (self._effort.pairs and not timed) or not any(self._is_won(self._having(team, promise)) for team in alone):
            yield from (frozenset(two) for two in combinations(able, 2))

    def _grown(self, groups: Sequence[Group], team: FrozenSet[str], promise: Place) -> Tuple[Group, ...]:
        """The groups, those of this team joined, with one promise more; that group is the last."""
        met = [group for group in groups if group.team & team]
        return (*(group for group in groups if group not in met), self._joined([*met, self._having(team, promise)]))

    def _having(self, team: FrozenSet[str], promise: Place) -> Group:
        """A group with this promise alone, or that comes to the goal: whoever sees to a part of that, sees to all."""
        if promise in self._goal:
            return Group(team | self._unlocking, self._goal)
        return Group(team, (promise,))

    def _joined(self, groups: Sequence[Group]) -> Group:
        some = {place for group in groups for place in group.places}
        team = NOBODY.union(*(group.team for group in groups))
        return Group(team, tuple(place for place in self._places if place in some))

    def _is_won(self, group: Group) -> bool:
        """True if the group wins its game while the others stand still."""
        if group not in self._alone:
            lost = (other for other, won in self._alone.items() if not won and other.team == group.team)
            hopeless = any(set(other.places) <= set(group.places) for other in lost)
            self._alone[group] = not hopeless and self._strategy(group, frozenset()) is not None
        return self._alone[group]

    def _together(self, groups: Sequence[Group]) -> Optional[Strategy]:
        """A strategy of these groups that is proven, each with the others' commands; None where there is none."""
        won: Dict[Group, Strategy] = {}
        for group in groups:
            strategy = self._strategy(group, frozenset())
            assert strategy is not None
            won[group] = strategy
        joins = {group: frozenset([group]) for group in groups}
        for _ in range(_TIMES):
            before = dict(won)
            for group in before:
                blocks = (block for other, some in before.items() if other != group for block in some.blocks)
                theirs = commanded(blocks)
                strategy = self._strategy(group, theirs)
                if strategy is None:
                    may_join = self._effort.joins or not group.team
                    joined = self._joined_with_some(group, before, theirs) if may_join else None
                    if joined is None:
                        who = self._in_the_way(group, before, theirs, may_join)
                        self._clashes.append(frozenset().union(*(joins[each] for each in (group, *who))))
                        return None
                    met, group, strategy = joined
                    won = {other: some for other, some in before.items() if other not in met}
                    joins[group] = frozenset().union(*(joins[each] for each in met))
                won[group] = strategy
                if group not in before:
                    break
            if all(before.get(group) is strategy for group, strategy in won.items()):
                return self._proven(won)
        return None

    def _are_known_to_clash(self, groups: Sequence[Group]) -> bool:
        return any(have(groups, clash) for clash in self._clashes)

    def _joined_with_some(
        self, group: Group, groups: Mapping[Group, Strategy], theirs: Commanded
    ) -> Optional[Tuple[Sequence[Group], Group, Strategy]]:
        """The group with one of those whose commands come into its game, else with all of them, if that is won against
        the rest: who is joined, the new group, its strategy."""
        met = self._met(group, groups, theirs)
        ways: List[Sequence[Group]] = [(other,) for other in met]
        for some in [*ways, met] if len(met) > 1 else ways:
            joined, rest = self._joined([group, *some]), (g for g in groups if g != group and g not in some)
            strategy = self._strategy(joined, commanded(block for g in rest for block in groups[g].blocks))
            if strategy is not None:
                return [group, *some], joined, strategy
        return None

    def _met(self, group: Group, groups: Iterable[Group], theirs: Commanded) -> Sequence[Group]:
        """The other groups whose commands come into the group's game."""
        named = {automaton.name for automaton in self._games.game(group, theirs).automata}
        return [other for other in groups if other != group and other.team & named]

    def _in_the_way(
        self, group: Group, groups: Mapping[Group, Strategy], theirs: Commanded, may_join: bool
    ) -> Sequence[Group]:
        """One whose commands alone are too much for the group, also if they join, else all that come into its game."""
        met = self._met(group, groups, theirs)
        if len(met) > 1:
            for other in met:
                joined = may_join and self._is_won(self._joined([group, other]))
                if not joined and self._strategy(group, commanded(groups[other].blocks)) is None:
                    return [other]
        return met

    def _proven(self, won: Mapping[Group, Strategy]) -> Optional[Strategy]:
        """The strategies of the groups as one, if it wins the game."""
        some = won.values()
        blocks = tuple(block for strategy in some for block in strategy.blocks)
        clocks = {clock for strategy in some for clock in strategy.left_out_clocks}
        left_out = tuple(clock for clock in self._network.clocks if clock in clocks)
        watchers = tuple(watcher for strategy in some for watcher in strategy.watchers)
        strategy = Strategy(
            blocks,
            left_out_clocks=left_out,
            shares=tuple(avoided(group.places, strategy.watchers) for group, strategy in won.items()),
            watchers=watchers,
        )
        limits = self._options.limits
        report = verify(self._network, self._objective, strategy, self._reaction, limits=limits, closed=True)
        return strategy if report.ok else None

    def _strategy(self, group: Group, theirs: Commanded) -> Optional[Strategy]:
        """A proven strategy of the group's game against these commands of others; None where none is found."""
        watchers = self._watchers(group)
        ways = [(shown, some) for shown in (NEEDED, PEOPLE) for some in dict.fromkeys(((), watchers))]
        ways += [(shown, ()) for shown in (PLACES, ALL)[: 1 + self._effort.thorough]]
        for shown, some in ways:
            game = self._games.game(group, theirs, shown, some)
            key = game, group.places, some, self._effort.free and bool(pauses(game))
            if key not in self._known.won and key not in self._known.lost and key not in self._tried:
                self._tried.add(key)
                strategy = self._solved(key, self._games.wanted(group, some))
                if strategy is not None:
                    self._known.won[key] = replace(strategy, watchers=some)
            if key in self._known.won:
                return self._known.won[key]
        return None

    def _watchers(self, group: Group) -> Tuple[Watcher, ...]:
        """What the group may follow in place of promises that other robots can keep, too."""
        if group not in self._watched:
            team = tuple(name for name in self._robots if name in group.team)
            watchers = (Watcher(name, team) for name, _ in group.places)
            self._watched[group] = tuple(w for w in watchers if watched_by(self._network, w) is not None)
        return self._watched[group]

    def _solved(self, key: _Game, wanted: Objective) -> Optional[Strategy]:
        game, *_, free = key
        single = len(wanted.bad) == 1 or wanted.reaches
        guessed = None if single else self._guessed(game, wanted, free)
        if guessed is not None or len(game.clocks) > self._effort.clocks:
            return guessed
        try:
            share = min(1.0, self._effort.game / max(1, self.budget.work))
            verdict = self.budget.verdict(game, wanted, self._reaction, share, without_pauses=free)
            self._known.stats.append(verdict.stats)
            if verdict.strategy is None:
                self._known.lost.add(key)
                return None
            how = self._reaction, verdict.ranks, self._options
            return without_hidden(prove(game, wanted, verdict.strategy, *how, otherwise=verdict.cautious))
        except (NotProven, LimitHit):
            if self.budget.used_up:
                raise
            return self._guessed(game, wanted, free) if single and not wanted.reaches else None

    def _guessed(self, game: Network, wanted: Objective, free: bool) -> Optional[Strategy]:
        """A guess that is proven."""
        share = min(0.25, self._effort.guess / max(1, self.budget.work))
        strategy = self._guess(game, wanted, share, free)
        if strategy is not None:
            with suppress(NotProven, LimitHit):
                proven = prove(game, wanted, strategy, self._reaction, options=self._options, closed=True)
                return without_hidden(proven)
        return None

    def _guess(
        self, game: Network, wanted: Objective, share: float, free: bool, turns: bool = False
    ) -> Optional[Strategy]:
        key, before = (game, wanted.bad, free, turns), self.budget.work
        if share * before < _MORE * self._known.guessed.get(key, 0):
            return None
        found = self.budget.guess(game, wanted, self._reaction, share, without_pauses=free, turns=turns)
        if found is None:
            used_up = before - self.budget.work >= share * before - 1
            self._known.guessed[key] = share * before if used_up else math.inf
            return None
        strategy, stats = found
        self._known.stats.append(stats)
        return strategy
