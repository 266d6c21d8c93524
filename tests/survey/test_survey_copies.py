"""The copies of the scenarios that come with the project: sound, and the same again when they are surveyed again."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from pursue_gen.diagnostics import Severity
from pursue_gen.drawing.ground import Ground
from pursue_gen.language import check, parse
from pursue_gen.language.formatter import format_text
from pursue_gen.survey.make import Options, Survey, surveyed
from pursue_gen.survey.routes import Drive
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import read_placed
from pursue_gen.workspace.robot_size import RobotSize, Sizes
from tests.conftest import ROOT
from tests.survey.maps import drawn, ground_of

CELL = 0.25
SOME = sorted((ROOT / "scenarios").glob("*/*.pur"))[::15]
SCENARIOS = [file for file in SOME if file.read_text(encoding="utf-8").count("\npoi ") > 1]
"""One place alone cannot be measured."""


def with_poses(text: str) -> str:
    """The text with a pose behind each place that has its line for itself."""
    places = iter(range(1000))

    def pose(match: "re.Match[str]") -> str:
        number = next(places)
        x, y = 2 + 3 * (number % 6), 2 + 3 * (number // 6)
        return f"{match[1]} //[{x}, {y}, 0, 0, 0, 0, 1]{match[2] or ''}"

    place = r'^(poi "\w+"(?: label "[^"]*")?)[ \t]*(?://[ \t]*(?:\[[^\n\]]*\])?([^\n]*))?$'
    return re.sub(place, pose, text, flags=re.M)


def ground(text: str) -> Ground:
    return ground_of(drawn((20.0, 3.0 * text.count("//[") / 6 + 6), [], resolution=CELL), CELL)


@pytest.mark.parametrize("file", SCENARIOS, ids=lambda file: str(file.stem))
@pytest.mark.parametrize("ways", [False, True])
def test_a_copy_is_sound_and_is_its_own_copy(file: Path, ways: bool) -> None:
    text = with_poses(file.read_text(encoding="utf-8"))

    def survey(text: str) -> Survey:
        scenario = read_placed(text, str(file))
        speeds = {agent.name: 0.5 for agent in scenario.agents if agent.is_robot and agent.mobile is not None}
        options = Options(Sizes(RobotSize(0.2)), ways=ways, drive=Drive(speeds))
        return surveyed(scenario, (Level(ground(text)),), options)

    copy = survey(text).text
    assert not [one for one in check(parse(copy, str(file))) if one.severity is Severity.ERROR]
    assert survey(copy).text == copy
    formatted = format_text(copy, str(file))
    assert survey(formatted).text == formatted
