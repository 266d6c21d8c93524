"""The observer has what it takes to plan again: the scenario word for word, and which game is played."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from fractions import Fraction
from typing import Any, Dict

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import load
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.workspace import Options
from pursue_gen.workspace.game_file import render
from tests.workspace.worlds import SCENARIOS, files

FIRST = load(str(SCENARIOS / "thesis/scenario_1.pur"))
NOTHING = Strategy(())


def read(text: str) -> Dict[str, Any]:
    data = yaml.safe_load(text)
    assert isinstance(data, dict)
    return data


@pytest.mark.parametrize("shape", ["distributed", "centralized", "general"])
def test_the_observer_has_the_game(shape: str) -> None:
    data = read(files("thesis/scenario_1", shape)["src/observer/config/game.yaml"].decode())
    ideal = shape == "general"
    plan = files("thesis/scenario_1", shape)["UPPAAL_plan.txt"]
    assert data == {
        "format": 1,
        "name": "scenario_1",
        "plan": {"sha256": hashlib.sha256(plan).hexdigest()},
        "scenario": FIRST.text,
        "rules": {"ends": "controllable" if ideal else "reported", "reaction": 0 if ideal else 0.1, "slack": {}},
        "controllers": shape,
        "reach_obj": "dedicated",
    }


def test_the_rules_are_those_that_were_asked_for() -> None:
    options = Options(reach_obj="all", reaction=Fraction(1, 3), slack={"bot2": 4, "bot1": 2})
    data = read(render(FIRST, options, NOTHING, "", "0"))
    assert data["rules"] == {"ends": "reported", "reaction": "1/3", "slack": {"bot1": 2, "bot2": 4}}
    assert data["reach_obj"] == "all"


def test_what_the_solver_was_asked_for_is_there_for_those_who_solve_again() -> None:
    assert read(render(FIRST, Options(optimize="none"), NOTHING, "", "0"))["plan"]["optimize"] == "none"
    assert read(render(FIRST, Options(within=Fraction(41, 2)), NOTHING, "", "0"))["plan"]["within"] == 20.5


def test_every_scenario_is_in_its_file_word_for_word() -> None:
    for path in sorted(SCENARIOS.rglob("*.pur")):
        scenario = load(str(path))
        text = render(scenario, Options(), NOTHING, "", "0")
        assert read(text)["scenario"] == scenario.text
        assert "\nscenario: |\n" in text, "line by line, as people read it"


ODD_LINES = ("  a", "", "\t", "b: c # d", '"\\', "  ", "- e", "é", "\x85", "...", "---")


@given(st.text() | st.lists(st.sampled_from(ODD_LINES)).map("\n".join))
def test_any_text_is_kept(text: str) -> None:
    assert read(render(replace(FIRST, text=text), Options(), NOTHING, "", "0"))["scenario"] == text
