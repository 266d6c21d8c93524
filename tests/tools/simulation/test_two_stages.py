"""Missions by a strategy whose first stage does not name the visitor, judged as all missions are."""

from __future__ import annotations

import functools
from typing import Any, List

import pytest

from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, HELD, Settings
from pursue_gen.tools.simulation.recorder import Recorder
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import STOPPED
from tests.two_stages import solved_in_stages


@functools.lru_cache(maxsize=None)
def stage() -> Stage:
    scenario, won = solved_in_stages()
    return stage_of(scenario, won, Options(reaction=won.reaction))


@functools.lru_cache(maxsize=None)
def outcomes(*faults: str) -> Any:
    return [simulate_mission(stage(), Settings("random", faults), seed) for seed in range(25)]


def test_every_mission_reaches_the_goal() -> None:
    assert {outcome.end for outcome in outcomes()} == {GOAL}, [o.reason for o in outcomes() if o.end != GOAL][:3]


@pytest.mark.parametrize("kind", ["delay", "loss", "restart", "deaths", "late"])
def test_with_faults_missions_reach_the_goal_or_stop_safely(kind: str) -> None:
    found = outcomes(kind)
    assert {outcome.end for outcome in found} <= {GOAL, HELD, STOPPED}, [outcome.reason for outcome in found]


class Judged:
    """A mission by hand, and what is held against it."""

    def __init__(self) -> None:
        on = stage()
        self.mission = Mission(on.model, on.cover, lambda level, text: None)
        self._recorder = Recorder()

    def hear(self, word: str, now: float) -> List[str]:
        """What is held against the commands so far, once this word is heard; states must follow from it."""
        states = self.mission.on_word(word, now)
        assert states, word
        self._recorder.on_word(now, word, "")
        self._recorder.states += states
        problems = self._recorder.judged(stage().game, False, 0.0, now).problems
        return [problem for problem in problems if "no order" not in problem]

    def loaded(self) -> None:
        """The robot has loaded, which begins the second stage."""
        assert self.hear("bot_going_hub_to_depot2depot", 3.6) == []
        assert self.hear("bot:load@5", 4.64) == []
        assert self.hear("loadDONE", 7.0) == []


def begun() -> Judged:
    judged = Judged()
    judged.hear("_start_", 0.0)
    judged.hear("reachObj:reachObj_going_initial_location2unlocked@1", 0.03)
    return judged


def test_in_the_first_stage_what_was_commanded_stands_whatever_the_visitor_does() -> None:
    judged = begun()
    assert judged.hear("visitor_gate2hub", 1.06) == []
    assert judged.hear("bot:bot_hub2depot@2", 1.12) == []  # decided from 1 to 1.05


def test_what_was_due_longer_ago_than_the_reaction_is_a_problem() -> None:
    judged = begun()
    assert judged.hear("visitor_gate2hub", 1.06) == []
    assert "is not what the strategy prescribes" in judged.hear("bot:bot_hub2depot@2", 1.17)[0]


def test_in_the_second_stage_a_move_of_the_visitor_makes_commands_stale() -> None:
    judged = begun()
    judged.hear("bot:bot_hub2depot@2", 1.04)
    judged.hear("visitor_gate2hub", 2.0)
    judged.loaded()
    seq = judged.mission.seq
    assert judged.hear("visitor_going_gate_to_hub2hub", 8.1) == []
    assert judged.mission.on_word(f"bot:bot_depot2hub@{seq}", 8.2) == []
    assert judged.mission.counts["stale"] == 1
    assert judged.hear(f"bot:bot_depot2hub@{seq + 1}", 8.2) == []
