"""Random whole scenarios that are won: their missions keep every promise, and to what every statement permits.

Promises and courses are judged from the scenario alone, without the network that solver and run time share.
"""

from __future__ import annotations

import re
from typing import List, Optional, Tuple

from hypothesis import given, settings

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.state import SystemState
from tests.course import Course
from tests.oracle import ENGINES
from tests.whole_stories import stories

TIMES = re.compile(r"\b(?:distance|mobile|duration|takes|\d to|within|every|after|waits) [1-9]\d*\b(?! box)")
"""Numbers that may have decimals, with the words before them."""

LOST = 4
"""The exit status of a game that is lost; other errors here are limits of work."""


class Watched(SimulatedMission):
    """A mission whose steps are taken in the scenario's meaning too, which refuses what it does not permit."""

    course: Course
    seq = 0
    lines: List[str]

    def publish(self, state: SystemState) -> None:
        """A state of the mission."""
        super().publish(state)
        if self.seq == 0 and state.seq == 1:
            self.course.now, self.seq = 0.0, 1
        if state.seq <= self.seq or state.agent not in {**self.course.agents, **self.course.states}:
            self.seq = max(self.seq, state.seq)
            return
        self.seq, agent = state.seq, state.agent
        self.course.now = (self.events.now - 1000.0) / state.unit
        event, here = self.course.events.get(state.event), state.locations[agent]
        assert event is None or self.course.may_begin(agent, event.name), (state.event, agent)
        self.course.take(agent, state.event, here)
        assert {name: state.locations[name] for name in self.course.agents} == self.course.locations


def solved(scenario: Scenario, engine: str = "native", work: int = 100_000) -> Tuple[Optional[Solution], bool]:
    """The proven solution, and whether the game is lost; neither where that takes more work than a test is worth."""
    try:
        return solve_scenario(scenario, DEFAULT, SolveOptions(Limits(work=work), engine=ENGINES[engine])), False
    except PursueError as problem:
        return None, problem.exit_status == LOST


@given(stories(small=True))
@settings(max_examples=8)
def test_missions_of_won_scenarios_keep_what_the_scenario_says(drawn: Tuple[str, Scenario]) -> None:
    keeps(*drawn)


@given(stories(small=True))
@settings(max_examples=6)
def test_so_do_those_with_decimals(drawn: Tuple[str, Scenario]) -> None:
    text = TIMES.sub(lambda found: f"{found.group()}.5", drawn[0])
    keeps(text, parse(text, "story.pur", "story"))


def keeps(text: str, scenario: Scenario) -> None:
    """Fails where a mission of a won scenario breaks a promise, or does what is not permitted."""
    won, lost = solved(scenario)
    if lost:
        assert solved(scenario, "python", 5_000)[0] is None, ("one engine wins it, the other one loses it", text)
    if won is None:
        return
    stage, remaining = stage_of(scenario, won, Options()), Remaining(won)
    for seed in range(2):
        mission = Watched(stage, Settings("mixed", until=80.0), seed, remaining)
        mission.course = Course(scenario)
        ended = mission.run()
        assert ended.end in (GOAL, SAFE), (ended.reason, ended.problems, text)
