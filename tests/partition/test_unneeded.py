"""A robot that a strategy does without is named, by `solve`, in the report, and on the operator's page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import List

import pytest
import yaml

from pursue_gen.partition import unneeded, unneeded_words
from pursue_gen.tools.report.verdict import section
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.ui.promise import read_promise
from tests.stories import files, model, scenario, solved
from tests.tools.authoring.commands import pursue

TWO = """\
poi "a"
poi "b"
connect a and b distance 2
event "fetch" location b
event "lift" collaborative location b
agent "bot1" controllable mobile 1 location a can_do fetch, lift
agent "bot2" controllable mobile 1 location a reacts_to lift{}
agent "guest" location a
{}
"""
ALONE = TWO.format("", "reach_objective: do fetch")


def names(text: str) -> List[str]:
    return [agent.name for agent in unneeded(scenario(text), solved(text).strategy)]


def test_a_robot_without_commands_whom_nobody_needs_is_not_needed() -> None:
    assert names(ALONE) == ["bot2"]
    assert unneeded_words(()) == ""


@pytest.mark.parametrize(
    "text",
    [
        TWO.format("", "reach_objective: do lift"),
        TWO.format("", "objective: patrol a every 50 by any robot\nreach_objective: do fetch"),
        TWO.format("", "objective: always any robot at a\nreach_objective: do fetch"),
    ],
)
def test_a_robot_that_helps_where_it_stands_is_needed(text: str) -> None:
    assert names(text) == []


def test_solve_says_it(tmp_path: Path) -> None:
    file = tmp_path / "two.pur"
    file.write_text(ALONE, encoding="utf-8")
    assert "bot2 is not needed in this mission: the strategy never commands it." in pursue("solve", file).err
    assert json.loads(pursue("solve", file, "--json").out)["not_needed"] == ["bot2"]


def test_the_report_says_it() -> None:
    won = solved(ALONE)
    assert "bot2 is not needed in this mission" in section(scenario(ALONE), won.rules, won).body_html


def test_the_page_says_it_until_another_plan_is_in_force() -> None:
    settings = yaml.safe_load(files(ALONE)["src/UI/config/ui.yaml"])
    assert settings["not_needed"] == ["bot2"]
    used = model(ALONE)
    page = Page(used, FloorPlan({}, ()), promise=read_promise(settings))

    def notes(plan: int) -> List[List[str]]:
        state = page._unstarted()._replace(plan=plan)
        return [agent["notes"] for agent in page.view(Facts("running", (), state, 0.0, 0.0))["agents"]]

    assert notes(0) == [[], ["is not needed in this mission"], []]
    assert notes(1) == [[], [], []]
