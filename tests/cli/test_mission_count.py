"""The line that says how many missions have been simulated, also while one of them takes long."""

from __future__ import annotations

import io
import os
import signal
import sys
import threading
from pathlib import Path

import pytest

from pursue_gen.tools.commands import progress
from pursue_gen.tools.commands.progress import counting
from pursue_gen.tools.simulation.planner import SEARCHES
from tests.cli.test_progress import ERASE, Screen
from tests.waiting import until

PLANNING = ", a new plan is looked for"


@pytest.mark.parametrize(("stream", "term"), [(Screen, "xterm"), (Screen, "dumb"), (io.StringIO, "xterm")])
def test_it_goes_on_while_a_plan_is_looked_for(stream: type, term: str, monkeypatch: pytest.MonkeyPatch) -> None:
    out = stream()
    monkeypatch.setattr(sys, "stderr", out)
    monkeypatch.setenv("TERM", term)
    monkeypatch.setattr(progress, "_REDRAW", 0.01)
    monkeypatch.setattr(progress, "_INTERVAL", 0.01)
    redrawn = (stream, term) == (Screen, "xterm")
    with counting(1200) as count:
        until(lambda: "simulating: 0 of 1,200 missions, 0 s" in out.getvalue(), "it says that none is done")
        SEARCHES.set()
        try:
            until(lambda: PLANNING in out.getvalue(), "it says that a plan is looked for")
        finally:
            SEARCHES.clear()
        count(3)
        until(lambda: "simulating: 3 of 1,200 missions, " in out.getvalue(), "it says how many are done")
    said = out.getvalue()
    assert ("\r" in said, said.endswith(ERASE), said.endswith("\n")) == (redrawn, redrawn, not redrawn)


def test_with_json_nothing_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    out = Screen()
    monkeypatch.setattr(sys, "stderr", out)
    with counting(5, quiet=True) as count:
        count(1)
    assert not out.getvalue()


def test_ctrl_c_is_for_the_main_thread_alone() -> None:
    """Else one that it has blocked while a process starts would come by way of the other."""
    main = str(threading.get_native_id())
    before = set(os.listdir("/proc/self/task"))
    with counting(10):
        others = set(os.listdir("/proc/self/task")) - before - {main}
        blocked = [_blocked(Path("/proc/self/task", thread, "status").read_text()) for thread in others]
    assert len(blocked) == 1 and blocked[0] >> (signal.SIGINT - 1) & 1
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def _blocked(status: str) -> int:
    line = next(line for line in status.splitlines() if line.startswith("SigBlk:"))
    return int(line.split()[1], 16)
