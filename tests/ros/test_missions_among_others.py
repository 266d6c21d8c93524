"""Generated workspaces on a real master, whose missions are played among agents that nobody controls."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

import pytest
from ros_world import BEGIN, END, Ros, judged, lay_over, missions

from benchmarks.families import pass_bystanders
from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

Build = Callable[..., Path]

pytestmark = pytest.mark.ros


@pytest.mark.parametrize("name, which", [("catch_the_thief/one_officer", END), ("work_cell/work_cell", BEGIN)])
def test_missions_among_agents_that_nobody_controls(ros: Ros, built: Build, name: str, which: slice) -> None:
    assert missions(judged(ros, built(name), which)) == 2


def test_passers_by_are_seen_and_change_nothing(ros: Ros, tmp_path: Path) -> None:
    """They walk and shout all the time: the state follows them, and the commands name the robots' states alone."""
    text = pass_bystanders(2).replace('event "report"', 'event "report"\nevent "shout"')
    text = text.replace("mobile 3 location hub", "mobile 1 location hub can_do shout")
    scenario = parse(text, "crowd.pur", "crowd")
    won = solve_scenario(scenario, Rules())
    folder = write_workspace(scenario, won.network, won.objective, won.strategy, Options(), tmp_path / "crowd")
    assert "person1" not in (folder / "src" / "controller_bot1" / "config" / "strategy.yaml").read_text()
    assert "person1" in (folder / "src" / "observer" / "config" / "model.yaml").read_text()
    assert missions(judged(ros, lay_over(ros, folder), END)) == 2
