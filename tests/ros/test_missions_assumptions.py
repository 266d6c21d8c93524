"""A guest calls more often than was assumed: the mission says so, finds a plan without the assumption, and is won. A
mechanic comes when he is called, and then does not."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from pursue_gen.solving.rules import Rules
from pursue_gen.workspace import Options, write_workspace
from tests.assumptions import CAFE, COMES, IN_ALL, ONCE, PLANT, scenario, solved

pytestmark = pytest.mark.ros


@pytest.mark.parametrize(
    ("assumed", "said"), [(ONCE, "guest does call at most once"), (IN_ALL, "others do call at most once in all")]
)
def test_what_breaks_an_assumption_has_happened_and_another_plan_is_found(
    ros: Ros, tmp_path: Path, assumed: str, said: str
) -> None:
    """The observer is killed after the second call: what is broken stays so."""
    text = CAFE.format(assumed)
    won, options = solved(text), Options(reaction=Rules().reaction)
    folder = write_workspace(scenario(text), won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("waiter",), mode="still", use_sim_time=True, speed=2) as run:
        run.until(lambda: run.now()["status"] == "running")
        run.publish("guest:call")
        assert run.until_step("call").status == "running"
        run.until(lambda: run.now()["clocks"]["Cguest"] > 1.1)
        run.publish("guest:call")
        run.until(lambda: said in str(run.now()["reason"]))
        run.until_back("observer", run.kill("observer"))
        run.until(lambda: int(run.now().get("plan", 0)) > 0 and run.now().status == "running")
        assert run.until_over() == "won", run.output()
        assert run.orders()[-1] == ("waiter", "pay")


def test_who_comes_when_called_keeps_an_assumption_and_who_does_not_come_breaks_it(ros: Ros, tmp_path: Path) -> None:
    text = PLANT.format(COMES)
    won, options = solved(text), Options(reaction=Rules().reaction)
    folder = write_workspace(scenario(text), won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), mode="still", use_sim_time=True, speed=4) as run:
        run.until(lambda: run.now()["status"] == "running")
        run.publish("machine:call")
        run.until_step("call")
        run.publish("mechanic:mechanic_canteen2m1")
        run.until_step("handOver")
        assert run.orders() == [("bot", "handOver")] and run.now()["values"]["assume1"] == 1
        run.publish("mechanic:mechanic_m12hall", "mechanic:mechanic_going_m1_to_hall2hall", "machine:call")
        assert run.until_over() == "stopped", run.output()
    assert "what was assumed is broken: mechanic reaches m1 within 20 units after call" in run.output()
