"""The page says in words what rules, counts and objectives are at, and by when something is due."""

from __future__ import annotations

from typing import Any

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.ui.statuses import Status, read_statuses, status_texts
from tests.runtime.models import model_data, state, worker

PATROL = {
    "name": "obj", "kind": "safety", "initial": "atRisk",
    "locations": {"idle": [], "lose": [], "atRisk": ["Cobj <= 50"]},
    "edges": [{"from": "atRisk", "to": "lose", "word": "obj_atRisk2lose", "sync": "own", "controllable": False}],
}  # fmt: skip
DATA = model_data(worker("bot", "robot"))
DATA["automata"].append(PATROL)
DATA["clocks"].append("Cobj")
MODEL = Model(DATA)
PATROL_A = "patrol a every 50 by bot"
SETTINGS = {
    "statuses": [
        {"of": "obj", "label": PATROL_A, "texts": {"idle": "bot is there", "atRisk": "a visit is due"}},
        {"of": "Prule", "label": "bag of bot", "texts": {"0": "next: load", "1": "next: unload"}},
    ]
}
STATUSES = read_statuses(SETTINGS)


def test_values_and_locations_are_said_in_words_and_deadlines_with_their_moment() -> None:
    now = state(MODEL, 3, 120.0, {"Cobj": 8.5}, obj="atRisk", values={"Prule": 1})
    assert status_texts(STATUSES, MODEL, now, 20.0) == {
        PATROL_A: "a visit is due, by 61.5", "bag of bot": "next: unload"
    }  # fmt: skip
    there = now._replace(locations={**now.locations, "obj": "idle"})
    assert status_texts(STATUSES, MODEL, there, 20.0)[PATROL_A] == "bot is there"


def test_what_has_no_words_is_left_out() -> None:
    now = state(MODEL, 3, 120.0, {}, obj="lose", values={"Prule": 7})
    unknown = (Status("nothing", "unknown", {"x": "y"}), *STATUSES)
    assert status_texts(unknown, MODEL, now, 20.0) == {}


def test_the_page_has_them_beside_the_values_of_the_model() -> None:
    page = Page(MODEL, FloorPlan({}, ()), statuses=STATUSES)
    seen = page.view(Facts("running", (), state(MODEL, 3, 120.0, {}, obj="idle"), 20.0, 20.0))
    assert seen["statuses"] == {PATROL_A: "bot is there", "bag of bot": "next: load"}
    assert seen["rest"]["obj"] == "idle" and seen["rest"]["Prule"] == 0
    before = page.view(Facts("ready", (), None, 0.0, 0.0))
    assert before["statuses"]["bag of bot"] == "next: load"


def test_a_file_of_before_has_none_and_a_wrong_one_is_refused() -> None:
    assert read_statuses({}) == ()
    wrong: Any
    for wrong in (7, [7], [{"of": "obj"}], [{"of": "obj", "label": "x", "texts": 7}]):
        with pytest.raises(DataError, match="statuses"):
            read_statuses({"statuses": wrong})
