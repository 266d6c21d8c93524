"""What docs/tutorial.md shows is what a reader gets."""

from __future__ import annotations

import re
from pathlib import Path
from typing import List, Tuple

import pytest
import yaml

from pursue_gen.language import load
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace.model_file import render
from pursue_runtime.model import Model, Position
from pursue_runtime.state import SystemState
from pursue_runtime.vocabulary import sentence
from tests.cli.test_commands import pursue
from tests.conftest import ROOT

PAGE = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")


def blocks(language: str) -> List[str]:
    """The blocks of this language, in order."""
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


def said(folder: Path, *words: str) -> Tuple[int, str]:
    """What a command says to its reader, and its exit status."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        told = pursue(*words)
    return told.status, told.out + told.err


def write_scenario(folder: Path) -> Path:
    """Writes the scenario as it is once the typing mistake is corrected; the folder."""
    (scenario,) = blocks("pursue")
    (folder / "night_shift.pur").write_text(scenario.replace("fetsh", "fetch"), encoding="utf-8")
    return folder


def worst_time() -> float:
    """The time to the goal that the page shows; a test compares it with what `solve` finds."""
    return float(re.findall(r"at most (\S+) time units", blocks("text")[1])[0])


@pytest.fixture
def ward(tmp_path: Path) -> Path:
    """A folder with the scenario."""
    return write_scenario(tmp_path)


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Tuple[Path, int, str]:
    """A folder with the scenario and its plan; the exit status of `solve` and what it says."""
    folder = write_scenario(tmp_path_factory.mktemp("solved"))
    return (folder, *said(folder, "solve", "night_shift.pur", "-o", "plan.txt"))


def test_the_mistake_is_reported_as_the_page_has_it(ward: Path) -> None:
    (ward / "night_shift.pur").write_text(blocks("pursue")[0], encoding="utf-8")
    status, text = said(ward, "check", "night_shift.pur")
    assert status == 3 and blocks("text")[0] in text


def test_the_scenario_is_sound_and_laid_out_well(ward: Path) -> None:
    assert said(ward, "check", "night_shift.pur")[0] == said(ward, "fmt", "--check", "night_shift.pur")[0] == 0


def test_it_can_be_done_in_the_time_that_the_page_names(solved: Tuple[Path, int, str]) -> None:
    _, status, text = solved
    assert status == 0
    for line in blocks("text")[1].splitlines():
        assert line in text
    (latest,) = re.findall(r"handed over after (\S+)\s+time\s+units at the latest", PAGE)
    assert float(latest) == worst_time()


def test_a_faster_nurse_gets_away_and_the_page_says_what_would_help(ward: Path) -> None:
    scenario = ward / "night_shift.pur"
    scenario.write_text(scenario.read_text(encoding="utf-8").replace("mobile 3", "mobile 1"), encoding="utf-8")
    status, text = said(ward, "solve", "night_shift.pur")
    assert status == 4
    for line in blocks("text")[2].splitlines():
        assert line in text


def test_simulated_nights_end_well(solved: Tuple[Path, int, str]) -> None:
    """With the plan that was found: to find it once more takes much longer than to read it."""
    ward = solved[0]
    status, text = said(ward, "sim", "night_shift.pur", "--runs", "20", "--timeline", "x.svg")
    assert status == 2 and "--runs 1" in text
    status, text = said(ward, "sim", "night_shift.pur", "--runs", "10", "--plan", "plan.txt")
    found = next(line for line in text.splitlines() if line.startswith("goal reached"))
    assert status == 0 and found.split()[:4] == ["goal", "reached", "10", "100.0"]
    (runs,) = re.findall(r"sim night_shift.pur --runs (\d+)\n", PAGE)
    assert blocks("text")[3].split() == ["goal", "reached", f"{int(runs):,}", "100.0"]


def test_the_mission_that_the_page_shows_is_one_of_the_model(ward: Path) -> None:
    """Its lines are those that the terminal prints, and in this order they lead to the goal, in time."""
    scenario = load(ward / "night_shift.pur")
    rules, objective = Rules(), scenario_objective(scenario)
    text = render(played(translate(scenario), rules), objective, scenario, rules.reaction, "test")
    model = Model(yaml.safe_load(text))
    first, *lines, end = blocks("text")[4].splitlines()
    assert first == "     0.0  the mission runs"
    position, last = model.initial(), 0.0
    for line in lines:
        at, what = float(line[:8]), line[10:]
        assert at >= last
        position, last = following(model, position, what), at
    assert model.goal == (("reachObj", "win"),) and position.locations["reachObj"] == "win"
    assert end == f"The goal is reached, after {last:.1f} time units."
    assert last <= worst_time()


def following(model: Model, position: Position, what: str) -> Position:
    """The position after the event for which the terminal prints these words."""
    found = []
    for word in model.possible(position, timed=False):
        for agent in (automaton.name for automaton in model.automata):
            moves = model.joint_move(position, word, agent, timed=False)
            if moves is not None:
                after = model.after(moves, position)
                state = SystemState(1, 0.0, after.locations, after.values, after.clocks, word, agent)
                found += [after] if sentence(model, state, None) == what else []
    assert len(found) == 1, what
    return found[0]


def test_its_pictures_are_there() -> None:
    for picture in re.findall(r"\((pictures/.*?)\)", PAGE):
        assert (ROOT / "docs" / picture).is_file()
