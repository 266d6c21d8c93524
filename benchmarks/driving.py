"""How far robots drive in lab scenarios while nobody else does anything, beside what patrols make them drive at least.

In each period of a patrol, or the longest one of several, each place is visited. What their robots drive in it, taken
together, joins the places to at most as many pieces as there are robots, and is no shorter than the least forest of so
many pieces, over shortest ways. One robot alone also goes to and fro between each two of its places. Robots that stand
somewhere for another promise may have to drive more.
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any, Dict, FrozenSet, Iterator, List, Sequence, Tuple

from benchmarks.lab_scenarios import lab_scenario
from pursue_gen.diagnostics import Span
from pursue_gen.language import parse
from pursue_gen.language.scenario import Patrol, Scenario
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.simulation.outcome import Settings
from pursue_gen.simulation.runs import MissionRunner, case_of
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.synthesis.limits import Limits
from pursue_gen.workspace import Options

UNTIL = 200.0
"""Time units for which a mission is simulated."""

LEG = 2.0
"""Time units that each way takes beside its length at worst: its window, and the rest before the next one."""

LIMITS = Limits(seconds=10.0, memory=1024)
"""Within which a scenario has to be won to be counted."""


def driving_measured(count: int) -> Iterator[Dict[str, Any]]:
    """A row for each of the first so many lab scenarios that is won: what is driven in UNTIL time units with everybody
    else standing still, and what is driven at least, in units of distance."""
    for seed in range(count):
        scenario = parse(lab_scenario(seed), f"lab_{seed}.pur", f"lab_{seed}")
        try:
            won = promised_of(scenario, SolveRequest(options=SolveOptions(LIMITS.since(LIMITS.now())))).solution
        except (LimitHit, Lost):
            continue
        case, _ = case_of(scenario, won, Options(), Settings(opponent="still", until=UNTIL))
        outcome = MissionRunner(case).run(1)
        driven = sum(outcome.driven.values())
        yield {"name": f"lab {seed}", "size": seed, "driven": driven, "least": least(scenario, UNTIL)}


def least(scenario: Scenario, until: float) -> float:
    """What the patrols make robots drive at least in so many time units, in units of distance."""
    ways = _shortest(scenario)
    patrols: Dict[Span, List[Patrol]] = {}
    for patrol in scenario.safety:
        if isinstance(patrol, Patrol):
            patrols.setdefault(patrol.span, []).append(patrol)
    bounds: List[Tuple[FrozenSet[str], float]] = []
    for count in range(1, len(patrols) + 1):
        for some in combinations(patrols.values(), count):
            together = [patrol for statement in some for patrol in statement]
            robots = frozenset(agent.name for patrol in together for agent in scenario.on_patrol(patrol))
            places = sorted({patrol.place.name for patrol in together})
            period = float(max(patrol.period for patrol in together))
            bound = math.floor(until / period) * _forest(places, ways, len(robots))
            if len(robots) == 1:
                (speed,) = (float(agent.mobile or 0) for agent in scenario.agents if agent.name in robots)
                times = _shortest(scenario, speed, LEG)
                pairs = combinations(places, 2)
                bound = max([bound, *(_to_and_fro(ways[pair], times[pair] - 1, period, until) for pair in pairs)])
            bounds.append((robots, bound))
    return _largest(bounds, frozenset())


def _to_and_fro(way: float, takes: float, period: float, until: float) -> float:
    """What one robot drives between two places: it is back at one a period after it left, and was at the other
    meanwhile. So it leaves for the other one within the period less the time that one way takes at worst, again and
    again."""
    return 0.0 if takes >= period else way * math.floor(max(0.0, until - takes) / (period - takes))


def _largest(bounds: Sequence[Tuple[FrozenSet[str], float]], taken: FrozenSet[str]) -> float:
    """The largest sum of bounds for robots none of whom is in two of them."""
    free = [(robots, bound + _largest(bounds[k + 1 :], taken | robots))
            for k, (robots, bound) in enumerate(bounds) if not robots & taken]  # fmt: skip
    return max((bound for _, bound in free), default=0.0)


def _forest(places: Sequence[str], ways: Dict[Tuple[str, str], float], pieces: int) -> float:
    """The length of the least forest of so many pieces that has all places (Kruskal's algorithm)."""
    piece = {place: place for place in places}
    length, left = 0.0, len(places)
    for a, b in sorted(combinations(places, 2), key=lambda pair: ways[pair]):
        if left > pieces and piece[a] != piece[b]:
            joined, into = piece[a], piece[b]
            piece.update((place, into) for place in places if piece[place] == joined)
            length, left = length + ways[a, b], left - 1
    return length


def _shortest(scenario: Scenario, factor: float = 1.0, more: float = 0.0) -> Dict[Tuple[str, str], float]:
    """The distances between places, ways taken in both directions and whenever one likes (Floyd's algorithm), each way
    so many times its length and so much more."""
    names = [poi.name for poi in scenario.pois]
    found = {(a, b): 0.0 if a == b else math.inf for a in names for b in names}
    for way in scenario.connections:
        found[way.a, way.b] = found[way.b, way.a] = min(factor * float(way.distance) + more, found[way.a, way.b])
    for via in names:
        for a in names:
            for b in names:
                found[a, b] = min(found[a, b], found[a, via] + found[via, b])
    return found
