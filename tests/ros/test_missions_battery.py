"""A robot with a battery on ROS: each state has its level; what was given up is said and does not end the mission."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import PLAYED, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.request import SolveRequest
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

ROUND = """\
poi "gate"
poi "hall"
connect gate and hall distance 2
event "wipe" location hall duration 1
event "charge" location gate duration 4
rule "order": wipe before charge
agent "bot" controllable mobile 1 location gate can_do wipe, charge
battery "bot" capacity 8 uses 1 per unit recharges 2 per unit at gate
reach_objective: do charge
optional 1 reach_objective: do wipe within 4
"""


WATCH = """\
poi "gate"
poi "hall"
connect gate and hall distance 2
agent "bot" controllable mobile 1 location gate
battery "bot" lasts 60, charges in 8 at gate
objective: patrol hall every 60 by bot
"""

CALLS = """\
poi "gate"
poi "hall"
connect gate and hall distance 2
event "wipe" location hall duration 2
event "ring" location hall
agent "bot" controllable mobile 1 location gate can_do wipe
agent "guest" location hall can_do ring
battery "bot" lasts 27, charges in 24 in 3 parts at gate
assume: guest does ring at_most 2 times
objective: if ring then wipe within 14
"""


def test_the_battery_is_used_and_recharged(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robot."""
    found = promised_of(parse(ROUND, "round.pur", "round"), SolveRequest())
    won = found.solution
    options = Options(reaction=won.reaction)
    folder = write_workspace(found.scenario, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    calm = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), **PLAYED, **calm, use_sim_time=True, speed=2) as run:
        assert run.until_step("bot_gate2hall")["values"]["Lbot"] == 5
        run.publish("bot_going_gate_to_hall2hall")
        assert run.until_step("wipe")["values"]["Lbot"] == 3
        run.publish("wipeDONE")
        assert run.until_step("bot_hall2gate")["values"]["Lbot"] == 0
        run.publish("bot_going_hall_to_gate2gate")
        assert run.until_step("charge")["values"]["Lbot"] == 0
        run.publish("chargeDONE")
        assert run.until_over() == "won", run.output()
        assert run.now()["values"]["Lbot"] == 8
        assert "it does not promise: do wipe within 4" in run.output()


def test_a_battery_by_time_is_full_when_the_robot_has_been_at_its_charger(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robot."""
    found = promised_of(parse(WATCH, "watch.pur", "watch"), SolveRequest())
    won = found.solution
    options = Options(reaction=won.reaction)
    folder = write_workspace(found.scenario, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    calm = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), **PLAYED, **calm, use_sim_time=True, speed=2) as run:
        assert run.until_step("bot_gate2hall")["places"]["obj2"] == "atRisk"
        run.until(lambda: run.now()["clocks"]["Cbot"] > 2.1)
        run.publish("bot_going_gate_to_hall2hall")
        run.until_step("bot_hall2gate")
        run.until(lambda: run.now()["clocks"]["Cbot"] > 2.1)
        run.publish("bot_going_hall_to_gate2gate")
        assert run.until_step("bot_going_hall_to_gate2gate")["places"]["obj2"] == "atCharger"
        full = run.until_step("obj2_atCharger2idle")
        assert full["places"]["obj2"] == "idle" and full["clocks"]["Ccharge2"] >= 8


def test_a_robot_leaves_its_charger_on_a_call_with_the_parts_that_are_done(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robot and the guest, who calls as soon as a part is done."""
    found = promised_of(parse(CALLS, "calls.pur", "calls"), SolveRequest())
    won = found.solution
    options = Options(reaction=won.reaction)
    folder = write_workspace(found.scenario, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    calm = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), **PLAYED, **calm, use_sim_time=True, speed=2) as run:
        run.until(lambda: run.now()["status"] == "running")
        run.publish("guest:ring")
        assert run.until_step("bot_gate2hall")["places"]["obj2"] == "atRisk_3"
        run.until(lambda: run.now()["clocks"]["Cbot"] > 2.6)
        run.publish("bot_going_gate_to_hall2hall")
        run.until_step("wipe")
        run.until(lambda: run.now()["clocks"]["Cbot"] > 2.6)
        run.publish("wipeDONE")
        run.until_step("bot_hall2gate")
        run.until(lambda: run.now()["clocks"]["Cbot"] > 2.6)
        run.publish("bot_going_hall_to_gate2gate")
        assert run.until_step("bot_going_hall_to_gate2gate")["places"]["obj2"] == "atCharger_3"
        assert run.until_step("obj2_atCharger_32charged_2")["places"]["obj2"] == "charged_2"
        run.publish("guest:ring")
        run.until(lambda: run.now()["places"]["obj2"] == "atRisk_2")
        assert run.steps()[-2:] == ["ring", "bot_gate2hall"]
