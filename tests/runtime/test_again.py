"""again.sh runs a program again when it was killed, and leaves nothing behind."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import List

import pytest

from pursue_gen.workspace import templates_dir
from tests.waiting import PATIENCE, until

ONCE_KILLED = 'echo $$ >>"$0"; [[ $(wc -l <"$0") == 2 ]] && exit 5; kill -9 $$'

COUNTS = """
import signal, sys, time
heard = []
for sign in (signal.SIGINT, signal.SIGTERM):
    signal.signal(sign, lambda number, _: heard.append(number))
open(sys.argv[1], "w").close()
while not heard:
    time.sleep(0.05)
time.sleep(0.4)
open(sys.argv[1], "w").write("".join(f"{number:d} " for number in heard))
sys.exit(3)
"""
"""Notes which signals it gets, and takes its time to end."""


@pytest.fixture
def again(tmp_path: Path) -> List[str]:
    """The words before those of a program that is run again."""
    text = (templates_dir() / "bringup" / "launch" / "again.sh.j2").read_text()
    text = text.replace("{{ scenario }}", "example").replace("{{ generator }}", "0")
    script = tmp_path / "again.sh"
    script.write_text(text)
    return ["bash", str(script)]


@pytest.fixture
def end(again: List[str]) -> List[str]:
    """The words before those of a program whose end is the end of the launch."""
    return [*again, "--end"]


def lives(process: int) -> bool:
    """True while there is such a process, and it is not a dead one that nobody has asked about."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def gone(process: int) -> bool:
    """True as soon as it is no more."""
    return bool(until(lambda: not lives(process), f"the end of process {process}"))


def started(command: List[str], note: Path) -> "tuple[subprocess.Popen[bytes], int]":
    """A program that notes its number and then does nothing, under again.sh in a session of its own."""
    process = subprocess.Popen(
        [*command, "bash", "-c", 'echo $$ >"$0"; exec sleep 1000', str(note)], start_new_session=True
    )
    until(lambda: note.exists() and note.read_text().endswith("\n"), "the program's note")
    return process, int(note.read_text())


def test_the_exit_status_is_passed_on(again: List[str]) -> None:
    for status in (0, 1, 7):
        assert subprocess.run([*again, "bash", "-c", f"exit {status}"], check=False).returncode == status


def test_a_program_that_was_killed_runs_again(again: List[str], tmp_path: Path) -> None:
    note = tmp_path / "note"
    done = subprocess.run([*again, "bash", "-c", ONCE_KILLED, str(note)], capture_output=True, check=False)
    assert (done.returncode, len(note.read_text().split())) == (5, 2)


def test_the_program_reads_what_it_is_given(again: List[str]) -> None:
    done = subprocess.run([*again, "cat"], input="typed\n", capture_output=True, text=True, check=False)
    assert done.stdout == "typed\n"


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("whole", [False, True], ids=["it", "its group"])
def test_who_ends_it_ends_the_program(again: List[str], tmp_path: Path, sign: signal.Signals, whole: bool) -> None:
    process, child = started(again, tmp_path / "note")
    (os.killpg if whole else os.kill)(process.pid, sign)
    assert process.wait(PATIENCE) != 0
    assert gone(child)


def test_a_signal_for_the_whole_group_comes_once(again: List[str], tmp_path: Path) -> None:
    """rospy may wait for ever when a second one interrupts the first."""
    note = tmp_path / "note"
    process = subprocess.Popen([*again, sys.executable, "-c", COUNTS, str(note)], start_new_session=True)
    until(note.exists, "the program's note")
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(PATIENCE) == 3
    assert note.read_text() == "2 "


@pytest.mark.skipif(shutil.which("setpriv") is None, reason="needs setpriv (package util-linux)")
def test_killed_itself_it_takes_the_program_along(again: List[str], tmp_path: Path) -> None:
    process, child = started(again, tmp_path / "note")
    process.kill()
    process.wait()
    assert gone(child)


LAUNCH = """
import signal, subprocess, sys
interrupted = []
signal.signal(signal.SIGINT, lambda *_: interrupted.append(1))
node = subprocess.Popen(sys.argv[1:], start_new_session=True)
while not interrupted and node.poll() is None:
    signal.sigtimedwait([], 0.05)
alone = node.poll() is None
if alone:
    import os
    os.killpg(node.pid, signal.SIGINT)
print("interrupted" if interrupted else "not interrupted", "while it was there" if alone else "", node.wait())
"""
"""What roslaunch does: it ends its nodes when it is interrupted."""


def launched(command: List[str]) -> str:
    done = subprocess.run([sys.executable, "-c", LAUNCH, *command], capture_output=True, text=True, timeout=PATIENCE,
                          check=True)
    return done.stdout.strip()


@pytest.mark.parametrize("status", [0, 1])
def test_the_end_of_the_program_interrupts_the_launch_which_then_ends_the_script(end: List[str], status: int) -> None:
    """So roslaunch has not to say in red that a required process has died."""
    assert launched([*end, "bash", "-c", f"exit {status}"]) == f"interrupted while it was there {status}"


@pytest.mark.parametrize("status", [2, 127])
def test_a_program_that_failed_ends_the_script_and_roslaunch_says_so(end: List[str], status: int) -> None:
    assert launched([*end, "bash", "-c", f"exit {status}"]) == f"not interrupted  {status}"


def test_without_the_option_the_launch_goes_on(again: List[str]) -> None:
    assert launched([*again, "true"]) == "not interrupted  0"


def test_a_roslaunch_for_another_machine_is_not_interrupted(end: List[str], tmp_path: Path) -> None:
    launch = tmp_path / "roslaunch"
    launch.write_text(LAUNCH.replace("sys.argv[1:]", "sys.argv[3:]"))
    command = [sys.executable, str(launch), "-c", "machine-0", *end, "true"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=True)
    assert done.stdout.strip() == "not interrupted  0"


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_whatever_signal_ends_the_program_alone_it_runs_again(end: List[str], tmp_path: Path, sign: int) -> None:
    """Also where the program handles the signal, and exits with the status that shells have for it."""
    for way in (f"kill -{sign:d} $$", f"exit {128 + sign}"):
        note = tmp_path / f"{len(way)}{sign:d}"
        program = f'trap - INT; echo $$ >>"$0"; [[ $(wc -l <"$0") == 2 ]] && exit 5; {way}'
        assert launched([*end, "bash", "-c", program, str(note)]) == "not interrupted  5"
