"""A mission on ROS with a pause between two events: no box is packed before its glue has set."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

GLUE = Path(__file__).resolve().parents[2] / "scenarios" / "work_cell" / "glue.pur"


def test_no_box_is_packed_too_soon(ros: Ros, tmp_path: Path) -> None:
    read = parse(GLUE.read_text() + "reach_objective: do load\n", "glue.pur", "glue")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), mode="random", use_sim_time=True, speed=4) as run:
        assert run.until_over() == "won", run.output()
        glued, packed = (run.until_step(event)["clocks"]["Creach"] for event in ("glueDONE", "pack"))
    assert packed - glued >= 20
