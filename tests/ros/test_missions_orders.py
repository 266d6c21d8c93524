"""People order while a mission is under way: accepted with a plan that is proven, refused with the reason."""

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
from tests.runtime.observer.test_ordering import TEA as STORY_TEXT

pytestmark = pytest.mark.ros

TEA = STORY_TEXT.replace("within 60", "within 200")

PLANNER = f"env PYTHONPATH={Path(__file__).resolve().parents[2]} {sys.executable} -m pursue_gen replan"
"""The real one, of these sources."""

PUBLISH = "rostopic pub -1 pursue/orders std_msgs/String 'data: {}'"
CALL = "rosservice call pursue/orders '{{order: {}}}'"


def ask(run: LaunchedMission, command: str) -> str:
    """The output of a command in the graph of the mission."""
    with run.program(f"source devel/setup.bash; exec {command}", "asked") as program:
        program.wait()
        return program.output()


def test_orders_are_accepted_with_a_plan_or_refused_with_the_reason(ros: Ros, tmp_path: Path) -> None:
    read = parse(TEA, "tea.pur", "tea")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), planner=PLANNER, time_unit=0.4) as run:
        run.until(lambda: run.now()["status"] == "running")
        assert "refused: nobody can order coffee; expected one of tea1, tea2" in ask(run, CALL.format("coffee"))
        accepted = ask(run, CALL.format("tea1"))
        assert "accepted: True" in accepted and "s at the latest" in accepted
        assert run.now()["places"]["obj"] == "atRisk" and run.now()["plan"] != "0"
        refused = ask(run, CALL.format("tea2 within 2"))
        assert "accepted: False" in refused and "possible: " in refused and "possible: 0.0" not in refused
        assert run.now()["places"]["obj2"] == "idle"
        assert "not cancelled: no tea2 waits for its answer" in ask(run, CALL.format("cancel tea2"))
        ask(run, PUBLISH.format("tea2"))
        run.until(lambda: run.now()["places"]["obj2"] == "atRisk")
        assert "text: \"cancelled\"" in ask(run, CALL.format("cancel tea2"))
        assert run.now()["places"]["obj2"] == "idle"
        run.until(lambda: run.steps().count("serve1DONE") > 0)
        assert run.now()["places"]["obj"] == "idle" and "serve2" not in run.steps()
        assert run.now()["status"] == "running"


def test_what_is_written_is_accepted_where_the_scenario_has_no_orders(ros: Ros, tmp_path: Path) -> None:
    text = "\n".join(line for line in TEA.splitlines() if "tea" not in line)
    text += '\npoi "garden"\nagent "guest" location garden\n'
    read = parse(f"{text}\nobjective: bot never_with guest\n", "walk.pur", "walk")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), planner=PLANNER, time_unit=0.4) as run:
        run.until(lambda: run.now()["status"] == "running")
        assert "column 8: there is no POI room9" in ask(run, CALL.format("bot at room9 within 60"))
        accepted = ask(run, CALL.format("bot at room1 within 100"))
        assert "accepted: True" in accepted and "s at the latest" in accepted
        assert run.now()["places"]["obj2"] == "atRisk" and run.now()["plan"] != "0"
        refused = ask(run, CALL.format("bot at room2 within 2"))
        assert "accepted: False" in refused and "possible: " in refused and "possible: 0.0" not in refused
        run.until(lambda: run.now()["places"]["bot"] == "room1")
        assert run.now()["places"]["obj2"] == "idle"
        ask(run, PUBLISH.format("do serve2 within 100"))
        run.until(lambda: run.steps().count("serve2DONE") > 0)
        assert run.now()["places"]["obj3"] == "idle" and run.now()["status"] == "running"
