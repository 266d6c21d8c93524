"""Which move to try first: the first step of a relaxed plan to the goal (delete relaxation, Hoffmann and Nebel 2001).

The relaxed problem: automata that are at a location stay there as well when they move on, variables keep their old
values beside the new ones, clocks do not matter but for how long a guard makes one wait. Its plan is found fast and
says which moves are worth a try; it proves nothing.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Sequence, Set, Tuple

from pursue_gen.synthesis.game import NO_CHANNEL, Game, JointMove, State

Fact = Tuple[str, int, int]
"""("at", automaton, location), ("is", variable, value) or ("heard", channel, 0)."""

Need = FrozenSet[Fact]
"""Any of these facts."""

UNRELIABLE = 1 << 40
"""What it costs to count on a move that the environment need not make: more than any plan without such moves."""


@dataclass(frozen=True)
class Step:
    """An edge in the relaxed problem: it needs one fact of each of `needs` and gives the facts of `gives`."""

    needs: Tuple[Need, ...]
    gives: Tuple[Fact, ...]
    cost: int


class RelaxedPlanner:
    """The relaxed problem of one game; made once, asked for every discrete state."""

    def __init__(self, game: Game) -> None:
        self._game = game
        self._steps = [_step(game, k) for k in range(len(game.edges))]
        self._watchers: Dict[Fact, List[Tuple[int, int]]] = {}
        for k, step in enumerate(self._steps):
            for position, need in enumerate(step.needs):
                for fact in need:
                    self._watchers.setdefault(fact, []).append((k, position))

    def choose(self, state: State, moves: Sequence[JointMove]) -> Sequence[JointMove]:
        """Of the controller's moves from the state, those by one edge that a relaxed plan begins with; none: wait."""
        plan = self._plan(state)
        first = [move.edges[0] for move in moves if move.edges[0] in plan]
        if not first:
            return ()
        # The soonest first: a robot that may go now does not wait for a guard of another part of the plan.
        best = min(first, key=lambda k: (self._game.edges[k].duration, k))
        return [move for move in moves if move.edges[0] == best]

    def _plan(self, state: State) -> Set[int]:
        """The edges of a relaxed plan from the state to the goal; empty if there is none."""
        goal = self._game.goal
        if goal is None:
            return set()
        achiever, support = self._achievers(state, ("at", *goal))
        plan: Set[int] = set()
        wanted: List[Fact] = [("at", *goal)]
        while wanted:
            step = achiever.get(wanted.pop(), -1)
            if step >= 0 and step not in plan:
                plan.add(step)
                wanted += support[step]
        return plan

    def _achievers(self, state: State, goal: Fact) -> Tuple[Dict[Fact, int], Dict[int, List[Fact]]]:
        """For each fact the edge that gives it soonest (-1: it holds), for each edge the facts that made it possible.

        Dijkstra's algorithm over facts; an edge is possible once the last of its needs is met. Stops at the goal.
        """
        now: List[Fact] = [("at", k, location) for k, location in enumerate(state.locations)]
        now += [("is", k, value) for k, value in enumerate(state.values)]
        queue: List[Tuple[int, int, Fact]] = [(0, -1, fact) for fact in now]
        heapq.heapify(queue)
        achiever: Dict[Fact, int] = {}
        met: Dict[int, Dict[int, Fact]] = {}
        while queue and goal not in achiever:
            cost, by, fact = heapq.heappop(queue)
            if fact in achiever:
                continue
            achiever[fact] = by
            for k, position in self._watchers.get(fact, ()):
                needs = met.setdefault(k, {})
                if position in needs:
                    continue
                needs[position] = fact
                step = self._steps[k]
                if len(needs) == len(step.needs):
                    for given in step.gives:
                        heapq.heappush(queue, (cost + step.cost, k, given))
        return achiever, {k: list(needs.values()) for k, needs in met.items()}


def _step(game: Game, number: int) -> Step:
    edge = game.edges[number]
    needs: List[Need] = [frozenset({("at", edge.automaton, edge.source)})]
    needs += [frozenset(("is", variable, value) for variable, value in clause) for clause in edge.clauses]
    gives: List[Fact] = [("at", edge.automaton, edge.target)]
    gives += [("is", variable, value) for variable, value in edge.assignments]
    cost = edge.duration + 1
    if not edge.sends:
        needs.append(frozenset({("heard", edge.channel, 0)}))
        cost = 0
    elif edge.channel != NO_CHANNEL:
        gives.append(("heard", edge.channel, 0))
    if edge.sends and not edge.controllable and not game.automata[edge.automaton].invariants[edge.source]:
        cost += UNRELIABLE
    return Step(tuple(needs), tuple(gives), cost)
