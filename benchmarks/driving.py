"""How far robots drive in lab scenarios while nobody else does anything, beside the least that is known for patrols.

That comes of a search: each place of a patrol is for one robot, which goes through its places in some order again and
again, over shortest ways that take as long as they may, and sets off as late as it may. Of all that the best counts.
Robots that stand somewhere for another promise, or have to be able to answer a call, may have to drive more; robots
that help each other might drive less.
"""

from __future__ import annotations

import math
from itertools import product
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

from benchmarks.lab_scenarios import lab_scenario
from pursue_gen.language import parse
from pursue_gen.language.scenario import Patrol, Scenario
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import MissionRunner, case_of
from pursue_gen.workspace import Options

Demands = Tuple[Tuple[str, float], ...]
"""Places, each with the period within which it is visited again."""

Distances = Dict[Tuple[str, str], float]

UNTIL = 1000.0
"""Time units for which a mission is simulated, as `pursue-gen sim` does."""

LEG, REST = 2.0, 1.0
"""Time units that each way takes beside its length at worst, the rest before it included; that rest."""

LIMITS = Limits(seconds=10.0, memory=1024)
"""Within which a scenario has to be won to be counted."""


def driving_measured(count: int) -> Iterator[Dict[str, Any]]:
    """A row for each of the first so many lab scenarios that is won: what is driven in UNTIL time units with everybody
    else standing still, and the least that is known, in units of distance."""
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
    """The least that robots drive to keep the patrols for so long, in units of distance, as far as is known here."""
    patrols = [each for each in scenario.safety if isinstance(each, Patrol)]
    best = math.inf
    known: Dict[Tuple[str, Demands], float] = {}
    for robots in product(*(scenario.on_patrol(patrol) for patrol in patrols)):
        wanted: Dict[str, Dict[str, float]] = {}
        for patrol, robot in zip(patrols, robots):
            periods, place = wanted.setdefault(robot.name, {}), patrol.place.name
            periods[place] = min(float(patrol.known_limit), periods.get(place, math.inf))
        parts = [(name, tuple(sorted(periods.items()))) for name, periods in wanted.items()]
        for part in parts:
            if part not in known:
                known[part] = _alone(scenario, *part, until)
        best = min(best, sum(known[part] for part in parts))
    return best


def _alone(scenario: Scenario, name: str, demands: Demands, until: float) -> float:
    """What one robot drives at least that keeps these periods, by going through the same places again and again."""
    (agent,) = (agent for agent in scenario.agents if agent.name == name)
    ways, times = _shortest(scenario), _shortest(scenario, float(agent.mobile or 0), LEG)
    home, places = agent.location.name, [place for place, _ in demands]
    if len(places) == 1:
        return ways[home, places[0]]
    best = math.inf
    for length in range(len(places), len(places) + (3 if len(places) < 5 else 0) + 1):
        for order in product(places, repeat=length):
            if set(order) == set(places) and all(a != b for a, b in zip(order, (*order[1:], order[0]))):
                best = min(best, _driven(home, order, dict(demands), ways, times, until))
    return best


def _driven(
    home: str, order: Sequence[str], periods: Dict[str, float], ways: Distances, times: Distances, until: float
) -> float:
    """What a robot drives that goes through these places in turn and sets off as late as may be, inf: it would be late.

    It leaves for stop k at `leaves[k]`, at the latest so that it is at the place within its period after it left there,
    and at the stop before in time.
    """
    stops, end = [home], 0.0
    while end < until + max(periods.values()):
        stops.append(order[(len(stops) - 1) % len(order)])
        end += times[stops[-2], stops[-1]]
    last = {home: 0}
    before: List[Optional[int]] = []
    for k, stop in enumerate(stops[1:]):
        before.append(last.get(stop))
        last[stop] = k + 1
    leaves = [math.inf] * len(stops)
    changed = True
    while changed and leaves[0] >= 0:
        changed = False
        for k in (*range(len(before)), *reversed(range(len(before)))):
            takes, visited = times[stops[k], stops[k + 1]], before[k]
            since = 0.0 if visited is None else leaves[visited]
            latest = min(since + periods[stops[k + 1]] - (takes - REST), leaves[k + 1] - takes)
            if latest < leaves[k]:
                leaves[k], changed = latest, True
    if leaves[0] < 0:
        return math.inf
    return sum(ways[stops[k], stops[k + 1]] for k in range(len(before)) if leaves[k] < until)


def _shortest(scenario: Scenario, factor: float = 1.0, more: float = 0.0) -> Distances:
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
