"""Objectives: automata that watch, and what the controller wants of them."""

from __future__ import annotations

from typing import List, Mapping, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.language.scenario import Always, Avoid, NeverWith, Reach, Respond, Safety, Scenario
from pursue_gen.tga.conditions import Conditions
from pursue_gen.tga.names import AT_RISK, CLOCK_OBJECTIVE, CLOCK_REACH, IDLE, LOSE, OBJECTIVE, REACH, agent_position
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Kind, Location, Objective, Sync, Test
from pursue_gen.tga.positions import Positions

_START, _UNLOCKED, _WIN = "initial_location", "unlocked", "win"

Happened = Mapping[str, str]
"""From an event's name to the channel that says that it has happened."""


def scenario_objective(scenario: Scenario) -> Objective:
    """What the scenario's controller wants. Raises PursueError where it has no objective."""
    goal, bad = ((REACH, _WIN),), ((OBJECTIVE, LOSE),)
    if scenario.reach and scenario.safety:
        return Objective(Kind.REACH_WHILE_SAFE, goal=goal, bad=bad)
    if scenario.reach:
        return Objective(Kind.REACH, goal=goal)
    if scenario.safety:
        return Objective(Kind.SAFETY, bad=bad)
    message = f"{scenario.name} has no objective"
    raise PursueError([error("TGA012", message, hint="add a line 'objective: …' or 'reach_objective: …'")])


def reach_automaton(reach: Reach, happened: Happened) -> Automaton:
    """`do e after T`: unlocked once T has passed, won when e happens then."""
    unlock = Edge(_START, _UNLOCKED, Guard((ClockBound(CLOCK_REACH, ">", reach.after),)))
    win = Edge(_UNLOCKED, _WIN, sync=Sync(happened[reach.event.name], sends=False))
    return Automaton(REACH, (Location(_START), Location(_UNLOCKED, named=False), Location(_WIN)), _START, (unlock, win))


def safety_automaton(
    safety: Safety, happened: Happened, positions: Positions, conditions: Conditions
) -> Automaton:
    """The automaton that goes to `lose` when the safety objective is broken."""
    locations: Tuple[Location, ...] = (Location(IDLE), Location(LOSE))
    if isinstance(safety, Respond):
        locations += (Location(AT_RISK, (ClockBound(CLOCK_OBJECTIVE, "<=", safety.deadline),)),)
        return Automaton(OBJECTIVE, locations, IDLE, _respond(safety, happened))
    if isinstance(safety, Avoid):
        lose = Edge(IDLE, LOSE, sync=Sync(happened[safety.event.name], sends=False))
        return Automaton(OBJECTIVE, locations, IDLE, (lose,))
    if isinstance(safety, Always):
        broken = conditions.ways_to_hold(safety.broken_if)
        edges = tuple(Edge(IDLE, LOSE, Guard(integers=guard), controllable=False) for guard in broken)
        return Automaton(OBJECTIVE, locations, IDLE, edges)
    return Automaton(OBJECTIVE, locations, IDLE, _never_with(safety, positions))


def _respond(safety: Respond, happened: Happened) -> Tuple[Edge, ...]:
    trigger = Sync(happened[safety.trigger.name], sends=False)
    response = Sync(happened[safety.response.name], sends=False)
    return (
        Edge(IDLE, AT_RISK, sync=trigger, resets=(CLOCK_OBJECTIVE,)),
        Edge(AT_RISK, IDLE, sync=response),
        # The deadline is the invariant of atRisk; this is what remains to do when it is reached.
        Edge(AT_RISK, LOSE),
    )


def _never_with(safety: NeverWith, positions: Positions) -> Tuple[Edge, ...]:
    """The environment may strike whenever both agents share a POI (idle or at work) or a connection, either way.

    Where the objective names a place, that POI alone counts.
    """
    shared: List[Tuple[int, int]] = [(positions.at(poi), positions.doing(poi)) for poi in positions.pois]
    shared += [
        (code, positions.going(b, a))
        for (a, b), code in positions.ways.items()
        if positions.pois[a] < positions.pois[b]
    ]

    if safety.place is not None:
        shared = [(positions.at(safety.place.name), positions.doing(safety.place.name))]

    def among(agent: str, codes: Tuple[int, int]) -> Clause:
        return tuple(Test(agent_position(agent), code) for code in codes)

    return tuple(
        Edge(
            IDLE,
            LOSE,
            Guard(integers=(among(safety.first.name, codes), among(safety.second.name, codes))),
            controllable=False,
        )
        for codes in shared
    )
