"""A restarted observer of a simulated mission hears what was reported while it was away, as one on robots does."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.faults import Crash
from pursue_gen.tools.simulation.mission import START, SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_runtime.locations import is_under_way
from pursue_runtime.observer import returning
from pursue_runtime.state import SystemState
from tests.tools.simulation.stages import stage

FETCH = """\
poi "desk"
poi "shelf"
connect desk and shelf distance 10
event "fetch" location shelf duration 1
agent "bot" controllable mobile 1 location desk can_do fetch
reach_objective: do fetch within 20
"""


@pytest.fixture(scope="module")
def fetching() -> Stage:
    """A robot that has to fetch something by a deadline."""
    scenario = parse(FETCH, "fetch.pur", "fetch")
    return stage_of(scenario, solve_scenario(scenario, DEFAULT), Options())


class Away(SimulatedMission):
    """A mission whose observer dies as a robot reports the end of its `nth` movement or action, for some seconds."""

    nth, seconds = 1, 4.0

    def __init__(self, on: Stage, seed: int, nth: int = 1, faults: Tuple[str, ...] = ("deaths",)) -> None:
        super().__init__(on, Settings("random", faults), seed, None, record=True)
        self.fault_plan.crashes.clear()
        self.nth = nth
        self.reported: List[Tuple[str, float]] = []
        self.states: List[SystemState] = []

    def _report(self, agent: str, text: str) -> None:
        if "_order_" not in text:
            self.reported.append((agent, self.events.now))
            if len(self.reported) == self.nth:
                self._crash(Crash(0.0, "observer", self.seconds))
        super()._report(agent, text)

    def publish(self, state: SystemState) -> None:
        self.states.append(state)
        super().publish(state)

    def ended(self) -> SystemState:
        """The state that shows what was reported as the observer died."""
        agent, moment = self.reported[self.nth - 1]
        return next(state for state in self.states if state.agent == agent and state.stamp >= moment - 1e-6)


@pytest.mark.parametrize("nth", [1, 2, 4])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_report_counts_at_the_time_at_which_it_became_true(seed: int, nth: int) -> None:
    mission = Away(stage("thesis/scenario_1"), seed, nth)
    outcome = mission.run()
    assert outcome.problems == ()
    assert mission.ended().stamp == pytest.approx(mission.reported[nth - 1][1], abs=1e-5)
    assert mission.events.now >= mission.reported[nth - 1][1] + Away.seconds


def test_the_judge_notices_a_report_that_counts_when_it_is_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(returning, "said_at", lambda text: None)
    mission = Away(stage("thesis/scenario_1"), 1)
    assert any("state 5 is of" in problem for problem in mission.run().problems)


@pytest.mark.parametrize("seed", range(1, 6))
def test_no_deadline_passes_before_it_has_heard_what_was_reported_in_time(fetching: Stage, seed: int) -> None:
    """The book is fetched in time, while there is no observer; it is back after the deadline."""
    mission = Away(fetching, seed, nth=2)
    mission.seconds = 30.0
    outcome = mission.run()
    assert (outcome.end, outcome.problems) == (GOAL, ())
    assert outcome.time == pytest.approx(mission.reported[1][1] - START, abs=1e-5)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_command_comes_again_to_an_observer_that_has_returned(seed: int) -> None:
    mission = Away(stage("thesis/scenario_1"), seed)
    mission.run()
    back = mission.reported[0][1] + Away.seconds
    commanded = [state.stamp for state in mission.states if is_under_way(state.locations[state.agent or "bot1"])]
    assert any(back <= stamp <= back + 0.3 for stamp in commanded)
