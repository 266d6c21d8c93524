"""States with values that do not exist, or without what a model or a strategy reads, are found before they are used."""

from __future__ import annotations

import math
from typing import Any, Dict

import pytest

from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.state_checks import MAX_NAMES, model_problem, names_problem, state_problem, strategy_problem
from pursue_runtime.strategy import Strategy
from tests.runtime.controller.test_scheduler import STRATEGY
from tests.runtime.models import model_data, mover, state
from tests.runtime.texts import read

MODEL = Model(model_data(mover("bot", "robot", 3)))
GOOD = state(MODEL, 3, 100.0, {"Cbot": 1.0})


def test_what_an_observer_publishes_is_right() -> None:
    for status in ("waiting", "running", "holding", "won", "lost", "stopped"):
        good = GOOD._replace(status=status)
        assert state_problem(good) == model_problem(MODEL, good) == ""


@pytest.mark.parametrize("change, said", [
    ({"status": "unknown"}, "status is 'unknown'"),
    *(({"unit": unit}, "time_unit") for unit in (0.0, -1.0, math.nan, math.inf)),
    *(({"stamp": stamp}, "stamp") for stamp in (math.nan, math.inf)),
    *(({"clocks": {**GOOD.clocks, "Cbot": clock}}, "Cbot is") for clock in (math.nan, math.inf, -math.inf)),
    ({"locations": {}}, "0 automata"),
    ({"seq": 0}, "number 0"),
])
def test_values_that_do_not_exist_are_found(change: Dict[str, Any], said: str) -> None:
    assert said in state_problem(GOOD._replace(**change)) and model_problem(MODEL, GOOD._replace(**change))


def without(names: Dict[str, Any], name: str) -> Dict[str, Any]:
    return {each: value for each, value in names.items() if each != name}


@pytest.mark.parametrize("change, said", [
    ({"locations": without(GOOD.locations, "bot")}, "automata are not those of the model: bot"),
    ({"locations": {**GOOD.locations, "dog": "a"}}, "dog"),
    ({"locations": {**GOOD.locations, "bot": "moon"}}, "bot has no location 'moon'"),
    ({"values": without(GOOD.values, "Pbot")}, "variables are not those of the model: Pbot"),
    ({"clocks": without(GOOD.clocks, "Cbot")}, "clocks are not those of the model: Cbot"),
])
def test_a_state_of_another_model_is_found(change: Dict[str, Any], said: str) -> None:
    assert said in model_problem(MODEL, GOOD._replace(**change))


def test_a_state_without_what_the_strategy_reads_is_found() -> None:
    strategy = Strategy(read(STRATEGY))
    good = SystemState(1, 100.0, {"bot": "c", "dog": "d"}, {}, {"Cbot": 1.0, "Cdog": 2.0})
    assert strategy_problem(strategy, good) == ""
    assert "lacks Cbot" in strategy_problem(strategy, good._replace(clocks={"Cdog": 2.0}))
    assert "lacks bot" in strategy_problem(strategy, good._replace(locations={"dog": "d"}))


def test_names_come_once_and_not_without_number() -> None:
    assert names_problem("clocks", ["a", "b"]) == "" and names_problem("clocks", []) == ""
    assert "not all different" in names_problem("clocks", ["a", "b", "a"])
    assert "at most" in names_problem("clocks", [str(number) for number in range(MAX_NAMES + 1)])
