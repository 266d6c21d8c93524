"""Missions without a goal on ROS: they end after a time, or when a person finishes them, and say what was kept."""

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

ERRANDS = """\
poi "desk"
poi "shelf"
poi "window"
connect desk and shelf distance 4
connect desk and window distance 9
event "call" location window
event "fetch" location shelf duration 3
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" mobile 3 location window can_do call
objective: if call then fetch within 40
"""


def workspace(ros: Ros, text: str, folder: Path) -> Path:
    """The workspace of this scenario."""
    read = parse(text, "errands.pur", "errands")
    won = solve_scenario(read, DEFAULT)
    options = Options(reaction=DEFAULT.reaction)
    return lay_over(ros, write_workspace(read, won.network, won.objective, won.strategy, options, folder))


def test_after_its_time_a_mission_ends_by_itself(ros: Ros, tmp_path: Path) -> None:
    over = workspace(ros, f"{ERRANDS}mission ends after 25\n", tmp_path / "ws")
    with launched(ros, over, tmp_path, ("bot",), mode="still", use_sim_time=True, speed=5) as run:
        assert run.until_over() == "won", run.output()
        output, last = run.output(), run.states()[-1]
        assert not run.orders()
    assert "the mission runs; it ends after 25 time units" in output
    assert "kept: if call then fetch within 40 (never answered)." in output
    assert last["clocks"]["Cbot"] == pytest.approx(25.0, abs=0.2)


def test_who_finishes_a_mission_lets_the_robots_answer_what_is_due(ros: Ros, tmp_path: Path) -> None:
    over = workspace(ros, ERRANDS, tmp_path / "ws")
    with launched(ros, over, tmp_path, ("bot",), mode="still", time_unit=2) as run:
        run.until(lambda: run.now()["status"] == "running")
        run.publish("visitor:call")
        run.until_step("bot_desk2shelf")
        run.publish("Finish!")
        assert run.until_over() == "won", run.output()
        output, last, orders = run.output(), run.states()[-1], run.orders()
    assert "the mission ends as soon as what is due is answered: if call then fetch within 40" in output
    assert "kept: if call then fetch within 40 (answered once, after " in output
    assert last["places"]["bot"] == "shelf" and len(orders) == 2 and orders[-1] == ("bot", "fetch"), orders
