"""Solving, playing and measuring beside the page: one text at a time, in a process that can be ended at any moment."""

from __future__ import annotations

import multiprocessing
import signal
import threading
import time
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Callable, Dict, Optional

from pursue_gen.tools.draw.fields import refused
from pursue_gen.tools.draw.work import UNDECIDED, SurveyWork, Work, play, solve, survey
from pursue_gen.workspace.robot_size import NOTHING_TOLD, Told

RUNNING, ENDED, CANCELLED, NONE = "running", "ended", "cancelled", "none"
_DIED = "the process has ended without an answer; perhaps the machine has too little memory"


class Jobs:
    """The present job and what it has sent. Methods may be called from several threads."""

    def __init__(
        self, file: str, floor: Optional[Path], seconds: float, memory: int, told: Told = NOTHING_TOLD
    ) -> None:
        """`file`: what messages call the text; `floor`: the map that lies under pictures; the limits of a job; `told`:
        what was told of the sizes of robots."""
        self._file, self._floor, self._seconds, self._memory = file, floor, seconds, memory
        self.told = told
        self._lock = threading.Lock()
        self._number = 0
        self._state: Dict[str, Any] = {"state": NONE}
        self._report = ""
        self._process: Any = None
        self._pipe: Optional[Connection] = None
        self._start = 0.0

    @property
    def report(self) -> str:
        """The page about the last text that was solved; "" where there is none."""
        with self._lock:
            return self._report

    def solve(self, text: str) -> Dict[str, Any]:
        """Solves a text, instead of what is under way; the state."""
        return self._launched(solve, self._work(text), "")

    def play(self, text: str) -> Dict[str, Any]:
        """Begins a game of a text, instead of what is under way; the state."""
        return self._launched(play, self._work(text))

    def survey(self, text: str, radius: Optional[float], speed: Optional[float], ways: bool) -> Dict[str, Any]:
        """Measures a text's ways on the map, instead of what is under way; the state. As `SurveyWork`.

        Raises PursueError where there is no map.
        """
        if self._floor is None:
            raise refused("there is no map to measure on", "pursue-gen draw map.yaml my_floor.pur")
        given = SurveyWork(text, self._file, self._floor, self._seconds, self._memory, self.told, radius, speed, ways)
        return self._launched(survey, given)

    def say(self, line: str) -> Dict[str, Any]:
        """Passes on what the person types in a game; the state. Raises PursueError where no game is under way."""
        with self._lock:
            if self._state["state"] != RUNNING or "game" not in self._state or self._pipe is None:
                raise refused("no game is under way", "press Play to begin one")
            try:
                self._pipe.send(line)
            except OSError:
                raise refused("the game has ended", "press Play to begin another one") from None
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
                self.end()
                self._state = {**self._state, "state": CANCELLED}
        return self.state()

    def end(self) -> None:
        """Ends the process that is under way, if there is one."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None

    def _work(self, text: str) -> Work:
        return Work(text, self._file, self._floor, self._seconds, self._memory, self.told)

    def _launched(
        self, target: Callable[[Any, Connection], None], given: Work, report: Optional[str] = None
    ) -> Dict[str, Any]:
        with self._lock:
            self.end()
            self._number += 1
            self._state, self._start = {"state": RUNNING}, time.monotonic()
            context = multiprocessing.get_context("spawn")
            resource_tracker.ensure_running()  # it would lift the block of Ctrl-C below
            self._pipe, theirs = context.Pipe()
            self._process = context.Process(target=target, args=(given, theirs), daemon=True)
            # Ctrl-C is for the server; the process has that blocked from its birth.
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                self._process.start()
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            theirs.close()
            threading.Thread(target=self._receive, args=(self._number, self._pipe, self._process), daemon=True).start()
            self._report = self._report if report is None else report
        return self.state()

    def _receive(self, number: int, pipe: Connection, process: Any) -> None:
        """Takes what the process sends, as long as its job is the present one."""
        while True:
            try:
                found: Any = pipe.recv()
            except (EOFError, OSError):
                found = None
            with self._lock:
                if number != self._number or self._state["state"] != RUNNING:
                    break
                if found is None:  # it has ended
                    lost = {} if "verdict" in self._state else {"verdict": UNDECIDED, "lines": [_DIED]}
                    self._state = {**self._state, **lost, "state": ENDED}
                    break
                self._report = found.pop("page", self._report)
                self._state.update(found)
        process.join()
