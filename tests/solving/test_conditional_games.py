"""`only_if` in the game: won and lost because of it, in simulation, with faults, explained."""

from __future__ import annotations

from pathlib import Path

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.explain import explain
from pursue_gen.language import parse
from pursue_gen.simulation.mission import GOAL, HELD, SAFE, Settings, simulate_mission
from pursue_gen.simulation.stage import stage_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solution, solve_scenario
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace import Options
from pursue_runtime.state import STOPPED

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
STATUE = (SCENARIOS / "museum" / "guarded_statue.pur").read_text(encoding="utf-8")
DOOR = (SCENARIOS / "hotel" / "staff_door.pur").read_text(encoding="utf-8")

# Nobody gets in while the warden inspects the gate, nor when it is shut.
GATE = """\
poi "street"
poi "entrance"
poi "gallery"
connect street and entrance distance 9
connect entrance and gallery distance 2 only_if no robot doing inspect and gate is_true
event "inspect" location entrance duration 2
event "shut" location entrance
event "steal" location gallery
rule "order": inspect before shut
state "gate": initially true, false_if shut
agent "warden" controllable location entrance can_do inspect, shut
agent "burglar" mobile 1 location street can_do steal
objective: avoid steal
"""


def is_won(text: str, engine: str) -> bool:
    read = parse(text, "x.pur", "x")
    try:
        solution(translate(read), scenario_objective(read), DEFAULT, SolveOptions(engine=engine))
    except PursueError as problem:
        assert problem.exit_status == 4, problem
        return False
    return True


BUSY = " only_if no robot doing inspect"


@pytest.mark.parametrize(
    ("text", "condition", "won", "without", "engine"),
    [
        (STATUE, " only_if no robot at statue", True, False, "native"),
        (DOOR, " only_if clerk at desk", False, True, "native"),
        (GATE, BUSY + " and gate is_true", True, False, "native"),
        (GATE, BUSY + " and gate is_true", True, False, "python"),
        (GATE.replace(" and gate is_true", ""), BUSY, False, False, "native"),
    ],
    ids=["statue", "door", "gate", "gate in Python", "gate without its state"],
)
def test_what_the_condition_decides(text: str, condition: str, won: bool, without: bool, engine: str) -> None:
    assert condition in text
    assert (is_won(text, engine), is_won(text.replace(condition, ""), engine)) == (won, without)


def test_the_explanation_names_the_condition() -> None:
    read = parse(DOOR, "x.pur", "x")
    explanation = explain(read, DEFAULT)
    labels = [change.sentence for change in explanation.changes]
    assert "the way between desk and kitchen without only_if clerk at desk" in " ".join(labels)


@pytest.mark.parametrize("text", [STATUE, GATE], ids=["statue", "gate"])
def test_missions_with_random_opponents_end_well(text: str) -> None:
    """The judge takes each step for wrong that is not one of the network, and each command that is not held."""
    read = parse(text, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    outcomes = [simulate_mission(stage, Settings("random"), seed) for seed in range(30)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE}, [outcome.reason for outcome in outcomes]


@pytest.mark.parametrize("kinds", [("delay", "loss", "orders"), ("late", "early")], ids="-".join)
def test_with_faults_missions_reach_the_goal_or_stop_safely(kinds: "tuple[str, ...]") -> None:
    read = parse(STATUE, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    outcomes = [simulate_mission(stage, Settings("random", kinds), seed) for seed in range(12)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, HELD, STOPPED}, [o.reason for o in outcomes]
