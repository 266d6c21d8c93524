"""Generated workspaces on a real master: each is built, and judged by the launch tests that it carries."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Callable

import pytest
from ros_world import ALL, BEGIN, END, Ros, judged, lay_over, make, make_whole, missions

from pursue_gen.language import parse
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace import Options, write_workspace

Build = Callable[..., Path]

ALONE = ["scenario_1", "scenario_2", "scenario_3", "scenario_4"]
"""The thesis's scenarios in which every agent is a robot; in the others some do as they like, or what a trace says."""

MADE = {("scenario_1", "distributed"): make_whole, ("scenario_1", "centralized"): make}
"""Those that are built as a user does, and judged through catkin_make; nodes of the others run from their sources."""

pytestmark = pytest.mark.ros


@pytest.mark.parametrize("controllers", ["distributed", "centralized"])
@pytest.mark.parametrize("name", ALONE)
def test_missions_of_robots_alone(ros: Ros, built: Build, name: str, controllers: str) -> None:
    how = MADE.get((name, controllers), lay_over)
    assert missions(judged(ros, built(f"thesis/{name}", controllers, how))) == 1


@pytest.mark.parametrize("controllers", ["distributed", "centralized"])
def test_the_thief_of_the_thesis_is_caught_still_and_moving(ros: Ros, built: Build, controllers: str) -> None:
    which = ALL if controllers == "distributed" else BEGIN
    assert missions(judged(ros, built("thesis/catch_the_thief", controllers), which)) == (4 if which is ALL else 2)


def test_a_general_controller_decides_the_ends_itself(ros: Ros, built: Build) -> None:
    assert missions(judged(ros, built("thesis/scenario_1", "general"))) == 1


def test_a_plan_of_uppaal_tiga_is_played(ros: Ros, reference_dir: Path, tmp_path: Path) -> None:
    """TIGA's plan is for the ideal game; split, and without its ends, it still catches the thief (as in the thesis)."""
    text = (reference_dir / "CT1" / "scenario.pur").read_text(encoding="utf-8")
    scenario = parse(text, "ct1.pur", "ct1")
    network = translate(scenario)
    plan = read_plan((reference_dir / "CT1" / "UPPAAL_plan.txt").read_text(errors="replace"), network, "plan")
    options = Options(reaction=Fraction(0))
    folder = write_workspace(scenario, network, scenario_objective(scenario), plan, options, tmp_path / "ct1")
    assert missions(judged(ros, lay_over(ros, folder), END)) == 2
