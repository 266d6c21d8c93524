"""How long it takes at least to the goal: a lower bound that holds whatever the controller does.

The environment is taken to be lazy: it moves only where an invariant forces it, at the last moment, and commands take
effect as late as the reaction delay allows. Against that the relaxed problem (see `directed`) is solved, with times:
every fact is there as soon as the cheapest edge can give it, the latest of an edge's needs decides (the h-max of
Bonet and Geffner 2001). The real game takes at least as long. Of it follows what is too late: with a deadline on the
clock that counts the play's time, positions from which the bound leads beyond it are lost, and need not be looked at.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.synthesis.dbm import constant, is_strict, raw
from pursue_gen.synthesis.game import NO_CHANNEL, Bound, Game, GameEdge, JointMove, State

Fact = Tuple[str, int, int]
"""("at", automaton, location), ("is", variable, value) or ("heard", channel, 0)."""

Wait = Tuple[int, int]
"""(clock, constant): the edge is taken when the clock is at least there."""


@dataclass(frozen=True)
class _Step:
    """An edge in the relaxed problem: when all of the needs (any fact of each) are there, the facts of `gives` come.

    `waits` bound its time by clocks that run already, `dwell` by when its source was entered; then comes the `delay`.
    """

    edge: int
    source: Fact
    needs: Tuple[FrozenSet[Fact], ...]
    gives: Tuple[Fact, ...]
    waits: Tuple[Wait, ...]
    dwell: int
    delay: int


def deadline(game: Game) -> Optional[Tuple[int, int]]:
    """(clock, bound) where the goal's location has an invariant on a clock that no edge resets: count and deadline."""
    if game.goal is None:
        return None
    reset = {clock for edge in game.edges for clock in edge.resets}
    bounds = game.automata[game.goal[0]].invariants[game.goal[1]]
    never = [(constant(bound), clock) for clock, bound in bounds if clock not in reset and not is_strict(bound)]
    if not never:
        return None
    bound, clock = min(never)
    return clock, bound


@dataclass(frozen=True)
class _Reached:
    """The relaxed problem solved from one state: when each fact comes, by which step (-1: it is there), out of what."""

    times: Mapping[Fact, int]
    by: Mapping[Fact, int]
    support: Mapping[int, Sequence[Fact]]


class LeastTime:
    """The relaxed problem of one game, in its scaled time units; made once, asked for every discrete state."""

    def __init__(self, game: Game) -> None:
        self._game = game
        self._deadline = deadline(game)
        self._goal: Optional[Fact] = None if game.goal is None else ("at", *game.goal)
        self._steps: List[_Step] = []
        self._watchers: Dict[Fact, List[Tuple[int, int]]] = {}
        for step in _steps(game):
            for position, need in enumerate(step.needs):
                for fact in need:
                    self._watchers.setdefault(fact, []).append((len(self._steps), position))
            self._steps.append(step)

    def to_goal(self, state: State, fresh: Set[int]) -> Optional[int]:
        """The least time from the state to the goal; None: the goal cannot be reached against a lazy environment.

        `fresh` are the clocks that are 0 now, all others are taken to be as large as any guard wants them.
        """
        return None if self._goal is None else self._reached(state, fresh).times.get(self._goal)

    def in_time(self, state: State) -> Optional[Tuple[Bound, ...]]:
        """What must hold in the state, if the deadline is still to be kept: bounds; None: it cannot be kept there.

        The empty tuple where the game has no deadline.
        """
        if self._deadline is None:
            return ()
        count, bound = self._deadline
        least = self.to_goal(state, set())
        if least is None or least > bound:
            return None
        bounds: List[Bound] = [(count, 0, raw(bound - least, strict=False))]
        now = _now(state)
        running = {clock for step in self._steps if step.source in now for clock, _ in step.waits} - {count}
        for clock in sorted(running):
            longer = self.to_goal(state, {clock})
            if longer is None:
                return None
            if longer > least:
                bounds.append((count, clock, raw(bound - longer, strict=False)))
        return tuple(bounds)

    def choose(self, state: State, moves: Sequence[JointMove]) -> Sequence[JointMove]:
        """Of the controller's moves from the state, those by the most urgent edge of a relaxed plan; none: wait."""
        latest = self._latest(state)
        urgent = [(latest[move.edges[0]], move.edges[0]) for move in moves if move.edges[0] in latest]
        return [move for move in moves if move.edges[0] == min(urgent)[1]] if urgent else ()

    def _latest(self, state: State) -> Dict[int, int]:
        """The edges of a relaxed plan from the state, with the latest times at which they may be taken."""
        reached = self._reached(state, set())
        if self._goal is None or self._goal not in reached.times:
            return {}
        wanted: Dict[Fact, int] = {self._goal: reached.times[self._goal]}
        latest: Dict[int, int] = {}
        pending = [self._goal]
        while pending:
            fact = pending.pop()
            k = reached.by[fact]
            if k < 0 or latest.get(self._steps[k].edge, wanted[fact] + 1) <= wanted[fact]:
                continue
            step = self._steps[k]
            latest[step.edge] = wanted[fact]
            for need in reached.support[k]:
                by = wanted[fact] - step.delay - (step.dwell if need == step.source else 0)
                if by < wanted.get(need, by + 1):
                    wanted[need] = by
                    pending.append(need)
        return latest

    def _reached(self, state: State, fresh: Set[int]) -> _Reached:
        """Dijkstra's algorithm over facts; an edge is possible once the last of its needs is met. Stops at the goal.

        Of ways that are equally fast it takes one with few steps.
        """
        now = _now(state)
        queue: List[Tuple[int, int, int, Fact]] = [(0, 0, -1, fact) for fact in sorted(now)]
        times: Dict[Fact, int] = {}
        effort: Dict[Fact, int] = {}
        by: Dict[Fact, int] = {}
        met: Dict[int, Dict[int, Fact]] = {}
        while queue and self._goal not in times:
            time, steps, how, fact = heapq.heappop(queue)
            if fact in times:
                continue
            times[fact], effort[fact], by[fact] = time, steps, how
            for k, position in self._watchers.get(fact, ()):
                facts, step = met.setdefault(k, {}), self._steps[k]
                if position in facts:
                    continue
                facts[position] = fact
                if len(facts) == len(step.needs):
                    if step.source in now:
                        ready = max([time] + [c for clock, c in step.waits if clock in fresh])
                    else:
                        ready = max(time, times[step.source] + step.dwell)
                    steps = 1 + sum(effort[need] for need in facts.values())
                    for given in step.gives:
                        if given not in times:
                            heapq.heappush(queue, (ready + step.delay, steps, k, given))
        return _Reached(times, by, {k: tuple(facts.values()) for k, facts in met.items()})


def _now(state: State) -> Set[Fact]:
    facts: Set[Fact] = {("at", k, location) for k, location in enumerate(state.locations)}
    return facts | {("is", k, value) for k, value in enumerate(state.values)}


def _steps(game: Game) -> List[_Step]:
    entering: Dict[Tuple[int, int], List[GameEdge]] = {}
    for edge in game.edges:
        if edge.source != edge.target:  # a loop makes nobody come sooner
            entering.setdefault((edge.automaton, edge.target), []).append(edge)
    shaky = {edge.channel for edge in game.edges if not edge.sends and not edge.controllable}
    result: List[_Step] = []
    for number, edge in enumerate(game.edges):
        bounds = game.automata[edge.automaton].invariants[edge.source]
        if edge.sends and not edge.controllable and not bounds:
            continue  # nothing ever forces it
        waits: List[Wait] = [(j, -constant(bound)) for i, j, bound in edge.bounds if i == 0 and constant(bound) < 0]
        if edge.sends and not edge.controllable and len(bounds) == 1:
            waits += [(clock, constant(bound)) for clock, bound in bounds]
        before = entering.get((edge.automaton, edge.source), [])
        dwell = max([0] + [c for clock, c in waits if all(clock in other.resets for other in before)])
        source: Fact = ("at", edge.automaton, edge.source)
        needs: List[FrozenSet[Fact]] = [frozenset({source})]
        needs += [frozenset(("is", variable, value) for variable, value in clause) for clause in edge.clauses]
        gives: List[Fact] = [("at", edge.automaton, edge.target)]
        gives += [("is", variable, value) for variable, value in edge.assignments]
        if not edge.sends:
            needs.append(frozenset({("heard", edge.channel, 0)}))
        elif edge.channel != NO_CHANNEL:
            gives.append(("heard", edge.channel, 0))
        commanded = edge.sends and edge.controllable and edge.channel not in shaky
        delay = game.delta if commanded else 0
        result.append(_Step(number, source, tuple(needs), tuple(gives), tuple(waits), dwell, delay))
    return result
