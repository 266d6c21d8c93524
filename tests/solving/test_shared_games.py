"""`together` in the game: won and lost because of it, by both engines, in simulation, with faults."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Tuple

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solution, solve_scenario
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, HELD, SAFE, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.state import STOPPED
from tests.solving.verdicts import is_won
from tests.together import CARRY, HOTEL, TWO_PORTERS, scenario, solved

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
FILM = (SCENARIOS / "museum" / "film.pur").read_text(encoding="utf-8")
RIDE = (SCENARIOS / "hotel" / "lift_ride.pur").read_text(encoding="utf-8")
LONGER = RIDE.replace("within 8", "within 12")


GAMES = {
    "film": (FILM, True, False), "ride": (RIDE, False, True), "longer": (LONGER, True, True),
    "hotel": (HOTEL, True, True), "carry": (CARRY, True, True),
}  # fmt: skip


@pytest.mark.parametrize(
    "text, together, loose, engine",
    [
        pytest.param(*game, engine, id=f"{name}-{engine}")
        for name, game in GAMES.items()
        for engine in (("native",) if name == "carry" else ("native", "python"))
    ],
)
def test_what_the_word_decides(text: str, together: bool, loose: bool, engine: str) -> None:
    assert (is_won(text, engine), is_won(text.replace(" together", ""), engine)) == (together, loose)


def test_a_partner_that_may_be_late_counts() -> None:
    """With a waiter who is late by three units the ride lasts longer, and the same deadline is too short."""
    read = parse(LONGER.replace("within 12", "within 10"), "x.pur", "x")
    made, objective = translate(read), scenario_objective(read)
    assert solution(made, objective, DEFAULT)
    with pytest.raises(PursueError):
        solution(made, objective, replace(DEFAULT, slack={"waiter": 3}))


@pytest.mark.parametrize("text", [FILM, LONGER, HOTEL, TWO_PORTERS, CARRY], ids=range(5))
def test_missions_with_random_opponents_end_well(text: str) -> None:
    """The judge takes each step for wrong that is not one of the network, and each command that is not held."""
    read = parse(text, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    outcomes = [simulate_mission(stage, Settings("random"), seed) for seed in range(30)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE}, [outcome.reason for outcome in outcomes]


@pytest.mark.parametrize(
    "kinds", [("delay", "loss", "orders"), ("deaths",), ("late", "early"), ("failed",), ("silent",)], ids="-".join
)
def test_with_faults_missions_reach_the_goal_or_stop_safely(kinds: Tuple[str, ...]) -> None:
    read = scenario(TWO_PORTERS)
    stage = stage_of(read, solved(TWO_PORTERS), Options())
    outcomes = [simulate_mission(stage, Settings("random", kinds), seed) for seed in range(12)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, HELD, STOPPED}, [o.reason for o in outcomes]
    if "failed" not in kinds and "silent" not in kinds:
        assert {outcome.end for outcome in outcomes} == {GOAL}, [o.reason for o in outcomes]
