"""The line that shows on a terminal how far a search is, and Ctrl-C while it is shown."""

from __future__ import annotations

import contextlib
import io
import os
import pty
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Callable, List, Optional
from unittest import mock

import pytest

from pursue_gen.cli import progress as progress_module
from pursue_gen.cli.progress import in_words, progress_line
from pursue_gen.synthesis.limits import PROVING, Progress
from tests.cli.test_commands import FIRST, ROOT, Outcome, Terminal, called, pursue
from tests.large_scenarios import many_walkers

ERASE = "\r\033[K"
IMPATIENT = "import pursue_gen.cli.progress as line; line._PATIENCE = line._REDRAW = 0.0"
QUICKLY_EXPLAINED = "import pursue_gen.explanation.costs as costs; costs.SECONDS = 1.0"
SLOW_CHECKER = """
import time
from pursue_gen.synthesis.limits import PROVING, LimitMonitor
quick = LimitMonitor.check
def slow(self, states, waiting):
    quick(self, states, waiting)
    time.sleep(300 if self._phase == PROVING else 0)
LimitMonitor.check = slow
"""


class Screen(io.StringIO):
    """A terminal that shows as much as it is told."""

    def isatty(self) -> bool:
        return True


def on_terminal(
    *arguments: object, changed: str = "", until: Optional[str] = None, times: int = 1
) -> Outcome:
    """Runs the program, some of it `changed`, with stderr on a terminal; Ctrl-C after showing `until` so often."""
    code = f"{changed}\nimport sys\nfrom pursue_gen.cli.app import main\nsys.exit(main())"
    words = [sys.executable, "-c", code, *map(str, arguments)]
    variables = {**os.environ, "TERM": "xterm", "NO_COLOR": "1"}
    ours, its = pty.openpty()
    shown = b""
    process = subprocess.Popen(words, cwd=str(ROOT), env=variables, stdout=subprocess.PIPE, stderr=its, text=True)
    with process:
        os.close(its)
        assert process.stdout is not None
        with contextlib.suppress(OSError):  # how Linux says that nobody writes to a terminal any more
            while True:
                read = os.read(ours, 4096)
                if not read:
                    break
                shown += read
                if until is not None and shown.count(until.encode()) >= times:
                    process.send_signal(signal.SIGINT)
                    until = None
        os.close(ours)
        out = process.stdout.read()
    return Outcome(process.returncode, out, shown.decode("utf-8").replace("\r\n", "\n"))


def seen(*arguments: object, patience: float = 0.0, term: str = "xterm") -> Outcome:
    """Runs the program in this process, its streams terminals."""
    paces = {"_PATIENCE": patience, "_REDRAW": 0.0}
    with mock.patch.multiple(progress_module, **paces):
        return pursue(*arguments, stream=Terminal, TERM=term, NO_COLOR="1")


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("large") / "crowd.pur"
    file.write_text(many_walkers(), encoding="utf-8")
    return file


# On a terminal, and elsewhere ----------------------------------------------------------------------------------------


def test_a_terminal_shows_how_far_the_work_is() -> None:
    told = on_terminal("solve", FIRST, "-o", os.devnull, changed=IMPATIENT)
    assert told.status == 0
    line, rest = told.err.rsplit(ERASE, 1)
    assert "\rsolving: " in line and "\rproving: " in line
    assert " states, " in line and " waiting, " in line and " MiB, " in line
    assert "won: " not in line and rest.startswith("won: ")


def test_large_work_shows_it_again_and_again(large: Path) -> None:
    told = on_terminal("solve", large, until=" states/s", times=3)
    assert told.status == 130
    assert told.err.count("\rsolving: ") >= 3


def test_at_a_limit_it_is_erased(large: Path) -> None:
    for seconds in (1, 10, 100):  # on a busy machine the time may be over before anything is told
        told = on_terminal("solve", large, "--limit", seconds, "--no-explain", changed=IMPATIENT)
        if "\rsolving: " in told.err:
            break
    assert told.status == 5
    assert "\rsolving: " in told.err
    assert told.err.rsplit(ERASE, 1)[1].startswith(f"error SYN010: no verdict within the limit of {seconds} seconds")


def test_after_a_limit_it_is_shown_of_the_search_for_what_is_large(large: Path) -> None:
    told = on_terminal("solve", large, "--memory", 100, changed=f"{IMPATIENT}\n{QUICKLY_EXPLAINED}")
    assert told.status == 5
    assert told.err.index("error SYN010") < told.err.index("\rexplaining: ")
    # "Without walker1 …", or where that is not found within the limits: "Too large without walker1 …".
    assert "ithout walker1" in told.err.rsplit(ERASE, 1)[1]


@pytest.mark.parametrize("command", [["verify", FIRST], ["ws", FIRST, "--plan"], ["ws", FIRST], ["report", FIRST]])
def test_other_commands_show_it_too(command: List[str], tmp_path: Path) -> None:
    plan = tmp_path / "plan.txt"
    if command[0] == "verify" or "--plan" in command:
        assert pursue("solve", FIRST, "-o", plan).status == 0
        command = [*command, str(plan)]
    if command[0] == "ws":
        command = [*command, "-o", str(tmp_path / "ws")]
    told = seen(*command)
    assert told.status == 0
    assert "\rproving: " in told.err


def test_an_explanation_shows_it_too(tmp_path: Path) -> None:
    file = called(tmp_path, 3)
    told = seen("solve", file)
    assert told.status == 4
    assert "\rexplaining: " in told.err
    assert "would change that" in told.err.rsplit(ERASE, 1)[1]


def test_what_is_quickly_done_shows_nothing() -> None:
    told = seen("solve", FIRST, "-o", os.devnull, patience=1e9)
    assert told.status == 0
    assert "\033" not in told.err and "solving" not in told.err


@pytest.mark.parametrize("quiet", [["--json"], []])
def test_with_json_and_on_a_poor_terminal_nothing_is_shown(quiet: List[str]) -> None:
    told = seen("solve", FIRST, *quiet, term="xterm" if quiet else "dumb")
    assert told.status == 0
    assert "\033" not in told.err and "solving" not in told.err


def test_elsewhere_nothing_is_shown_of_short_work() -> None:
    with mock.patch.multiple(progress_module, _PATIENCE=0.0, _REDRAW=0.0):
        told = pursue("solve", FIRST, TERM="xterm")
    assert "\033" not in told.err + told.out and "\r" not in told.err
    assert "solving" not in told.err and "won: " in told.err


# Ctrl-C ---------------------------------------------------------------------------------------------------------------


def test_ctrl_c_ends_the_solver(large: Path) -> None:
    told = on_terminal("solve", large, changed=IMPATIENT, until="\rsolving: ")
    assert (told.status, told.out) == (130, "")
    assert told.err.endswith(f"{ERASE}interrupted\n")
    assert "Traceback" not in told.err


def test_ctrl_c_ends_the_checker(tmp_path: Path) -> None:
    plan = tmp_path / "plan.txt"
    changed = "\n".join((IMPATIENT, SLOW_CHECKER))
    told = on_terminal("solve", FIRST, "-o", plan, changed=changed, until="\rproving: ")
    assert told.status == 130
    assert told.err.endswith(f"{ERASE}interrupted\n")
    assert "Traceback" not in told.err
    assert not plan.exists()


# The line -------------------------------------------------------------------------------------------------------------


def drawn(moments: List[float], use: Callable[[Callable[[Progress], None]], None]) -> str:
    """What the line leaves on a screen, its clock showing these moments."""
    screen, clock = Screen(), iter(moments)
    with contextlib.ExitStack() as changed:
        changed.enter_context(mock.patch.dict(os.environ, TERM="xterm"))
        changed.enter_context(mock.patch.object(time, "monotonic", lambda: next(clock)))
        show = changed.enter_context(progress_line(stream=screen))
        assert show is not None
        use(show)
    return screen.getvalue()


def test_it_is_patient_and_not_drawn_too_often() -> None:
    def use(show: Callable[[Progress], None]) -> None:
        for states in range(6):
            show(Progress(states, 0, 1.0, 10))

    shown = drawn([0.0, 0.1, 0.4, 0.6, 0.7, 0.79, 0.9], use)
    assert [line.split()[1] for line in shown.split("\r") if "states" in line] == ["2", "5"]
    assert shown.endswith(ERASE)


def test_it_is_erased_however_the_work_ends() -> None:
    screen = Screen()
    with pytest.raises(ZeroDivisionError), contextlib.ExitStack() as changed:
        changed.enter_context(mock.patch.dict(os.environ, TERM="xterm"))
        changed.enter_context(mock.patch.object(progress_module, "_PATIENCE", 0.0))
        show = changed.enter_context(progress_line(stream=screen))
        assert show is not None
        show(Progress(1, 2, 3.0, 4))
        raise ZeroDivisionError
    assert screen.getvalue().endswith(ERASE)


def test_what_was_not_drawn_is_not_erased() -> None:
    assert drawn([0.0], lambda show: None) == ""


def test_nobody_listens_where_it_is_quiet() -> None:
    for stream in (Screen(), io.StringIO()):
        with mock.patch.dict(os.environ, TERM="xterm"), progress_line(quiet=True, stream=stream) as show:
            assert show is None


@pytest.mark.parametrize(("stream", "term"), [(io.StringIO, "xterm"), (Screen, "dumb")])
def test_a_log_gets_a_line_every_ten_seconds(stream: Callable[[], io.StringIO], term: str) -> None:
    log, clock = stream(), iter([0.0, 9.0, 10.0, 12.0, 19.9, 20.5])
    with contextlib.ExitStack() as changed:
        changed.enter_context(mock.patch.dict(os.environ, TERM=term))
        changed.enter_context(mock.patch.object(time, "monotonic", lambda: next(clock)))
        show = changed.enter_context(progress_line(stream=log))
        assert show is not None
        for states in range(5):
            show(Progress(states, 7, 1.0, 10))
    assert log.getvalue() == (
        "solving: 1 states, 7 waiting, 1 states/s, 10 MiB, 10 s\n"
        "solving: 4 states, 7 waiting, 4 states/s, 10 MiB, 20 s\n"
    )


def test_it_fits_the_terminal() -> None:
    with mock.patch.object(progress_module, "_columns", return_value=20):
        shown = drawn([0.0, 1.0], lambda show: show(Progress(10**9, 10**9, 1000.0, 10**5)))
    assert shown.split(ERASE)[0] == "\r" + "solving: 1000000000"[:19] + "\033[K"


def test_what_it_says() -> None:
    assert in_words(Progress(6000, 7, 2.0, 50), 3.4) == "solving: 6000 states, 7 waiting, 3000 states/s, 50 MiB, 3 s"
    assert in_words(Progress(6, 7, 0.01, 50, PROVING), 9.0) == "proving: 6 states, 7 waiting, 50 MiB, 9 s"
