"""Missions on ROS in which it is found out what a state is: said by somebody who sees it, or drawn by the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import PLAYED, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

SEARCH = Path(__file__).resolve().parents[2] / "scenarios" / "warehouse" / "which_shelf.pur"


def _workspace(ros: Ros, tmp_path: Path) -> Path:
    read = parse(SEARCH.read_text(), "search.pur", "search")
    won, options = solve_scenario(read, DEFAULT), Options(reaction=DEFAULT.reaction)
    return lay_over(ros, write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws"))


def test_what_the_robot_does_depends_on_what_is_said(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robot, and says where the part is; before the robot is there nobody can."""
    over, calm = _workspace(ros, tmp_path), {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    answers = {"onA_is_true": "takeA", "onA_is_false": "bot_shelfA2shelfB"}
    for number, (word, answer) in enumerate(answers.items()):
        log = tmp_path / f"mission{number}"
        log.mkdir()
        with launched(ros, over, log, ("bot",), **PLAYED, **calm, time_unit=1, use_sim_time=True, speed=4) as run:
            run.until_step("bot_desk2shelfA")
            run.publish(word)
            run.publish("bot_going_desk_to_shelfA2shelfA")
            there = run.until_step("bot_going_desk_to_shelfA2shelfA")
            assert (there["places"]["onA"], there["values"]["SonA"]) == ("doing_finding_out", 2)
            run.publish(word)
            known = run.until_step(word)
            assert (known["places"]["onA"], known["values"]["SonA"]) == ("known", int(word.endswith("true")))
            assert run.until_step(answer), run.output()


def test_a_simulated_mission_is_won(ros: Ros, tmp_path: Path) -> None:
    over = _workspace(ros, tmp_path)
    with launched(ros, over, tmp_path, ("bot",), mode="random", use_sim_time=True, speed=8) as run:
        assert run.until_over() == "won", run.output()
