"""run_mission launches, passes signals on, and exits with the verdict that the UI has written."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import List, Optional

import pytest

from pursue_runtime.ui.run_mission import STATUSES, conclude, refusal
from pursue_runtime.ui.verdict import OUTCOMES, Verdict, read_verdict, write_verdict
from tests.waiting import PATIENCE, until

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = """
import sys
from pursue_runtime.data import Package
from pursue_runtime.ui import run_mission
sys.exit(run_mission.main(Package("demo_bringup", "demo", "")))
"""
ELSEWHERE = """
import signal, threading, time
def receive():
    time.sleep(1)
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
threading.Thread(target=receive, daemon=True).start()
"""
"""Another thread of the process receives the signal: what the main thread waits for does not come back for that."""
ROSLAUNCH = """#!/bin/bash
echo "roslaunch $*"
path=${!#}; path=${path#verdict:=}
write() { printf '%s\\n%s\\n' "$1" "$2" >"$path.new"; mv "$path.new" "$path"; }
interrupted() { echo interrupted; {at_signal}; exit 0; }
trap interrupted INT
echo "$$" >"$HERE/started"
{does}
"""
WAITS = "while :; do sleep 0.05; done"


class Launch:
    """run_mission with a program in the place of roslaunch."""

    def __init__(
        self, folder: Path, does: str, *arguments: str, at_signal: str = ":", program: str = PROGRAM
    ) -> None:
        self.folder = folder
        script = folder / "roslaunch"
        script.write_text(ROSLAUNCH.replace("{does}", does).replace("{at_signal}", at_signal), encoding="utf-8")
        script.chmod(0o755)
        there = {"PATH": f"{folder}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT), "HERE": str(folder)}
        self.process = subprocess.Popen(
            [sys.executable, "-c", program, *arguments],
            env={**os.environ, **there},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    def pid(self) -> int:
        """The process in the place of roslaunch, as soon as it waits for a signal."""
        started = self.folder / "started"
        return int(until(lambda: started.exists() and started.read_text(), "roslaunch is started"))

    def ended(self) -> "tuple[int, List[str]]":
        """The exit status, and the lines that were printed."""
        lines = self.process.communicate(timeout=PATIENCE)[0].splitlines()
        return self.process.returncode, lines


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_the_verdict_of_the_ui_is_printed_and_is_the_exit_status(tmp_path: Path, outcome: str) -> None:
    status, lines = Launch(tmp_path, f"write '{outcome}' 'After 3 time units.'", "mode:=still", "seed:=7").ended()
    assert (status, lines[-1]) == (STATUSES[outcome], f"{outcome}: After 3 time units.")
    command = "roslaunch --skip-log-check demo_bringup mission.launch stay:=false mode:=still seed:=7 verdict:=/"
    assert lines[0].startswith(command)
    assert not os.path.exists(os.path.dirname(lines[0].rpartition("verdict:=")[2])), "nothing is left behind"


def test_every_outcome_has_a_status_of_its_own_and_only_a_win_is_0() -> None:
    assert len(set(STATUSES.values())) == len(STATUSES) == len(OUTCOMES) + 1
    assert [outcome for outcome, status in STATUSES.items() if status == 0] == ["won"]


@pytest.mark.parametrize("does", ["exit 1", "exit 0", "kill -9 $$", "write 'nonsense' 'x'", "printf '\\xff' >$path"])
def test_a_launch_without_a_verdict_has_failed(tmp_path: Path, does: str) -> None:
    status, lines = Launch(tmp_path, does).ended()
    assert status == STATUSES["launch failed"] and lines[-1].startswith("launch failed: roslaunch exited with status ")


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_interrupts_the_launch(tmp_path: Path, sign: signal.Signals) -> None:
    launch = Launch(tmp_path, WAITS, at_signal="write interrupted 'The UI was interrupted.'")
    launch.pid()
    launch.process.send_signal(sign)
    status, lines = launch.ended()
    assert (status, lines[-1]) == (4, f"interrupted: {sign.name} was received before the mission ended.")
    assert "interrupted" in lines, "roslaunch got SIGINT"


def test_a_signal_that_does_not_wake_what_it_waits_for_interrupts_the_launch(tmp_path: Path) -> None:
    """As one that comes in the moment before it waits."""
    status, lines = Launch(tmp_path, WAITS, program=ELSEWHERE + PROGRAM).ended()
    assert (status, lines[-1]) == (4, "interrupted: SIGTERM was received before the mission ended.")


@pytest.mark.parametrize("at_signal, line", [
    ("write won 'In time.'", "won: In time."),
    ("write lost 'In time.'", "lost: In time."),
    ("write stopped 'The master is gone.'", "interrupted: SIGTERM was received before the mission ended."),
    (":", "interrupted: SIGTERM was received before the mission ended."),
])
def test_what_the_mission_came_to_while_it_was_interrupted_counts(tmp_path: Path, at_signal: str, line: str) -> None:
    launch = Launch(tmp_path, WAITS, at_signal=at_signal)
    launch.pid()
    launch.process.terminate()
    assert launch.ended()[1][-1] == line


def test_a_signal_after_the_verdict_changes_nothing(tmp_path: Path) -> None:
    launch = Launch(tmp_path, f"write stopped 'No plan.'; echo $$ >$HERE/written; {WAITS}")
    until((tmp_path / "written").exists, "the verdict is written")
    launch.process.terminate()
    status, lines = launch.ended()
    assert (status, lines[-1]) == (2, "stopped: No plan.")


def test_roslaunch_ends_with_run_mission_even_if_that_is_killed(tmp_path: Path) -> None:
    launch = Launch(tmp_path, "trap 'exit 0' TERM; " + WAITS)
    process = launch.pid()
    launch.process.kill()
    until(lambda: gone(process), "roslaunch has ended")
    launch.ended()


def gone(process: int) -> bool:
    """True where there is no such process, or it has ended."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.parametrize("argument, why", [
    ("--wait", "expected NAME:=VALUE"),
    ("mode=still", "expected NAME:=VALUE"),
    ("again:=true", "one mission is played"),
    ("required:=false", "the launch ends with the UI"),
    ("stay:=true", "the page ends with the mission"),
    ("verdict:=/tmp/x", "it is set here"),
    ("nodes:=observer", "starts no UI"),
])
def test_arguments_that_give_no_verdict_are_refused(argument: str, why: str) -> None:
    assert why in refusal(["mode:=still", argument])


def test_other_arguments_are_passed_on() -> None:
    assert refusal([]) == refusal(["nodes:=UI, observer", "trace:=/a b/c.yaml", "machines:=x:=y"]) == ""


def test_arguments_that_are_refused_launch_nothing(tmp_path: Path) -> None:
    status, lines = Launch(tmp_path, "exit 0", "again:=true").ended()
    assert (status, lines) == (5, ["launch failed: again is not an argument here: one mission is played"])


def test_help_lists_the_statuses(tmp_path: Path) -> None:
    status, lines = Launch(tmp_path, "exit 0", "--help").ended()
    assert status == 0 and lines[0].startswith("rosrun demo_bringup run_mission")
    for outcome, number in STATUSES.items():
        assert any(line.startswith(f"  {number}  {outcome}: ") for line in lines), outcome


def test_a_verdict_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = str(tmp_path / "verdict")
    assert read_verdict(path) is None
    write_verdict(path, Verdict("lost", "Two\nlines."))
    assert read_verdict(path) == Verdict("lost", "Two lines.")
    write_verdict(path, Verdict("won", "Then one."))
    assert read_verdict(path) == Verdict("won", "Then one.")
    assert os.listdir(tmp_path) == ["verdict"]
    write_verdict("", Verdict("won", "Nobody wants it."))


def test_a_verdict_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "verdict").mkdir()
    with pytest.raises(OSError):
        write_verdict(str(tmp_path / "verdict"), Verdict("won", "It is a folder."))
    assert os.listdir(tmp_path) == ["verdict"]


@pytest.mark.parametrize("verdict, stopped_by, outcome", [
    (None, "", "launch failed"),
    (None, "SIGINT", "interrupted"),
    (Verdict("stopped", ""), "", "stopped"),
    (Verdict("stopped", ""), "SIGTERM", "interrupted"),
    (Verdict("won", ""), "SIGTERM", "won"),
])
def test_the_outcome_of_a_launch(verdict: Optional[Verdict], stopped_by: str, outcome: str) -> None:
    assert conclude(verdict, 0, stopped_by).outcome == outcome
