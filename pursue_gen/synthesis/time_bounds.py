"""How long it takes at least to the goal: a lower bound that holds whatever the controller does.

The environment is taken to be lazy: it moves only where an invariant forces it, as late as possible, and commands take
effect as late as the reaction delay allows. Against that the relaxed problem (see `relaxed`) is solved, with
times: each fact holds as soon as the cheapest edge can give it, and the latest of an edge's preconditions decides when
that is (the h-max of Bonet and Geffner 2001). The environment may play so, so no strategy guarantees less.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Optional, Tuple

from pursue_gen.synthesis.game import Game, GameEdge, initial_state, start_zone
from pursue_gen.synthesis.relaxed import Fact, RelaxedPlanner
from pursue_gen.zones.dbm import INF, constant


class _Timing(NamedTuple):
    """An edge waits for `wait` if the game starts in its source, and for `dwell` after the source was entered; then
    comes the `delay` of a command."""

    wait: int
    dwell: int
    delay: int


def least_time(game: Game) -> Optional[int]:
    """A lower bound for the time to the goal, in scaled time units.

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
