"""The journal of a mission: one line for each call that changed it, so that a restarted observer can continue.

A line is one write to a file that is opened for appending: it outlives the process, not a power cut.
"""

from __future__ import annotations

import contextlib
import json
import os
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import SystemState

CALLS: Mapping[str, Callable[..., List[SystemState]]] = {
    "hear": Mission.on_word,
    "tick": Mission.on_time,
    "silent": Mission.on_controller_silent,
    "back": Mission.on_controller_back,
    "planned": Mission.on_plan,
    "unplanned": Mission.on_no_plan,
    "searching": Mission.on_long_search,
    "stop": Mission.stop,
}
"""Mission methods by the names that journals have for them: those of older workspaces are still read."""

END = "told"
"""The call of the last line: the end of the mission has been published."""

MAX_JOURNALS = 20
"""So many journals of a scenario are kept."""

Log = Callable[[str, str], None]


class Journal:
    """Writes the calls of a mission before their results are published."""

    def __init__(self, mission: Mission, path: str, header: Mapping[str, Any], log: Log) -> None:
        """Replay the journal at `path` ("": no journal) into a fresh mission.

        `header` tells missions apart: a journal of another model or another launch is set aside.
        """
        self._mission = mission
        self._log = log
        self._file: Optional[int] = None
        self.last = 0.0  # the moment of the last entry, in seconds
        if not path:
            return
        try:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            self._resume(path, {"format": 1, **header})
        except OSError as problem:
            self._fail(problem)

    @property
    def is_open(self) -> bool:
        """Return True while the journal can be written."""
        return self._file is not None

    def call(self, name: str, *args: Any, now: float) -> List[SystemState]:
        """Call the mission (a name in CALLS) at the time `now` (seconds); write the call if it changed the mission."""
        before = self._mission.revision()
        states = CALLS[name](self._mission, *args, now)
        if self._mission.revision() != before:
            self.last = now
            self._write({"at": now, "call": name, "args": args, **_end_of(self._mission)})
        return states

    def end(self) -> None:
        """Write that the end of the mission was published: the next mission begins a journal of its own."""
        self._write({"call": END})

    def _resume(self, path: str, header: Mapping[str, Any]) -> None:
        if os.path.exists(path):
            found, entries, whole = read_journal(path)
            if found == header and not (entries and entries[-1].get("call") == END):
                os.truncate(path, whole)
                self._replay(entries, path)
            elif entries:
                _set_aside(path)
            else:
                os.remove(path)  # its mission has never begun
        _delete_old(os.path.dirname(path))
        self._file = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o644)
        if os.fstat(self._file).st_size == 0:
            self._write(header)

    def _replay(self, entries: List[Dict[str, Any]], path: str) -> None:
        try:
            replay(self._mission, entries)
        except DataError as problem:
            self._log("err", f"{path}: {problem}")
            self._mission.stop(f"the observer was restarted, and its journal cannot be replayed: {problem}", 0.0)
        else:
            if entries:
                self.last = float(entries[-1]["at"])
                self._log("warn", f"continues from state {self._mission.seq}, read from {path}")

    def _write(self, entry: Mapping[str, Any]) -> None:
        if self._file is None:
            return
        try:
            os.write(self._file, (json.dumps(entry) + "\n").encode())
        except OSError as problem:
            self._fail(problem)

    def _fail(self, problem: OSError) -> None:
        self._file = None
        self._log("err", f"no journal: {problem}. A restarted observer cannot continue this mission.")


def read_journal(path: str) -> Tuple[Optional[Dict[str, Any]], List[Dict[str, Any]], int]:
    """Return the first line, the other lines, and the length in bytes of all complete lines.

    A kill may leave the last line incomplete; a line that cannot be read is an entry without a call. Raises OSError.
    """
    with open(path, "rb") as file:
        content = file.read()
    whole = content.rfind(b"\n") + 1
    lines = [_entry(line) for line in content[:whole].splitlines()]
    return (lines[0] if lines else None), lines[1:], whole


def unfinished_mission(path: str, launch: str) -> Optional[str]:
    """Return the id of the mission that the observer of this launch had not finished ("": the workspace's own).

    None where there was none, or the journal cannot be read.
    """
    try:
        header, entries, _ = read_journal(path)
    except OSError:
        return None
    if not header or header.get("launch") != launch or not entries or entries[-1].get("call") == END:
        return None
    return str(header.get("mission", ""))


def replay(mission: Mission, entries: List[Dict[str, Any]]) -> None:
    """Apply the entries to a fresh mission. Raises DataError where they do not fit it."""
    for number, entry in enumerate(entries, start=2):
        try:
            CALLS[entry["call"]](mission, *entry["args"], float(entry["at"]))
            fits = {key: entry[key] for key in ("seq", "status")} == _end_of(mission)
        except (KeyError, TypeError, ValueError) as problem:
            raise DataError(f"line {number} cannot be read: {problem!r}") from problem
        if not fits:
            raise DataError(f"line {number} leads to state {mission.seq}, and should not")


def _end_of(mission: Mission) -> Dict[str, Any]:
    return {"seq": mission.seq, "status": mission.status}


def _entry(line: bytes) -> Dict[str, Any]:
    try:
        entry = json.loads(line)
    except ValueError:
        entry = None
    return entry if isinstance(entry, dict) else {}


def _set_aside(path: str) -> None:
    """Rename the file to the next free name."""
    stem, ending = os.path.splitext(path)
    number = 1
    while os.path.exists(f"{stem}-{number}{ending}"):
        number += 1
    os.rename(path, f"{stem}-{number}{ending}")


def _delete_old(folder: str) -> None:
    """Delete all but the newest MAX_JOURNALS journals."""
    journals = [entry for entry in os.scandir(folder) if entry.name.startswith("journal-")]
    for entry in sorted(journals, key=lambda entry: entry.stat().st_mtime)[:-MAX_JOURNALS]:
        with contextlib.suppress(OSError):
            os.remove(entry.path)
