"""Missions on ROS in which people order, with the real planner."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator, Sequence

from launched_mission import LaunchedMission, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

PLANNER = f"env PYTHONPATH={Path(__file__).resolve().parents[2]} {sys.executable} -m pursue_gen replan"
"""The real one, of these sources."""


@contextmanager
def ordering(ros: Ros, folder: Path, text: str, robots: Sequence[str]) -> Iterator[LaunchedMission]:
    """A mission of this scenario that runs."""
    read = parse(text, "orders.pur", "orders")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    made = write_workspace(read, won.network, won.objective, won.strategy, options, folder / "ws")
    with launched(ros, lay_over(ros, made), folder, tuple(robots), planner=PLANNER, time_unit=0.4) as run:
        run.until(lambda: run.now()["status"] == "running")
        yield run


def ask(run: LaunchedMission, order: str) -> str:
    """The answer to an order."""
    return told(run, f"rosservice call pursue/orders '{{order: {order}}}'")


def told(run: LaunchedMission, command: str) -> str:
    """The output of a command in the graph of the mission."""
    with run.program(f"source devel/setup.bash; exec {command}", "asked") as program:
        program.wait()
        return program.output()
