"""How long it takes at least to the goal: a lower bound that holds whatever the controller does.

The environment is taken to be lazy: it moves only where an invariant forces it, as late as possible, and commands take
effect as late as the reaction delay allows. Against that the relaxed problem (see `relaxed`) is solved, with
times: each fact holds as soon as the cheapest edge can give it, and the latest of an edge's preconditions decides when
that is (the h-max of Bonet and Geffner 2001). The environment may play so, so no strategy guarantees less.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Optional, Set, Tuple

from pursue_gen.synthesis.game import NO_CHANNEL, Game, GameEdge, initial_state, start_zone
from pursue_gen.zones.dbm import INF, constant

Fact = Tuple[str, int, int]
"""("at", automaton, location), ("is", variable, value) or ("channel", channel, 0)."""


@dataclass(frozen=True)
class _TimedOperator:
    """An edge in the relaxed problem: when all `preconditions` (any fact of each) hold, the facts of `effects` come.

    It waits for `wait` if the game starts in its source, and for `dwell` after the source was entered; then comes the
    `delay` of a command.
    """

    source: Fact
    preconditions: Tuple[FrozenSet[Fact], ...]
    effects: Tuple[Fact, ...]
    wait: int
    dwell: int
    delay: int


def least_time(game: Game) -> Optional[int]:
    """A lower bound for the time to the goal, in scaled time units.

    None: the goal cannot be reached against a lazy environment (or there is none), so the game is lost.
    """
    if not game.goal:
        return None
    start = initial_state(game)
    goals: Set[Fact] = {("at", automaton, location) for automaton, location in game.goal}
    now: Set[Fact] = {("at", k, location) for k, location in enumerate(start.locations)}
    now |= {("is", k, value) for k, value in enumerate(start.values)}
    return _soonest(_timed_operators(game), now, goals)


def _soonest(operators: List[_TimedOperator], now: Set[Fact], goals: Set[Fact]) -> Optional[int]:
    """When the last of the goals comes.

    Dijkstra's algorithm over facts; an edge is possible once all of its preconditions hold.
    """
    watchers: Dict[Fact, List[Tuple[int, int]]] = {}
    for k, operator in enumerate(operators):
        for position, precondition in enumerate(operator.preconditions):
            for fact in precondition:
                watchers.setdefault(fact, []).append((k, position))
    queue = [(0, fact) for fact in sorted(now)]
    times: Dict[Fact, int] = {}
    met: Dict[int, Set[int]] = {}
    while queue:
        time, fact = heapq.heappop(queue)
        if fact in times:
            continue
        times[fact] = time
        if fact in goals and goals.issubset(times):
            return time
        for k, position in watchers.get(fact, ()):
            positions, operator = met.setdefault(k, set()), operators[k]
            if position in positions:
                continue
            positions.add(position)
            if len(positions) == len(operator.preconditions):
                ready = operator.wait if operator.source in now else times[operator.source] + operator.dwell
                for given in operator.effects:
                    heapq.heappush(queue, (max(time, ready) + operator.delay, given))
    return None


def _timed_operators(game: Game) -> List[_TimedOperator]:
    entering: Dict[Tuple[int, int], List[GameEdge]] = {}
    for edge in game.edges:
        if edge.source != edge.target:  # a loop makes no fact come sooner
            entering.setdefault((edge.automaton, edge.target), []).append(edge)
    # A command that an uncontrollable edge may receive need not be one.
    first = start_zone(game)
    most = [first.m[clock * game.dim] for clock in range(game.dim)]
    unsure = {edge.channel for edge in game.edges if not edge.sends and not edge.controllable}
    operators: List[_TimedOperator] = []
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
        source, preconditions, effects = _facts(edge)
        wait = max([0] + [c - constant(most[clock]) for clock, c in waits if most[clock] < INF])
        delay = game.delta if late else 0
        operators.append(_TimedOperator(source, preconditions, effects, wait, max([0] + dwell), delay))
    return operators


def _facts(edge: GameEdge) -> Tuple[Fact, Tuple[FrozenSet[Fact], ...], Tuple[Fact, ...]]:
    """The edge's source, preconditions and effects."""
    source: Fact = ("at", edge.automaton, edge.source)
    preconditions: List[FrozenSet[Fact]] = [frozenset({source})]
    preconditions += [frozenset(("is", variable, value) for variable, value in clause) for clause in edge.clauses]
    effects: List[Fact] = [("at", edge.automaton, edge.target)]
    effects += [("is", variable, value) for variable, value in edge.assignments]
    if not edge.sends:
        preconditions.append(frozenset({("channel", edge.channel, 0)}))
    elif edge.channel != NO_CHANNEL:
        effects.append(("channel", edge.channel, 0))
    return source, tuple(preconditions), tuple(effects)
