"""Promises shared out again so that robots drive less while nobody else does anything.

Shares are looked for until some win (see `shares`): who has to see to two places then goes to and fro, though another
robot could stand at one of them. So what the promises of each way to share them out cost while all is still is
estimated: a robot on a patrol goes round its places, as late as may be. Ways that may cost less are tried, the least
first.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from itertools import combinations, permutations, product
from math import inf, prod
from typing import Dict, FrozenSet, Iterable, Iterator, List, Sequence, Tuple

from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.distances import times_to
from pursue_gen.solving.due_moves import Duty, duties, patrols
from pursue_gen.solving.efforts import Effort
from pursue_gen.solving.group_games import NOBODY, Group
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.shares import SharesSearch
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.strategy import Place, Strategy
from pursue_gen.tga.network import Network, Objective

_EFFORT = Effort(10_000_000, game=700_000, guess=100_000, states=6_000)
"""How hard the games of these shares are tried. Measured on lab scenarios 6 and 27, and on a care home with two
robots."""

_WAYS, _ROUND = 5_000, 5
"""Of so many ways to share out promises at most the cost is estimated, and rounds of so many places. Not measured."""

Team = FrozenSet[str]


def shared_again(
    network: Network, objective: Objective, strategy: Strategy, reaction: Fraction, options: SolveOptions,
    until: float, driven: float,
) -> Iterator[Strategy]:  # fmt: skip
    """Proven strategies in other shares than these, for robots that may drive less than `driven` time units of the
    first `until`, while nobody else does anything; as far as little work finds some. `network`: without watchers."""
    now = tuple(_groups(network, objective, strategy))
    search = SharesSearch(network, objective, reaction, options, _EFFORT)
    # All places count as seen at the start.
    costs = _StillCosts(network, objective, until - longest_period(network, objective))
    ways = [(*costs.of(groups), number, groups) for number, groups in enumerate(_ways(now, search, objective))]
    with suppress(LimitHit):
        for cost, more, _, groups in sorted(ways, key=lambda way: way[:3]):
            found = search.won_by(groups) if cost < driven and (cost, more) < costs.of(now) else None
            if found is not None:
                yield found


def longest_period(network: Network, objective: Objective) -> float:
    """The longest period of a patrol among the promises; 0: there is none."""
    known = duties(network, objective, patrols(network))
    return max((float(duty.deadline) for duty in known if duty.visits), default=0.0)


def _groups(network: Network, objective: Objective, strategy: Strategy) -> Iterator[Group]:
    """The groups that play these shares."""
    robots = commanded_agents(network)
    for number, avoided in enumerate(strategy.shares):
        team = strategy.commanded_by(number).intersection(robots)
        yield Group(team, tuple(place for place in objective.bad if place in avoided))


def _ways(now: Sequence[Group], search: SharesSearch, objective: Objective) -> Iterator[Tuple[Group, ...]]:
    """Other ways to share the promises out: each of one robot for any, those of several for as many others."""
    units: List[Tuple[Tuple[Place, ...], List[Team]]] = []
    for group in now:
        size = len(group.team)
        for bad in [group.places] if size > 1 else [(place,) for place in group.places]:
            able = [frozenset(search.able(place)) for place in bad]
            robots = sorted(frozenset().union(*able))
            teams = [team for team in map(frozenset, combinations(robots, size)) if all(team & who for who in able)]
            units.append((bad, teams if size else [NOBODY]))
    if prod(len(teams) for _, teams in units) > _WAYS:
        return
    for chosen in product(*(teams for _, teams in units)):
        groups: List[Group] = []
        for team, (bad, _) in zip(chosen, units):
            met = [group for group in groups if group.team & team]
            groups = [group for group in groups if group not in met]
            places = {*bad, *(place for group in met for place in group.places)}
            groups.append(Group(team.union(*(g.team for g in met)), tuple(p for p in objective.bad if p in places)))
        yield tuple(groups)


class _StillCosts:
    """About how long robots drive in so much time to keep promises while nobody else does anything."""

    def __init__(self, network: Network, objective: Objective, until: float) -> None:
        self._until = until
        known = duties(network, objective, patrols(network))
        self._duties = {duty.name: duty for duty in known if duty.visits}
        self._network = network
        self._known: Dict[Tuple[str, Tuple[str, ...]], float] = {}

    def of(self, groups: Iterable[Group]) -> Tuple[float, float]:
        """Of all these groups together; and how much else there is to do for those who drive."""
        costs = [(self._of_group(group), len(group.places)) for group in groups]
        return sum(cost for cost, _ in costs), sum(cost * promises for cost, promises in costs)

    def _of_group(self, group: Group) -> float:
        visits = [self._duties[name] for name, _ in group.places if name in self._duties]
        able = [sorted(group.team.intersection(duty.visits)) for duty in visits]
        best = inf
        for who in product(*able):
            mine: Dict[str, Tuple[Duty, ...]] = {}
            for robot, duty in zip(who, visits):
                mine[robot] = (*mine.get(robot, ()), duty)
            best = min(best, sum(self._of_robot(robot, own) for robot, own in mine.items()))
        return best

    def _of_robot(self, robot: str, own: Tuple[Duty, ...]) -> float:
        key = robot, tuple(duty.name for duty in own)
        if key not in self._known:
            automaton = self._network.automaton(robot)
            places = [duty.visits[robot] for duty in own]
            far = [[times_to(place, automaton, rests) for place in places] for rests in (True, False)]
            times, ways = ([[float(to.get(a[0], inf)) for to in some] for a in places] for some in far)
            self._known[key] = self._until * share_on_ways(times, ways, [float(duty.deadline) for duty in own])
        return self._known[key]


def share_on_ways(
    times: Sequence[Sequence[float]], ways: Sequence[Sequence[float]], periods: Sequence[float]
) -> float:
    """The part of its time for which a robot is on its way that goes round places, each again within its period after
    it was left, and waits as long as it may; infinite where it would be late, 0 for a single place and where there are
    many. From each place to each `ways` take so long, and `times` with rests."""
    if not 1 < len(periods) <= _ROUND:
        return 0.0
    best, (first, *others) = inf, range(len(periods))
    for order in permutations(others):
        legs = list(zip((first, *order), (*order, first)))
        length = sum(times[a][b] for a, b in legs)
        if length <= min(periods):
            between = [(a, c, b) for c, _ in legs for a, b in legs if c not in (a, b)]
            passed = {c for a, c, b in between if times[a][c] + times[c][b] <= times[a][b]}
            once = sorted(period for k, period in enumerate(periods) if k not in passed)
            # Each place is without its robot for no longer than its period, and the robot waits at one place at a time.
            lasts = min(((sum(once[:k]) - length) / (k - 1) for k in range(2, len(once) + 1)), default=inf)
            best = min(best, sum(ways[a][b] for a, b in legs) / lasts)
    return best
