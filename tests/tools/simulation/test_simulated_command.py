"""`pursue-gen sim` as a person calls it."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from stages import SCENARIOS

from tests.cli.test_commands import pursue

FIRST, THIEF = (SCENARIOS / "thesis" / f"{name}.pur" for name in ("scenario_1", "catch_the_thief"))


def called(*words: Any) -> "subprocess.CompletedProcess[str]":
    """The command in this process."""
    done = pursue("sim", *words)
    assert "Traceback" not in done.err, done.err
    return subprocess.CompletedProcess(words, done.status, done.out, done.err)


def hashed(seed: int, *words: Any) -> "subprocess.CompletedProcess[str]":
    """The command in a process of its own with this seed of hashes."""
    command = [sys.executable, "-m", "pursue_gen", "sim", *map(str, words)]
    environ = {**os.environ, "PYTHONHASHSEED": str(seed)}
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, env=environ)
    assert "Traceback" not in done.stderr, done.stderr
    return done


def test_a_table_and_what_is_guaranteed() -> None:
    done = called(THIEF, "--runs", 30, "--seed", 5)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].split() == ["outcome", "missions", "%", "min", "median", "worst"]
    assert lines[2].split()[:4] == ["goal", "reached", "30", "100.0"]
    assert "Time to the goal: at most 20.9 time units" in done.stdout
    assert f"next: pursue-gen ws {shlex.quote(str(THIEF))}" in done.stderr


def test_a_mission_is_not_over_before_the_goal_can_be_reached(tmp_path: Path) -> None:
    slow = tmp_path / "slow.pur"
    slow.write_text(
        'poi "room"\nevent "mop" location room duration 1200\n'
        'agent "bot" controllable location room can_do mop\nreach_objective: do mop\n'
    )
    done = called(slow, "--runs", 2)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[2].split()[:4] == ["goal", "reached", "2", "100.0"]


def test_how_often_objectives_were_called_upon_is_told() -> None:
    carts = SCENARIOS / "airport" / "two_carts.pur"
    words = (carts, "--until", 60, "--runs", 8)
    (said,) = (line for line in called(*words).stdout.splitlines() if line.startswith("if checkIn then unload"))
    (told,) = json.loads(called(*words, "--json").stdout)["objectives"]
    assert (told["objective"], told["limit"]) == ("if checkIn then unload within 20", 20)
    assert told["calls"] > 8 and 0 < told["worst"] <= 20 and told["untried"] < 4
    assert said.split()[-4:] == [str(told["calls"]), f"{told['worst']:.2f}", "20", str(told["untried"])]
    still = json.loads(called(*words, "--opponent", "still", "--json").stdout)["objectives"][0]
    assert still == {**told, "calls": 0, "worst": None, "untried": 8}


def test_a_deadline_is_kept_in_every_mission() -> None:
    done = called(FIRST, "--runs", 30, "--within", "23.4", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["outcomes"]["goal"]["missions"] == 30
    assert found["outcomes"]["goal"]["worst"] <= found["bound"] <= 23.4
    late = called(FIRST, "--runs", 3, "--within", "20")
    assert late.returncode == 4 and "SYN023" in late.stderr


def test_neither_the_number_of_processes_nor_the_hash_seed_changes_what_comes_out() -> None:
    words = (FIRST, "--runs", 45, "--faults", "delay,loss,deaths", "--json")
    alone, both = (hashed(jobs, *words, "--jobs", jobs) for jobs in (1, 2))
    assert alone.returncode == both.returncode == 0, alone.stderr + both.stderr
    assert json.loads(alone.stdout) == json.loads(both.stdout)
    facts = json.loads(alone.stdout)
    assert (facts["missions"], facts["faults"]) == (45, ["delay", "loss", "deaths"])
    assert sum(row["missions"] for row in facts["outcomes"].values()) == 45
    assert set(facts["happened"]) == {"delay", "loss", "deaths"}


def test_new_plans_are_the_same_for_each_hash_seed() -> None:
    words = (THIEF, "--runs", 5, "--faults", "late,failed,silent", "--json")
    one, other = (hashed(seed, *words) for seed in (1, 2))
    assert json.loads(one.stdout)["planned"] > 0
    assert json.loads(one.stdout) == json.loads(other.stdout)


def test_a_failure_is_shown_with_its_play_and_can_be_repeated() -> None:
    done = called(THIEF, "--runs", 6, "--seed", 3, "--until", 8)
    assert done.returncode == 1
    assert "it neither reached the goal nor stopped" in done.stderr
    again = next(line for line in done.stderr.splitlines() if line.startswith("again: "))
    words = shlex.split(again[len("again: ") :])
    assert words[:2] == ["pursue-gen", "sim"]
    assert "--runs" in words and words[words.index("--runs") + 1] == "1"
    repeated = called(*words[2:])
    assert repeated.returncode == 1
    play = [line for line in done.stderr.splitlines() if line.startswith("    ")]
    assert play == [line for line in repeated.stderr.splitlines() if line.startswith("    ")]
    assert any("state 2: reachObj_going_initial_location2unlocked by reachObj" in line for line in play)


def test_the_faults_are_listed() -> None:
    done = called(THIEF, "--faults", "help")
    assert done.returncode == 0
    assert [line.split()[0] for line in done.stdout.splitlines()][:2] == ["delay", "loss"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--faults", "rain"), "there are no faults called rain"),
        (("--until", "-3"), "--until is -3"),
        (("--runs", "0"), "Invalid value for '--runs'"),
        (("--opponent", "evil"), "Invalid value for '--opponent'"),
        (("--reaction", "soon"), "the reaction is 'soon'"),
        (("--reach-obj", "nobody"), "'nobody' cannot have reachObj's commands"),
    ],
)
def test_bad_options_are_refused(words: Any, message: str) -> None:
    done = called(THIEF, "--runs", 3, *words)
    assert done.returncode == 2
    assert message in done.stderr


def test_a_lost_scenario_is_not_simulated() -> None:
    done = called(THIEF, "--reaction", "3")
    assert done.returncode == 4
    assert "cannot be met" in done.stderr


def test_ctrl_c_ends_all_processes() -> None:
    command = [sys.executable, "-m", "pursue_gen", "sim", str(THIEF), "--runs", "1000000", "--jobs", "2"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True) as process:
        try:
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
            while process.poll() is None and len(children.read_text().split()) < 2:
                time.sleep(0.05)
            os.killpg(process.pid, signal.SIGINT)
            _, errors = process.communicate(timeout=300)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 130, errors
    assert b"Traceback" not in errors
