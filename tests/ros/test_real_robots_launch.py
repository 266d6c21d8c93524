"""`simulate:=false` as it is documented: robots of move_base win the mission, and a person reports whoever is real."""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import os
import re
import time
from pathlib import Path
from typing import Any, Callable, Dict

import pytest
import yaml
from ros_world import SCENARIOS, Ros, end, generated, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace
from tests.waiting import PATIENCE, until

pytestmark = pytest.mark.ros

FAKE = Path(__file__).resolve().parent / "fake_move_base.py"
PAGE = SCENARIOS.parent / "docs" / "robots.md"
SLACK = 100
"""Time units by which ends may be late in the model: they come in real time, and a machine may stand still."""

VISITED = """
poi "a" poi "b"
connect a and b distance 2
event "greet" location b duration 1
agent "bot" controllable mobile 1 location a can_do greet
agent "visitor" mobile 1 location b
reach_objective: do greet
"""


def documented() -> str:
    """The launch line of docs/robots.md, for scenario_1."""
    page = PAGE.read_text(encoding="utf-8")
    lines = set(re.findall(r"^ +(rosrun my_floor_bringup run_mission .*)$", page, re.MULTILINE))
    (line,) = lines
    return str(line).replace("my_floor", "scenario_1")


def next_position(address: str, robot: str, start: Any) -> Any:
    """Where the page is said that a robot is, and its path: as soon as that is more than 0.2 m from its start."""
    from tornado.httpclient import HTTPRequest
    from tornado.websocket import websocket_connect

    async def received() -> Any:
        request = HTTPRequest(address.replace("http", "ws") + "live", headers={"Origin": address.rstrip("/")})
        page = await websocket_connect(request)
        while True:
            message: Dict[str, Any] = json.loads(await page.read_message())
            position = message.get("positions", {}).get(robot)
            if position is not None and math.dist(position[:2], start) > 0.2:
                page.close()
                return position, message["paths"].get(robot)

    return asyncio.run(asyncio.wait_for(received(), PATIENCE))


def test_the_documented_line_wins_the_mission_on_robots_with_move_base(ros: Ros, tmp_path: Path) -> None:
    wanted = "move_base_msgs.msg, actionlib_msgs.msg, tf2_ros"
    if ros.run(f"python3 -c 'import {wanted}'", ros.home).returncode:
        pytest.skip(f"not all of {wanted} is here")
    workspace = lay_over(ros, generated("thesis/scenario_1", tmp_path / "ws", slack={"bot1": SLACK, "bot2": SLACK}))
    poses = yaml.safe_load((workspace / "src/controller_bot1/config/poses.yaml").read_text())["poses"]
    acts = {"bot1": 3.5, "bot2": 6.5}
    robots = {name: {"start": poses["c"][:2], "travel": 9.5, "acts": seconds} for name, seconds in acts.items()}
    (tmp_path / "robots.yaml").write_text(yaml.safe_dump({"robots": robots}))
    with ros.master() as there, contextlib.ExitStack() as cleanup:
        ros.run(f"rosparam load {tmp_path}/robots.yaml /fake_move_base", workspace, **there)
        fakes = ros.start(f"exec python3 {FAKE}", workspace, tmp_path / "robots", **there)
        cleanup.callback(end, fakes)
        log = tmp_path / "launch"
        page = "web:=true port:=0 autostart:=true output:=screen"
        launch = ros.start(f"source devel/setup.bash; exec {documented()} {page}", workspace, log, **there)
        cleanup.callback(end, launch)
        until(lambda: "The page is at" in log.read_text(errors="replace"), "the page")
        (address,) = set(re.findall(r"The page is at (http://\S+)", log.read_text(errors="replace")))
        (x, y, _), path = next_position(address, "bot1", poses["c"][:2])
        between = [sorted((poses["c"][axis], poses["b"][axis])) for axis in (0, 1)]
        assert all(low - 0.1 <= value <= high + 0.1 for value, (low, high) in zip((x, y), between)), "on its way to b"
        if not ros.run("python3 -c 'import nav_msgs.msg'", ros.home).returncode:
            assert path is not None and math.dist(path[-1], poses["b"][:2]) < 0.1
        assert launch.wait(2 * PATIENCE) == 0, log.read_text()[-8000:]
    assert "The goal is reached" in log.read_text(), log.read_text()[-8000:]


def test_a_person_reports_at_the_terminal_what_a_visitor_and_a_robot_have_done(ros: Ros, tmp_path: Path) -> None:
    scenario, rules = parse(VISITED, "visited.pur"), Rules(slack={"bot": SLACK, "visitor": SLACK})
    won = solve_scenario(scenario, rules)
    folder = tmp_path / "ws"
    write_workspace(scenario, won.network, won.objective, won.strategy, Options(reaction=rules.reaction), folder)
    workspace = lay_over(ros, folder)
    os.mkfifo(tmp_path / "keys")
    keys = os.open(tmp_path / "keys", os.O_RDWR)
    log = tmp_path / "terminal"
    told = f"simulate:=false ends:=words orders:=person time_unit:=0.2 wait:={PATIENCE:g}"
    launch = f"roslaunch visited_bringup mission.launch {told}"
    command = f"source devel/setup.bash; exec script -qefc '{launch}' {log} <{tmp_path}/keys"

    def says(text: str) -> Callable[[], bool]:
        return lambda: re.search(text, log.read_text(errors="replace") if log.exists() else "") is not None

    def does(typed: str, event: str) -> None:
        """Types it until the event is shown."""
        deadline = time.monotonic() + PATIENCE
        while not says(rf"\d\.\d  {event}\b")():
            os.write(keys, f"{typed}\n".encode())
            time.sleep(1.0)
            assert time.monotonic() < deadline, log.read_text(errors="replace")[-6000:]

    with ros.master() as there, contextlib.ExitStack() as cleanup:
        cleanup.callback(os.close, keys)
        terminal = ros.start(command, workspace, tmp_path / "script", TERM="dumb", **there)
        cleanup.callback(end, terminal)
        until(says(r"\d\.\d  bot sets off from a to b"), "the robot sets off")
        does("visitor_b2a", "visitor sets off from b to a")
        until(says("type done visitor when visitor has arrived"), "the person is shown what to type")
        time.sleep(0.5)  # the windows of both arrivals are open: 2 time units
        does("done visitor", "visitor arrives at a")
        does("done bot", "bot arrives at b")
        until(says(r"\d\.\d  bot begins greet\b"), "the robot acts")
        time.sleep(0.5)
        does("done bot", "bot finishes greet")
        until(says("The goal is reached"), "the end")
        assert terminal.wait(PATIENCE) == 0
