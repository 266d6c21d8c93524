"""Which strategy a recording is checked against: the one that was played, or none."""

from __future__ import annotations

import functools
from hashlib import sha256
from typing import Any, Dict

import pytest
from test_read import GAME

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.plan import write_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.replay.game import Game, from_data, game_of
from tests.workspace.worlds import SCENARIOS

THEFT = load(SCENARIOS / "thesis" / "catch_the_thief.pur")


@functools.lru_cache(maxsize=None)
def digest(**asked: Any) -> str:
    """Of the plan that the solver finds if it is asked that."""
    won = solved(translate(THEFT), scenario_objective(THEFT), Rules(), SolveOptions(**asked))
    return sha256(write_plan(won.strategy, won.network, won.objective).encode()).hexdigest()


def game(plan: Dict[str, Any]) -> Game:
    """The game of a recording that holds that of its plan."""
    return game_of(from_data({**GAME, "name": THEFT.name, "scenario": THEFT.text, "plan": plan}, "mission.bag"))


def test_what_the_solver_was_asked_for_is_asked_again() -> None:
    first = digest(optimize="none")
    assert first != digest(), "or this test shows nothing"
    known = game({"sha256": first, "optimize": "none"})
    assert known.orders is not None and known.given
    assert game({"sha256": digest()}).orders is not None


@pytest.mark.parametrize("plan", [{"sha256": "0" * 64}, {"sha256": "0" * 64, "optimize": "none"}])
def test_another_plan_is_not_taken_for_the_one_that_was_played(plan: Dict[str, Any]) -> None:
    unknown = game(plan)
    assert unknown.orders is None and "--workspace" in unknown.why_not


def test_a_recording_of_before_plans_had_digests_is_checked_with_what_is_found_now() -> None:
    old = game({})
    assert old.orders is not None and not old.given


@pytest.mark.parametrize("plan", ["a plan", {"within": "soon"}, {"within": [1]}, 7])
def test_a_damaged_one_is_an_error_of_one_line(plan: Any) -> None:
    with pytest.raises(PursueError, match="does not describe a game"):
        game(plan)
