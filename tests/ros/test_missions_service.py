"""People take a robot out of service while a mission runs, and bring it back."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from launched_mission import LaunchedMission, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

WARD = """\
poi "hall"
poi "east"
poi "west"
connect hall and east distance 10
connect hall and west distance 10
event "tea" on_order
event "serve" location east duration 3
agent "bot1" controllable mobile 1 location hall can_do serve
agent "bot2" controllable mobile 1 location west can_do serve
objective: if tea then serve within 200
"""

PLANNER = f"env PYTHONPATH={Path(__file__).resolve().parents[2]} {sys.executable} -m pursue_gen replan"


def ask(run: LaunchedMission, order: str) -> str:
    """The answer to an order."""
    call = f"rosservice call pursue/orders '{{order: {order}}}'"
    with run.program(f"source devel/setup.bash; exec {call}", "asked") as program:
        program.wait()
        return program.output()


def test_a_robot_leaves_gets_no_order_and_comes_back_whatever_becomes_of_the_observer(ros: Ros, tmp_path: Path) -> None:
    read = parse(WARD, "ward.pur", "ward")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot1", "bot2"), planner=PLANNER, time_unit=0.4) as run:
        run.until(lambda: run.now()["status"] == "running")
        assert "in service already" in ask(run, "join bot2")
        left = ask(run, "leave bot2")
        assert "accepted: True" in left and "it stands at west, and counts there" in left
        assert run.now()["out_of_service"] == "bot2" and run.now()["plan"] != "0"
        old = run.kill("observer")
        run.until_back("observer", old)
        assert run.now()["out_of_service"] == "bot2"
        assert "accepted: True" in ask(run, "tea")
        run.until(lambda: run.steps().count("serveDONE") > 0)
        assert not [order for order in run.orders() if "bot2" in str(order)]
        assert "in service again" in ask(run, "join bot2")
        run.until(lambda: "out_of_service" not in run.now())
