"""Requests that cannot be used are answered with what was expected."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.replanning import replan
from tests.tools.replanning.plays import beginning
from tests.waiting import PATIENCE, until

GOOD = beginning("thesis/scenario_1")
NAN = float("nan")


def without(data: Dict[str, Any], key: str) -> Dict[str, Any]:
    return {name: value for name, value in data.items() if name != key}


def with_game(**changed: Any) -> Dict[str, Any]:
    return {**GOOD, "game": {**GOOD["game"], **changed}}


def with_rules(**changed: Any) -> Dict[str, Any]:
    return with_game(rules={**GOOD["game"]["rules"], **changed})


BAD = {
    "a list": ([], "the request is"),
    "no format": (without(GOOD, "format"), "no format"),
    "another format": ({**GOOD, "format": 2}, "format of the request is 2"),
    "no game": (without(GOOD, "game"), "no game"),
    "a game of another format": (with_game(format=7), "format of game is 7"),
    "no scenario": ({**GOOD, "game": without(GOOD["game"], "scenario")}, "no scenario"),
    "a broken scenario": (with_game(scenario="poi a"), ""),
    "a scenario with errors": (with_game(scenario=GOOD["game"]["scenario"].replace("location c", "location x")), ""),
    "unknown ends": (with_rules(ends="never"), "ends is 'never'"),
    "a negative reaction": (with_rules(reaction=-1), "reaction is -1"),
    "a reaction that is no number": (with_rules(reaction="soon"), "reaction is 'soon'"),
    "a negative slack": (with_rules(slack={"bot1": -2}), "slack of bot1 is -2"),
    "slack for nobody": (with_rules(slack={"bot9": 2}), "bot9"),
    "unknown controllers": (with_game(controllers="many"), "many"),
    "an unknown policy": (with_game(reach_obj="bot9"), "bot9"),
    "a place that is not there": ({**GOOD, "locations": {**GOOD["locations"], "bot1": "mars"}}, "no location mars"),
    "a place that is a number": ({**GOOD, "locations": {**GOOD["locations"], "bot1": 3}}, "bot1 is 3"),
    "nobody's place": ({**GOOD, "locations": without(GOOD["locations"], "bot1")}, "no location of bot1"),
    "a value that is text": ({**GOOD, "values": {**GOOD["values"], "Prule1": "0"}}, "Prule1 is '0'"),
    "no value": ({**GOOD, "values": without(GOOD["values"], "Prule1")}, "no value of Prule1"),
    "a clock that is missing": ({**GOOD, "clocks": without(GOOD["clocks"], "Cbot1")}, "no clock of Cbot1"),
    "a clock below zero": ({**GOOD, "clocks": {**GOOD["clocks"], "Cbot1": -1.0}}, "Cbot1 is -1.0"),
    "a clock that is no number": ({**GOOD, "clocks": {**GOOD["clocks"], "Cbot1": NAN}}, "Cbot1 is nan"),
    "no clocks": ({**GOOD, "clocks": None}, "clocks is None"),
    "no ahead": (without(GOOD, "ahead"), "no ahead"),
    "ahead of nothing": ({**GOOD, "ahead": True}, "ahead is True"),
    "excused strangers": ({**GOOD, "excused": ["bot9"]}, "bot9 is excused"),
    "excused text": ({**GOOD, "excused": "bot1"}, "excused is 'bot1'"),
    "turning strangers": ({**GOOD, "turning": ["bot9"]}, "bot9 is turning"),
    "turning text": ({**GOOD, "turning": "bot1"}, "turning is 'bot1'"),
    "blocked text": ({**GOOD, "blocked": "c"}, "blocked is 'c'"),
    "blocked places": ({**GOOD, "blocked": ["c", "b"]}, "blocked is ['c', 'b']"),
    "a blocked way of three places": ({**GOOD, "blocked": [["a", "c", "b"]]}, "blocked is [['a', 'c', 'b']]"),
    "a blocked way that is none": ({**GOOD, "blocked": [["a", "b"]]}, "blocked is [['a', 'b']]"),
    "a way that is blocked for strangers": ({**GOOD, "blocked": [["b", "c", "bot9"]]}, "blocked is [['b', 'c', 'bot9'"),
    "a way that is blocked for two": ({**GOOD, "blocked": [["b", "c", "bot1", "bot2"]]}, "blocked is [['b', 'c', "),
    "a blocked way of numbers": ({**GOOD, "blocked": [[{}, 1]]}, "blocked is [[{}, 1]]"),
    "awaited strangers": ({**GOOD, "awaited": {"bot9": 3.0}}, "bot9 is awaited"),
    "an awaited list": ({**GOOD, "awaited": ["bot1"]}, "awaited is ['bot1']"),
    "an agent that is awaited for less than no time": ({**GOOD, "awaited": {"bot1": -1.0}}, "bot1 is -1.0"),
    "a limit of nothing": ({**GOOD, "limit": 0}, "limit is 0"),
}


@pytest.mark.parametrize("kind", BAD)
def test_what_cannot_be_used_is_reported(kind: str) -> None:
    request, message = BAD[kind]
    with pytest.raises(PursueError) as caught:
        replan(request)  # type: ignore[arg-type]
    assert caught.value.exit_status == 2
    assert message in str(caught.value)
    assert all(finding.hint or finding.span for finding in caught.value.diagnostics)


def test_what_the_network_does_not_have_is_nobody_s_business() -> None:
    clocks, locations = {**GOOD["clocks"], "elapsed": 9.0}, {**GOOD["locations"], "moon": "full"}
    assert replan({**GOOD, "clocks": clocks, "locations": locations}) == replan(GOOD)


def run(text: bytes) -> "subprocess.CompletedProcess[bytes]":
    return subprocess.run([sys.executable, "-m", "pursue_gen", "replan"], input=text, capture_output=True, check=False)


def test_the_command_reads_a_request_and_writes_its_answer() -> None:
    done = run(json.dumps(GOOD).encode())
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads(done.stdout) == replan(GOOD)
    lost = run(json.dumps({**GOOD, "excused": ["bot1"]}).encode())
    assert lost.returncode == 0 and json.loads(lost.stdout)["won"] is False


@pytest.mark.parametrize("text", [b"", b"{", b"\xff", b"[" * 100_000, json.dumps({**GOOD, "format": 3}).encode()])
def test_the_command_says_what_is_wrong_with_its_input(text: bytes) -> None:
    done = run(text)
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"error" in done.stderr and b"Traceback" not in done.stderr


def test_without_a_limit_it_takes_the_time_that_it_needs() -> None:
    assert replan(without(GOOD, "limit")) == replan(GOOD)


def cpu_seconds(process: "subprocess.Popen[bytes]") -> float:
    """The processor time of a process so far."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / float(os.sysconf("SC_CLK_TCK"))


@pytest.mark.parametrize("searching", [False, True])
def test_the_command_ends_when_nobody_reads_its_answer_any_more(searching: bool) -> None:
    """The observer was killed: the planner waits for its request, or is in the middle of a search that takes hours."""
    command = [sys.executable, "-m", "pursue_gen", "replan"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdin is not None and process.stdout is not None
    if searching:
        # They matter: each can do what the robots wait for.
        walkers = "".join(f'agent "walker{n}" mobile {n + 1} location a can_do bot1_inb\n' for n in range(5))
        game = {**GOOD["game"], "scenario": GOOD["game"]["scenario"] + walkers}
        there = {f"walker{n}": "a" for n in range(5)}
        places = {f"Pwalker{n}": 1 for n in range(5)}
        process.stdin.write(json.dumps({
            **without(GOOD, "limit"), "game": game, "locations": {**GOOD["locations"], **there},
            "values": {**GOOD["values"], **places}, "clocks": {**GOOD["clocks"], **{f"C{name}": 0.0 for name in there}},
        }).encode())
        process.stdin.close()
        until(lambda: process.poll() is not None or cpu_seconds(process) > 2, "it searches")
    process.stdout.close()
    assert process.wait(PATIENCE) == 141
