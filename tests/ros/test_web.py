"""The UI as a page: a real mission, watched and driven in a real browser."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
import time
import zlib
from pathlib import Path
from typing import Callable, Iterator, Tuple
from xmlrpc.client import ServerProxy

import pytest
from preloaded import process_of
from ros_world import SCENARIOS, Ros, end, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace
from tests.waiting import PATIENCE

pytest.importorskip("tornado", reason="tornado is not installed: apt install python3-tornado")
from browser import Browser, browser, program

pytestmark = [
    pytest.mark.ros,
    pytest.mark.skipif(program() is None, reason="Chromium is not installed: apt install chromium, or ./run test"),
]

Build = Callable[..., Path]
Mission = Tuple[Browser, "subprocess.Popen[bytes]", str]
PLACE = "document.querySelector('[data-agent=polBot1]').getAttribute('transform')"
"""Where a robot is drawn on the map."""


@contextlib.contextmanager
def mission(ros: Ros, workspace: Path, tmp_path: Path, scenario: str, *arguments: str) -> Iterator[Mission]:
    """Launches a mission with a page, and opens that; the page, the launch, and the address of its master."""
    log = tmp_path / "log"
    with ros.master() as there, browser(tmp_path / "profile") as page:
        for parameter in (argument for argument in arguments if argument.startswith("/")):
            ros.run(f"rosparam set {parameter}", workspace, **there)
        there = {**there, "ROS_HOME": str(tmp_path / "ros")}
        wanted = " ".join(argument for argument in arguments if not argument.startswith("/"))
        launch = f"roslaunch {scenario}_bringup mission.launch web:=true port:=0 output:=screen {wanted}"
        command = f"source devel/setup.bash && exec {launch}"
        launched = ros.start(command, workspace, log, **there)
        try:
            deadline = time.monotonic() + PATIENCE
            found = None
            while found is None:
                assert launched.poll() is None and time.monotonic() < deadline, log.read_text(errors="replace")
                found = re.search(r"The page is at (http://\S+)", log.read_text(errors="replace"))
                time.sleep(0.1)
            page.open(found.group(1))
            page.wait("!document.getElementById('main').hidden")
            yield page, launched, there["ROS_MASTER_URI"]
        finally:
            end(launched)


def button(name: str) -> str:
    """Whether a button is disabled."""
    return f"document.getElementById('{name}').getAttribute('aria-disabled')"


def node_of(uri: str, node: str) -> int:
    """The process of a node."""
    with ServerProxy(uri) as master:
        address = master.lookupNode("/test", f"/{node}")[2]  # type: ignore[index]
    with ServerProxy(str(address)) as slave:
        return int(slave.getPid("/test")[2])  # type: ignore[index,call-overload]


@contextlib.contextmanager
def without_observer(uri: str, launched: "subprocess.Popen[bytes]") -> Iterator[None]:
    """The observer is killed, and roslaunch does not start it again before the end."""
    works = process_of(launched.pid)
    os.kill(works, signal.SIGSTOP)
    try:
        os.kill(node_of(uri, "observer"), signal.SIGKILL)
        yield
    finally:
        os.kill(works, signal.SIGCONT)


def is_drawn(png: bytes) -> bool:
    """True for a PNG that is not of one colour."""
    parts = re.findall(rb"IDAT", png)
    data, at = b"", 8
    while parts and at < len(png):
        size = int.from_bytes(png[at:at + 4], "big")
        data += png[at + 8:at + 8 + size] if png[at + 4:at + 8] == b"IDAT" else b""
        at += size + 12
    return png.startswith(b"\x89PNG") and len(set(zlib.decompress(data))) > 32


def fits(page: Browser) -> bool:
    """True where nobody has to scroll sideways."""
    return bool(page.value("document.documentElement.scrollWidth <= window.innerWidth && window.innerWidth <= 360"))


def test_a_mission_is_started_watched_and_won_on_a_page(ros: Ros, built: Build, tmp_path: Path) -> None:
    workspace = built("thesis/catch_the_thief")
    with mission(ros, workspace, tmp_path, "catch_the_thief", "mode:=still", "time_unit:=0.5") as (page, launched, _):
        page.wait("document.getElementById('status').textContent === 'ready'")
        page.screen(360, 740)
        assert fits(page)
        page.screen(1200, 800)
        assert page.value("document.querySelectorAll('#map .poi').length") == 4
        assert page.value("document.querySelectorAll('#map .way').length") == 4
        before = page.value(PLACE)
        page.value("document.getElementById('start').focus()")
        page.key("Enter", 13, "\r")
        page.wait("document.getElementById('status').textContent === 'running'")
        page.wait(f"{PLACE} !== {before!r}")
        page.wait("document.getElementById('agents').textContent.includes('because thief is at c (if it were at ')")
        assert "to be reached" in page.text("#objectives") and "catch happens." in page.text("#objectives .says")
        places = {before}
        while len(places) <= 5:
            assert page.text("#status") == "running", "the robot moves along, it does not jump from point to point"
            places.add(page.value(PLACE))
            time.sleep(0.05)
        assert float(page.text("#now")) > 0
        assert is_drawn(page.picture())
        page.wait("document.getElementById('status').textContent === 'won'")
        assert "The goal is reached" in page.text("#why")
        page.screen(360, 740)
        assert fits(page)
        assert is_drawn(page.picture(whole=True))
        page.open(page.value("location.href"))
        page.wait("document.getElementById('status').textContent === 'won'")
        assert "The goal is reached" in page.text("#why"), "the page outlives the mission"
        page.wait(f"{button('another')} === 'false'")
        code = "(document.querySelector('#recorded code') || document.body).textContent"
        page.wait(f"{code}.includes('-1.jsonl')")  # the journal of the mission that waits has its first name
        command = page.value(code)
        name, *words = shlex.split(command)
        done = subprocess.run([sys.executable, "-m", name.replace("-", "_"), *words], capture_output=True, text=True)
        assert done.returncode in (0, 1) and "arrives at" in done.stdout, f"{command}: {done.stderr}"
        page.click("#another")
        page.wait("document.getElementById('status').textContent === 'ready'")
        page.wait("document.getElementById('missions-count').textContent === 'Missions played here (1)'")
        assert "won" in page.text("#missions-list")
        page.click("#start")
        page.wait("document.getElementById('status').textContent === 'running'")
        page.click("#stop")
        page.click("#stop-yes")
        page.wait("document.getElementById('status').textContent === 'stopped'")
        page.wait("document.querySelectorAll('#missions-list li').length === 2")
        page.click("#close")
        page.click("#close-yes")
        page.wait("document.getElementById('link').textContent === 'the mission has ended'")
        assert launched.wait(PATIENCE) == 0
        assert page.complaints == []


def test_an_agent_that_nobody_controls_is_moved_and_the_mission_stopped(ros: Ros, built: Build, tmp_path: Path) -> None:
    workspace = built("thesis/catch_the_thief")
    button = "document.querySelector('[data-word=thief_c2b]')"
    given = "mode:=still", "time_unit:=8.0", "stay:=false"
    with mission(ros, workspace, tmp_path, "catch_the_thief", *given) as (page, launched, uri):
        page.wait("document.getElementById('status').textContent === 'ready'")
        assert page.value(f"{button}.getAttribute('aria-disabled')") == "true", "not before the start"
        page.click("[data-word=thief_c2b]")
        page.click("#start")
        page.wait(f"{button}.textContent.includes('in ')")
        page.wait(f"{button}.getAttribute('aria-disabled') === 'false'")
        assert page.value("document.querySelector('[data-word=thief_a2b]').getAttribute('aria-disabled')") == "true"
        page.click("[data-word=thief_c2b]")
        page.wait("document.getElementById('log').textContent.includes('thief sets off from c to b')")
        assert page.text("#log").count("thief sets off") == 1, "the press before the start did nothing"
        page.wait("document.getElementById('agents').textContent.includes('from c to b')")
        with without_observer(uri, launched):
            says = "the observer does not answer; this is as of"
            page.wait(f"document.getElementById('link').textContent.includes({says!r})")
        page.wait("document.getElementById('log').textContent.includes('the observer answers again')")
        page.wait("document.getElementById('link').textContent === 'connected'")
        assert page.text("#status") == "running" and page.text("#log").count("thief sets off") == 1
        page.click("#stop")
        page.wait("document.getElementById('sure').open")
        page.click("#stop-no")
        assert page.text("#status") == "running"
        with without_observer(uri, launched):
            page.wait("document.getElementById('link').textContent.includes('the observer does not answer')")
            page.click("#stop")
            page.click("#stop-yes")
            page.wait("document.getElementById('remark').textContent.includes('is stopped as soon as it does')")
        page.wait("document.getElementById('status').textContent === 'stopped'")
        page.wait("document.getElementById('link').dataset.is === 'away'")
        launched.wait(PATIENCE)
        assert page.complaints == []


def test_a_person_gets_instructions_and_says_when_it_is_done(ros: Ros, tmp_path: Path) -> None:
    """Nobody else reports what the person does; their word goes by the plan, in the middle of its window."""
    text = (SCENARIOS / "thesis/scenario_1.pur").read_text(encoding="utf-8")
    scenario = parse(text.replace('"bot2" controllable', '"bot2" human controllable'), "ward.pur", "ward")
    won = solve_scenario(scenario, Rules())
    options = Options(reaction=Rules().reaction)
    folder = write_workspace(scenario, won.network, won.objective, won.strategy, options, tmp_path / "ward")
    workspace = lay_over(ros, folder)
    planned = "document.querySelector('#tasks .task-time').textContent.match(/for ([0-9.]+); planned ([0-9.]+)/)"
    given = "time_unit:=0.8", "stay:=false", "/simulator/reports '[bot1]'"
    with mission(ros, workspace, tmp_path, "ward", *given) as (page, launched, _):
        page.wait("document.getElementById('status').textContent === 'ready'")
        page.screen(360, 740)
        page.click("#start")
        told = set()
        over = "['won', 'lost', 'stopped'].includes(document.getElementById('status').textContent)"
        ready = f"{planned} && Number({planned}[1]) > Number({planned}[2]) + 0.1"
        while page.wait(f"({over} ? 'over' : {ready})") != "over":
            told.add(page.text("#tasks .task"))
            page.click("#tasks .done")
            page.wait(f"{over} || document.querySelector('#tasks li.idle') !== null")
        assert page.text("#status") == "won", page.text("#log")
        assert told == {"bot2: go to a", "bot2: do bot2_ina at a"}
        assert fits(page)
        assert launched.wait(PATIENCE) == 0
        assert page.complaints == []
