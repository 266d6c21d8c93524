"""Solving beside the page: one text at a time, in a process of its own that can be ended at any moment."""

from __future__ import annotations

import multiprocessing
import signal
import threading
import time
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Dict, Optional

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.draw.solve_work import Work, work

RUNNING, ENDED, CANCELLED, NONE = "running", "ended", "cancelled", "none"


class Jobs:
    """The present job and what it has sent. Methods may be called from several threads."""

    def __init__(self, file: str, floor: Optional[Path], seconds: float, memory: int) -> None:
        """`file`: what messages call the text; `floor`: the map that lies under pictures; the limits of a job."""
        self._file, self._floor, self._seconds, self._memory = file, floor, seconds, memory
        self._lock = threading.Lock()
        self._number = 0
        self._state: Dict[str, Any] = {"state": NONE}
        self._report = ""
        self._process: Any = None
        self._start = 0.0

    @property
    def report(self) -> str:
        """The page about the last text that was solved; "" where there is none."""
        with self._lock:
            return self._report

    def start(self, text: str) -> Dict[str, Any]:
        """Solves a text, instead of what is being solved; the state."""
        with self._lock:
            self._end()
            self._number += 1
            self._state, self._report, self._start = {"state": RUNNING}, "", time.monotonic()
            context = multiprocessing.get_context("spawn")
            resource_tracker.ensure_running()  # it would lift the block of Ctrl-C below
            ours, theirs = context.Pipe(duplex=False)
            given = Work(text, self._file, self._floor, self._seconds, self._memory)
            self._process = context.Process(target=work, args=(given, theirs), daemon=True)
            # Ctrl-C is for the server; the process has that blocked from its birth.
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                self._process.start()
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            theirs.close()
            threading.Thread(target=self._receive, args=(self._number, ours, self._process), daemon=True).start()
        return self.state()

    def state(self) -> Dict[str, Any]:
        """What is known of the job: its state, the seconds that it has taken, what it has sent so far."""
        with self._lock:
            taken = {"seconds": int(time.monotonic() - self._start)} if self._state["state"] == RUNNING else {}
            return {**self._state, **taken, "job": self._number, "report": bool(self._report)}

    def cancel(self) -> Dict[str, Any]:
        """Ends the job, if there is one."""
        with self._lock:
            if self._state["state"] == RUNNING:
                self._end()
                self._state = {"state": CANCELLED}
        return self.state()

    def close(self) -> None:
        """Ends what is under way."""
        with self._lock:
            self._end()

    def _end(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None

    def _receive(self, number: int, end: Connection, process: Any) -> None:
        """Takes what the process sends, as long as its job is the present one."""
        while True:
            try:
                found: Any = end.recv()
            except (EOFError, OSError):
                found = None
            with self._lock:
                if number != self._number or self._state["state"] != RUNNING:
                    break
                if found is None:  # it has ended
                    problem = _died()
                    lost = {} if "verdict" in self._state else {"verdict": "undecided", "lines": [problem]}
                    self._state = {**self._state, **lost, "state": ENDED}
                    break
                self._report = found.pop("page", self._report)
                self._state.update(found)
        end.close()
        process.join()


def _died() -> str:
    problem = PursueError([error("SYN010", "the process that solves has ended without a verdict")], 5)
    return str(problem)
