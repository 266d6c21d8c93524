"""Missions on ROS with somebody of whom it is not known at first where she is: said by a node, or drawn by the
simulator."""

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

GUEST = Path(__file__).resolve().parents[2] / "scenarios" / "office" / "early_guest.pur"


def _workspace(ros: Ros, tmp_path: Path) -> Path:
    read = parse(GUEST.read_text(), "guest.pur", "guest")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    return lay_over(ros, write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws"))


def test_what_the_robot_does_first_depends_on_where_she_is(ros: Ros, tmp_path: Path) -> None:
    """The test says that she is at the desk, unless the simulator has said something else before."""
    over = _workspace(ros, tmp_path)
    with launched(ros, over, tmp_path, ("bot",), mode="still", use_sim_time=True, speed=4) as run:
        run.until(lambda: run.now().get("places", {}).get("guest") == "doing_being_somewhere")
        run.publish("guest_starts_at_desk")
        (said,) = run.until(lambda: [step for step in run.steps() if step.startswith("guest_starts_at_")])
        assert run.until_over() == "won", run.output()
        acts = [order for _, order in run.orders() if order in ("greet", "sort")]
        assert acts == (["greet", "sort"] if said == "guest_starts_at_desk" else ["sort"])


def test_a_simulated_mission_is_won(ros: Ros, tmp_path: Path) -> None:
    over = _workspace(ros, tmp_path)
    with launched(ros, over, tmp_path, ("bot",), mode="random", use_sim_time=True, speed=8) as run:
        assert run.until_over() == "won", run.output()
        assert sum(step.startswith("guest_starts_at_") for step in run.steps()) == 1
