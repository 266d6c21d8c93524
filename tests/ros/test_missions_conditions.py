"""Conditions in a mission on ROS: a way and an event that are open only while they hold, and an objective on one."""

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

SWEEP = """\
poi "hall"
poi "street"
poi "yard"
connect hall and yard distance 1 only_if not visitor at yard
connect street and yard distance 30 only_if bot doing sweep
event "sweep" location yard duration 2 only_if no agent at hall
agent "bot" controllable mobile 1 location hall can_do sweep
agent "visitor" mobile 1 location street
objective: avoid bot doing sweep and visitor at yard
reach_objective: do sweep
"""


def test_a_mission_keeps_its_conditions_and_is_lost_where_one_is_broken(ros: Ros, tmp_path: Path) -> None:
    """The test plays robot and visitor; the second time the visitor is there sooner than the model allows."""
    read = parse(SWEEP, "sweep.pur", "sweep")
    won = solve_scenario(read, DEFAULT)
    options = Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    over = lay_over(ros, folder)
    calm = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    for number, words in enumerate((["sweepDONE"], ["visitor_street2yard", "visitor_going_street_to_yard2yard"])):
        log = tmp_path / f"mission{number}"
        log.mkdir()
        with launched(ros, over, log, ("bot",), **PLAYED, **calm, use_sim_time=True, speed=2) as run:
            run.until_step("bot_hall2yard")
            run.publish("bot_going_hall_to_yard2yard")
            assert run.until_step("sweep")["places"]["bot"] == "doing_sweep_in_yard"
            for word in words:
                run.publish(word)
                run.until_step(word)
            assert run.until_over() == ("won", "lost")[number], run.output()
            assert run.now()["places"]["obj"] == ("idle", "lose")[number]
