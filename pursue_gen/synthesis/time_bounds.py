"""How long it takes at least to the goal: a lower bound that holds whatever the controller does.

The environment is taken to be lazy: it moves only where an invariant forces it, at the last moment, and commands take
effect as late as the reaction delay allows. Against that the relaxed problem (see `directed`) is solved, with times:
each fact is there as soon as the cheapest edge can give it, and the latest of an edge's needs decides when that is (the
h-max of Bonet and Geffner 2001). The environment may play so, so no strategy guarantees less.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Optional, Set, Tuple

from pursue_gen.synthesis.game import NO_CHANNEL, Game, GameEdge, initial_state, start_zone
from pursue_gen.zones.dbm import INF, constant

Fact = Tuple[str, int, int]
"""("at", automaton, location), ("is", variable, value) or ("heard", channel, 0)."""


@dataclass(frozen=True)
class _Step:
    """An edge in the relaxed problem: when all of the needs (any fact of each) are there, the facts of `gives` come.

    It waits for `wait` if the game starts in its source, and for `dwell` after the source was entered; then comes the
    `delay` of a command.
    """

    source: Fact
    needs: Tuple[FrozenSet[Fact], ...]
    gives: Tuple[Fact, ...]
    wait: int
    dwell: int
    delay: int


def least_time(game: Game) -> Optional[int]:
    """A lower bound for the time to the goal, in scaled time units.

    None: the goal cannot be reached against a lazy environment (or there is none), so the game is lost.
    """
    if game.goal is None:
        return None
    start, goal = initial_state(game), ("at", *game.goal)
    now: Set[Fact] = {("at", k, location) for k, location in enumerate(start.locations)}
    now |= {("is", k, value) for k, value in enumerate(start.values)}
    return _soonest(_steps(game), now, goal)


def _soonest(steps: List[_Step], now: Set[Fact], goal: Fact) -> Optional[int]:
    """When the goal comes: Dijkstra's algorithm over facts. An edge is possible once the last of its needs is met."""
    watchers: Dict[Fact, List[Tuple[int, int]]] = {}
    for k, step in enumerate(steps):
        for position, need in enumerate(step.needs):
            for fact in need:
                watchers.setdefault(fact, []).append((k, position))
    queue = [(0, fact) for fact in sorted(now)]
    times: Dict[Fact, int] = {}
    met: Dict[int, Set[int]] = {}
    while queue:
        time, fact = heapq.heappop(queue)
        if fact in times:
            continue
        if fact == goal:
            return time
        times[fact] = time
        for k, position in watchers.get(fact, ()):
            positions, step = met.setdefault(k, set()), steps[k]
            if position in positions:
                continue
            positions.add(position)
            if len(positions) == len(step.needs):
                ready = step.wait if step.source in now else times[step.source] + step.dwell
                for given in step.gives:
                    heapq.heappush(queue, (max(time, ready) + step.delay, given))
    return None


def _steps(game: Game) -> List[_Step]:
    entering: Dict[Tuple[int, int], List[GameEdge]] = {}
    for edge in game.edges:
        if edge.source != edge.target:  # a loop makes nobody come sooner
            entering.setdefault((edge.automaton, edge.target), []).append(edge)
    # A command that an uncontrollable edge may receive need not be one.
    first = start_zone(game)
    most = [first.m[clock * game.dim] for clock in range(game.dim)]
    unsure = {edge.channel for edge in game.edges if not edge.sends and not edge.controllable}
    steps: List[_Step] = []
    for edge in game.edges:
        bounds = game.automata[edge.automaton].invariants[edge.source]
        forced = edge.sends and not edge.controllable
        if forced and not bounds:
            continue  # nothing ever forces it
        waits = [(j, -constant(bound)) for i, j, bound in edge.bounds if i == 0]
        if forced and len(bounds) == 1:
            waits += [(clock, constant(bound)) for clock, bound in bounds]
        before = entering.get((edge.automaton, edge.source), [])
        dwell = [c for clock, c in waits if all(clock in other.resets for other in before)]
        late = edge.sends and edge.controllable and edge.channel not in unsure
        source, needs, gives = _facts(edge)
        wait = max([0] + [c - constant(most[clock]) for clock, c in waits if most[clock] < INF])
        steps.append(_Step(source, needs, gives, wait, max([0] + dwell), game.delta if late else 0))
    return steps


def _facts(edge: GameEdge) -> Tuple[Fact, Tuple[FrozenSet[Fact], ...], Tuple[Fact, ...]]:
    """The edge's source, what it needs and what it gives."""
    source: Fact = ("at", edge.automaton, edge.source)
    needs: List[FrozenSet[Fact]] = [frozenset({source})]
    needs += [frozenset(("is", variable, value) for variable, value in clause) for clause in edge.clauses]
    gives: List[Fact] = [("at", edge.automaton, edge.target)]
    gives += [("is", variable, value) for variable, value in edge.assignments]
    if not edge.sends:
        needs.append(frozenset({("heard", edge.channel, 0)}))
    elif edge.channel != NO_CHANNEL:
        gives.append(("heard", edge.channel, 0))
    return source, tuple(needs), tuple(gives)
