"""Runs the planner, a process that looks for a plan from the current state of the mission."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import signal
import subprocess
import threading
import time
from typing import Any, Callable, Mapping, Optional, Tuple

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.observer.planning import PlanRequest

PlannerAnswer = Tuple[Any, ...]
"""The name of a call of the mission (see journal.CALLS), and its arguments: a plan, or that there is none."""

ORDER_LIMIT = 5.0
"""Seconds of real time that the planner may take for an order of a person, who waits for the answer."""


def no_plan(number: int, why: str, more: float = 0.0) -> PlannerAnswer:
    """The answer that there is no plan for the request of this number, and why; `more`: so many time units later than
    it is wanted an order could be promised, 0: that is not known."""
    return ("refused", number, why, more) if more else ("unplanned", number, why)


class Planner:
    """Runs one planner at a time, and passes its answer to `done` in a thread of its own.

    A planner runs until it answers or its plan is no longer needed: how long it takes is not known in advance.
    """

    def __init__(
        self,
        command: str,
        game: Mapping[str, Any],
        limit: float,
        done: Callable[[PlannerAnswer], None],
        searching: Callable[[int, float], None],
    ) -> None:
        """`command`: a shell command, `off` for none; `game`: the content of game.yaml.

        After `limit` seconds, and whenever twice as many have passed, `searching` gets the number of the request and
        the seconds of the search so far.
        """
        self._command = [] if command == "off" else shlex.split(command)
        self._game, self._limit, self._done, self._searching = game, limit, done, searching
        self._lock = threading.Lock()
        self._number = 0
        self._process: Optional[subprocess.Popen[bytes]] = None
        self._start: Optional[float] = None

    @property
    def seconds(self) -> float:
        """Return how long the present search has taken so far, in seconds of real time; 0 if there is none."""
        start = self._start
        return 0.0 if start is None else time.monotonic() - start

    def request_plan(self, request: Optional[PlanRequest]) -> None:
        """Start a planner for this request and stop any other; None: only stop."""
        number = request.number if request else 0
        with self._lock:
            if number == self._number:
                return
            self._number, self._start = number, time.monotonic() if request else None
            self._kill()
        if request is not None:
            threading.Thread(target=self._run, args=(request,), name="planner", daemon=True).start()

    def _run(self, request: PlanRequest) -> None:
        answer = self._run_command(request)
        with self._lock:
            if request.number == self._number:
                self._start = None
        self._done(answer)

    def _run_command(self, request: PlanRequest) -> PlannerAnswer:
        """The plan, or why there is none."""
        number = request.number
        if not self._command:
            return no_plan(number, "planning is switched off (--planner)")
        limit = {} if request.order is None else {"limit": ORDER_LIMIT}
        text = json.dumps({"format": 1, "game": self._game, **request.data(), **limit})
        try:
            with self._lock:
                if request.number != self._number:
                    return no_plan(number, "another plan has been requested")
                self._process = process = subprocess.Popen(
                    self._command,
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    start_new_session=True,
                )
        except OSError as problem:
            why = f"{self._command[0]} cannot be run here: {problem}; name another with planner:= or --planner"
            return no_plan(number, why)
        ended = threading.Event()
        threading.Thread(target=self._watch, args=(request.number, ended), name="search", daemon=True).start()
        try:
            output, errors = process.communicate(text.encode())
        finally:
            ended.set()
        return _read(number, output, errors, process.returncode)

    def _watch(self, number: int, ended: threading.Event) -> None:
        """Report the search for this request, each time later, until it has ended."""
        start, report = time.monotonic(), self._limit
        while not ended.wait(start + report - time.monotonic()):
            self._searching(number, report)
            report *= 2

    def _kill(self) -> None:
        """The thread that waits for its answer notices."""
        if self._process is not None and self._process.poll() is None:
            _kill(self._process)


def _kill(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _read(number: int, output: bytes, errors: bytes, status: int) -> PlannerAnswer:
    try:
        answer = read_json(output)
        if answer["won"]:
            return "planned", number, answer
        return no_plan(number, str(answer["why"]), float(answer.get("possible", 0.0)))
    except (BadText, KeyError, TypeError, ValueError) as problem:
        lines = errors.decode(errors="replace").strip().splitlines()
        why = lines[-1] if lines else f"its answer cannot be used: {problem}" if output else ""
        return no_plan(number, f"the planner failed (status {status})" + (f": {why}" if why else ""))
