"""Which move to try first: the first one of a relaxed plan to the goal (delete relaxation, Hoffmann and Nebel 2001).

The relaxed problem: automata that are at a location stay there as well when they move on, variables keep their old
values beside the new ones, clocks do not matter but for how long a guard makes one wait. Its plan is found fast and
says which moves are worth a try; it proves nothing.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import AbstractSet, Dict, FrozenSet, List, Sequence, Set, Tuple

from pursue_gen.synthesis.game import NO_CHANNEL, Game, JointMove, State

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
    cost: int


class RelaxedPlanner:
    """The relaxed problem of one game; made once, for all discrete states."""

    def __init__(self, game: Game) -> None:
        self._game = game
        self._operators = [_operator(game, k) for k in range(len(game.edges))]
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
        goals: List[Fact] = [("at", automaton, location) for automaton, location in self._game.goal]
        achiever, support = self._achievers(state, set(goals))
        plan: Set[int] = set()
        wanted = goals if all(goal in achiever for goal in goals) else []
        while wanted:
            operator = achiever.get(wanted.pop(), -1)
            if operator >= 0 and operator not in plan:
                plan.add(operator)
                wanted += support[operator]
        return plan

    def _achievers(self, state: State, goals: AbstractSet[Fact]) -> Tuple[Dict[Fact, int], Dict[int, List[Fact]]]:
        """The cheapest edge to each fact (-1: it holds), and the facts that made each edge possible.

        Dijkstra's algorithm over facts; an edge is possible once all of its preconditions hold. Stops with the last
        of the goals.
        """
        now: List[Fact] = [("at", k, location) for k, location in enumerate(state.locations)]
        now += [("is", k, value) for k, value in enumerate(state.values)]
        queue: List[Tuple[int, int, Fact]] = [(0, -1, fact) for fact in now]
        heapq.heapify(queue)
        achiever: Dict[Fact, int] = {}
        met: Dict[int, Dict[int, Fact]] = {}
        while queue and not goals <= achiever.keys():
            cost, by, fact = heapq.heappop(queue)
            if fact in achiever:
                continue
            achiever[fact] = by
            for k, position in self._watchers.get(fact, ()):
                preconditions = met.setdefault(k, {})
                if position in preconditions:
                    continue
                preconditions[position] = fact
                operator = self._operators[k]
                if len(preconditions) == len(operator.preconditions):
                    for given in operator.effects:
                        heapq.heappush(queue, (cost + operator.cost, k, given))
        return achiever, {k: list(preconditions.values()) for k, preconditions in met.items()}


def _operator(game: Game, number: int) -> Operator:
    edge = game.edges[number]
    preconditions: List[Precondition] = [frozenset({("at", edge.automaton, edge.source)})]
    preconditions += [frozenset(("is", variable, value) for variable, value in clause) for clause in edge.clauses]
    effects: List[Fact] = [("at", edge.automaton, edge.target)]
    effects += [("is", variable, value) for variable, value in edge.assignments]
    cost = edge.duration + 1
    if not edge.sends:
        preconditions.append(frozenset({("channel", edge.channel, 0)}))
        cost = 0
    elif edge.channel != NO_CHANNEL:
        effects.append(("channel", edge.channel, 0))
    if edge.sends and not edge.controllable and not game.automata[edge.automaton].invariants[edge.source]:
        cost += UNRELIABLE
    return Operator(tuple(preconditions), tuple(effects), cost)
