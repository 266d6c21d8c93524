"""Which move to try first: the first one of a relaxed plan to the goal (delete relaxation, Hoffmann and Nebel 2001).

The relaxed problem: automata that are at a location stay there as well when they move on, variables keep their old
values beside the new ones, clocks do not matter but for how long a guard makes one wait. Its plan is found fast and
says which moves are worth a try; it proves nothing.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Callable, Dict, FrozenSet, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.synthesis.game import NO_CHANNEL, Game, GameEdge, JointMove, State, initial_state, start_zone
from pursue_gen.zones.dbm import INF, constant

Fact = Tuple[str, int, int]
"""("at", automaton, location), ("is", variable, value) or ("channel", channel, 0)."""

Precondition = FrozenSet[Fact]
"""Any of these facts."""

UNRELIABLE = 1 << 40
"""What it costs to count on a move that the environment need not make: more than any plan without such moves."""


@dataclass(frozen=True)
class Operator:
    """An edge in the relaxed problem: where one fact of each of `preconditions` holds, it adds those of `effects`."""

    preconditions: Tuple[Precondition, ...]
    effects: Tuple[Fact, ...]


class Achieved(NamedTuple):
    """When each fact comes, the edge that gives it (-1: it holds at first), and the facts that made each edge possible.
    """

    times: Mapping[Fact, int]
    by: Mapping[Fact, int]
    support: Mapping[int, Mapping[int, Fact]]


class RelaxedPlanner:
    """The relaxed problem of one game; made once, for all discrete states."""

    def __init__(self, game: Game) -> None:
        self._game = game
        self._operators = [_operator(edge) for edge in game.edges]
        self._costs = [_cost(game, edge) for edge in game.edges]
        self._goals: Set[Fact] = {("at", automaton, location) for automaton, location in game.goal}
        self._watchers: Dict[Fact, List[Tuple[int, int]]] = {}
        for k, operator in enumerate(self._operators):
            for position, precondition in enumerate(operator.preconditions):
                for fact in precondition:
                    self._watchers.setdefault(fact, []).append((k, position))

    def choose(self, state: State, moves: Sequence[JointMove]) -> Sequence[JointMove]:
        """Of the controller's moves from the state, those by one edge that a relaxed plan begins with; none: wait."""
        plan = self.plan(state)
        first = [move.edges[0] for move in moves if move.edges[0] in plan]
        if not first:
            return ()
        # The soonest first: a robot that may go now does not wait for a guard of another part of the plan.
        best = min(first, key=lambda k: (self._game.edges[k].duration, k))
        return [move for move in moves if move.edges[0] == best]

    def plan(self, state: State) -> Set[int]:
        """The edges of a relaxed plan from the state to the goal; empty if there is none."""
        _, by, support = self.achieved(state, lambda k, cost, _: cost + self._costs[k])
        plan: Set[int] = set()
        wanted = [*self._goals] if self._goals <= by.keys() else []
        while wanted:
            operator = by.get(wanted.pop(), -1)
            if operator >= 0 and operator not in plan:
                plan.add(operator)
                wanted += support[operator].values()
        return plan

    def time_to_goal(
        self, state: State, comes: Callable[[int, int, Mapping[Fact, int]], Optional[int]]
    ) -> Optional[int]:
        """When the last location of the goal is come to (see `achieved`); None where one never is. Requires a goal."""
        assert self._goals
        times = self.achieved(state, comes).times
        return max(times[goal] for goal in self._goals) if self._goals <= times.keys() else None

    def achieved(self, state: State, comes: Callable[[int, int, Mapping[Fact, int]], Optional[int]]) -> Achieved:
        """What comes before the last location of the goal, or with it; `comes`: when the effects of an edge do of which
        the last precondition holds from a time on, given the times of all others; None: never.

        Dijkstra's algorithm over facts; an edge is possible once all of its preconditions hold.
        """
        now: List[Fact] = [("at", k, location) for k, location in enumerate(state.locations)]
        now += [("is", k, value) for k, value in enumerate(state.values)]
        queue: List[Tuple[int, int, Fact]] = [(0, -1, fact) for fact in now]
        heapq.heapify(queue)
        times: Dict[Fact, int] = {}
        achiever: Dict[Fact, int] = {}
        met: Dict[int, Dict[int, Fact]] = {}
        while queue and not self._goals <= achiever.keys():
            time, by, fact = heapq.heappop(queue)
            if fact in achiever:
                continue
            times[fact], achiever[fact] = time, by
            for k, position in self._watchers.get(fact, ()):
                preconditions = met.setdefault(k, {})
                if position in preconditions:
                    continue
                preconditions[position] = fact
                if len(preconditions) == len(self._operators[k].preconditions):
                    then = comes(k, time, times)
                    for given in () if then is None else self._operators[k].effects:
                        heapq.heappush(queue, (then or 0, k, given))
        return Achieved(times, achiever, met)


def _operator(edge: GameEdge) -> Operator:
    preconditions: List[Precondition] = [frozenset({("at", edge.automaton, edge.source)})]
    preconditions += [frozenset(("is", variable, value) for variable, value in clause) for clause in edge.clauses]
    effects: List[Fact] = [("at", edge.automaton, edge.target)]
    effects += [("is", variable, value) for variable, value in edge.assignments]
    if not edge.sends:
        preconditions.append(frozenset({("channel", edge.channel, 0)}))
    elif edge.channel != NO_CHANNEL:
        effects.append(("channel", edge.channel, 0))
    return Operator(tuple(preconditions), tuple(effects))


def _cost(game: Game, edge: GameEdge) -> int:
    if not edge.sends:
        return 0
    unreliable = not edge.controllable and not game.automata[edge.automaton].invariants[edge.source]
    return edge.duration + 1 + (UNRELIABLE if unreliable else 0)


class _Timing(NamedTuple):
    """An edge waits for `wait` if the game starts in its source, and for `dwell` after the source was entered; then
    comes the `delay` of a command."""

    wait: int
    dwell: int
    delay: int


def least_time(game: Game) -> Optional[int]:
    """How long it takes at least to the goal, in scaled time units: a lower bound whatever the controller does.

    The environment is taken to be lazy: it moves only where an invariant forces it, as late as possible, and commands
    take effect as late as the reaction delay allows. Against that the relaxed problem is solved, with times: each fact
    holds as soon as the cheapest edge can give it, and the latest of an edge's preconditions decides when that is (the
    h-max of Bonet and Geffner 2001). The environment may play so, so no strategy guarantees less.

    None: the goal cannot be reached against a lazy environment (or there is none), so the game is lost.
    """
    if not game.goal:
        return None
    start, timings = initial_state(game), _timings(game)

    def comes(number: int, time: int, times: Mapping[Fact, int]) -> Optional[int]:
        timing, edge = timings[number], game.edges[number]
        if timing is None:
            return None
        entered = times["at", edge.automaton, edge.source]
        at_first = start.locations[edge.automaton] == edge.source
        return max(time, timing.wait if at_first else entered + timing.dwell) + timing.delay

    return RelaxedPlanner(game).time_to_goal(start, comes)


def _timings(game: Game) -> List[Optional[_Timing]]:
    """The timing of each edge; None for one that nothing ever forces."""
    entering: Dict[Tuple[int, int], List[GameEdge]] = {}
    for edge in game.edges:
        if edge.source != edge.target:  # a loop makes no fact come sooner
            entering.setdefault((edge.automaton, edge.target), []).append(edge)
    # A command that an uncontrollable edge may receive need not be one.
    first = start_zone(game)
    most = [first.m[clock * game.dim] for clock in range(game.dim)]
    unsure = {edge.channel for edge in game.edges if not edge.sends and not edge.controllable}
    timings: List[Optional[_Timing]] = []
    for edge in game.edges:
        bounds = game.automata[edge.automaton].invariants[edge.source]
        forced = edge.sends and not edge.controllable
        waits = [(j, -constant(bound)) for i, j, bound in edge.bounds if i == 0]
        if forced and len(bounds) == 1:
            waits += [(clock, constant(bound)) for clock, bound in bounds]
        before = entering.get((edge.automaton, edge.source), [])
        dwell = [c for clock, c in waits if all(clock in other.resets for other in before)]
        late = edge.sends and edge.controllable and edge.channel not in unsure
        wait = max([0] + [c - constant(most[clock]) for clock, c in waits if most[clock] < INF])
        timing = _Timing(wait, max([0] + dwell), game.delta if late else 0)
        timings.append(None if forced and not bounds else timing)
    return timings
