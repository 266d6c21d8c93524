"""Plays of scenarios by their own strategies, and requests for a plan from where such a play has come to."""

from __future__ import annotations

import functools
import random
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Tuple

from pursue_gen.language import load
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.closed_loop import ClosedLoop
from pursue_gen.proof.moves import State
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.zones.dbm import INF, Dbm, constant, is_strict
from tests.oracle.closed_loop import LoopInPython

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"

Request = Dict[str, Any]


@functools.lru_cache(maxsize=None)
def solved(name: str) -> Tuple[Scenario, Solution]:
    """The scenario `scenarios/<name>.pur` and its proven strategy in the default game."""
    scenario = load(SCENARIOS / f"{name}.pur")
    return scenario, solve_scenario(scenario, Rules())


def game_of(scenario: Scenario, **changed: Any) -> Dict[str, Any]:
    """What game.yaml holds."""
    rules = {"ends": "reported", "reaction": 0.1, "slack": {}}
    game = {"format": 1, "name": scenario.name, "scenario": scenario.text, "rules": rules}
    return {**game, "controllers": "distributed", "reach_obj": "dedicated", **changed}


def asked(name: str, state: State, now: Sequence[Fraction], **changed: Any) -> Request:
    """A request from that place."""
    scenario, won = solved(name)
    network = won.network
    request = {
        "format": 1,
        "game": game_of(scenario),
        "locations": dict(zip((automaton.name for automaton in network.automata), state[0])),
        "values": dict(zip((variable for variable, _ in network.variables), state[1])),
        "clocks": {clock: float(value) for clock, value in zip(network.clocks, now)},
        "ahead": 0.0,
        "excused": [],
        "limit": 1200.0,
    }
    return {**request, **changed}


def beginning(name: str, **changed: Any) -> Request:
    """A request from the beginning of the mission, one time unit later (nobody may set off before)."""
    _, won = solved(name)
    network = won.network
    state = tuple(a.initial for a in network.automata), tuple(value for _, value in network.variables)
    return asked(name, state, [Fraction(0)] * len(network.clocks), **{"ahead": 1.0, **changed})


def walk(name: str, seed: int, steps: int) -> Iterator[Tuple[State, Tuple[Fraction, ...]]]:
    """Where a random play by the strategy comes to, after each step."""
    _, won = solved(name)
    loop = LoopInPython(ClosedLoop(won.network, won.objective, won.strategy, won.reaction, None))
    draw = random.Random(f"{name} {seed}")
    state, zone = loop.arena.initial, loop.arena.start
    for _ in range(steps):
        if loop.won(state):
            return
        successors = loop.successors((state, zone))
        if not successors:
            return
        _, (state, zone) = draw.choice(successors)
        point = some_point(zone, draw)
        yield state, tuple(value / loop.arena.scale for value in point)


def some_point(zone: Dbm, draw: random.Random) -> Tuple[Fraction, ...]:
    """One of the zone's points."""
    values: List[Fraction] = [Fraction(0)]
    for i in range(1, zone.dim):
        lows = [(values[j] - constant(zone.m[j * zone.dim + i]), is_strict(zone.m[j * zone.dim + i])) for j in range(i)]
        highs = [
            (values[j] + constant(zone.m[i * zone.dim + j]), is_strict(zone.m[i * zone.dim + j]))
            for j in range(i)
            if zone.m[i * zone.dim + j] < INF
        ]
        low, open_low = max(lows)
        high, open_high = min(highs, key=lambda bound: (bound[0], not bound[1]), default=(low + 50, False))
        places = ([] if open_low else [low]) + ([] if open_high else [high])
        places += [low + (high - low) * Fraction(part, 7) for part in range(1, 7)]
        values.append(draw.choice(places if low < high else [low]))
    return tuple(values[1:])


def busy(locations: Mapping[str, str]) -> Tuple[str, ...]:
    """The agents that are on their way or at work."""
    return tuple(name for name, place in locations.items() if place.startswith(("going_", "doing_")))


def ended(name: str, request: Request, agent: str, at: float) -> Request:
    """The request after the agent has ended what it does, when its clock shows that time."""
    _, won = solved(name)
    automaton = won.network.automaton(agent)
    (edge,) = (
        edge
        for edge in automaton.edges
        if edge.source == request["locations"][agent] and edge.target != edge.source
    )
    passed = at - request["clocks"][won.network.automaton(agent).edges[0].resets[0]]
    clocks = {clock: value + passed for clock, value in request["clocks"].items()}
    locations, values = {**request["locations"], agent: edge.target}, {**request["values"], **dict(edge.assign)}
    heard = [
        (other, move)
        for other in won.network.automata
        for move in other.edges
        if edge.sync and move.sync and move.sync.channel == edge.sync.channel and not move.sync.sends
        and move.source == locations[other.name]
    ]
    for other, move in heard:
        locations[other.name] = move.target
        values.update(move.assign)
        clocks.update((clock, 0.0) for clock in move.resets)
    clocks.update((clock, 0.0) for clock in edge.resets)
    return {**request, "locations": locations, "values": values, "clocks": clocks}
