"""The journal of a mission: a record of each call that changed it, so that a restarted observer can continue.

A journal that could not be written any more is renamed (FAILED): it holds the beginning of a mission only. So does one
that is behind its mark. What other nodes have seen tells then where the mission is (see witnesses).
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
import time
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.folders import sync_folder
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.records import (
    FORMAT,
    MARK,
    Mark,
    MarkFile,
    Rank,
    Record,
    RecordFile,
    RecordsRead,
    read_mark,
    read_records,
)
from pursue_runtime.sentences import Log
from pursue_runtime.state import ENDED, WAITING, SystemState

ADOPTED = "adopted"
"""The call with which a mission continues from a state that the journal does not lead to."""

CALLS: Mapping[str, Callable[..., List[SystemState]]] = {
    "hear": Mission.on_word,
    "order": Mission.on_order,
    "tick": Mission.on_time,
    "silent": Mission.on_controller_silent,
    "back": Mission.on_controller_back,
    "planned": Mission.on_plan,
    "unplanned": Mission.on_no_plan,
    "refused": Mission.on_refused,
    "searching": Mission.on_long_search,
    "stop": Mission.stop,
    "restarted": Mission.on_restart,
    ADOPTED: Mission.adopt,
}
"""Mission methods by the names that journals have for them: those of older workspaces are still read."""

END = "told"
"""The call of the last record: the end of the mission has been published."""

FAILED = ".failed"
"""What is added to the name of a journal that could not be written any more."""

MISSING = "it is missing"
"""The damage of a journal that must be there, and is not."""

DELAY = 0.01
"""Seconds until what was written is synced: first it is published, and the next record does not wait for the disk."""

MAX_JOURNALS = 20
"""So many journals of a scenario are kept."""


class Journal:
    """Writes the calls of a mission before their results are published.

    `damage`: why the journal that was found is not all that happened; "" where it is, or where there was none. Then
    nothing is written unless a state is adopted. `last`: the moment of the last entry, in seconds. `after`: the moment
    at which the mission before this one was over, by the same launch; states of before belong to that one. `reached`:
    how far the mission has come at least, by the mark that was found.
    """

    def __init__(self, mission: Mission, path: str, header: Mapping[str, Any], log: Log, begun: bool = False) -> None:
        """Replay the journal at `path` ("": no journal) into a fresh mission.

        `header` tells missions apart: the journal of another `launch` is set aside. `begun`: a mission has been under
        way in this launch, so that there must be a journal.
        """
        self.last = self.after = 0.0
        self.damage = ""
        self.reached: Rank = (0, False)
        self._mission, self._path, self._log = mission, path, log
        self._header = {"format": FORMAT, **header}
        self._mark = MarkFile(path + MARK, str(header.get("launch", "")), str(header.get("mission", "")))
        self._file: Optional[RecordFile] = None
        self._lost = not path  # nothing is written any more
        self._records = 0  # how many the journal has, or should have
        self._entries: List[Record] = []  # what was replayed
        self._lock = threading.RLock()
        self._unsynced, self._written = False, threading.Event()
        if path:
            self._resume(begun)

    @property
    def is_open(self) -> bool:
        """Return True while the journal can be written."""
        return self._file is not None

    def call(self, name: str, *args: Any, now: float) -> List[SystemState]:
        """Call the mission (a name in CALLS) at the time `now` (seconds); write the call if it changed the mission.

        The start and the end of the mission are on the disk when this returns, everything else soon after `sync_soon`.
        """
        before, status = self._mission.revision(), self._mission.status
        self._mission.taken = None
        states = CALLS[name](self._mission, *args, now)
        if self._mission.revision() != before:
            self.last = now
            turn = self._mission.status != status and (status == WAITING or self._mission.status in ENDED)
            entry = {"at": now, "call": name, "args": args, **_end_of(self._mission)}
            ordered = self._mission.taken
            self._write(entry if ordered is None else {**entry, "ordered": ordered}, sync=turn)
        return states

    def adopt(self, state: SystemState, now: float) -> List[SystemState]:
        """Continue the mission from a state that other nodes have seen; return what is to be published.

        What was found damaged or incomplete is set aside. Raises DataError if the mission cannot continue from there.
        """
        if self._mission.plan and not self._entries:
            raise DataError(f"the journal that holds plan {self._mission.plan} cannot be replayed")
        args = json.loads(json.dumps([state._asdict()]))  # as it will be read
        self.last = max(now, state.stamp)
        states = CALLS[ADOPTED](self._mission, *args, self.last)
        entry = {"at": self.last, "call": ADOPTED, "args": args, **_end_of(self._mission)}
        if self._file is not None:
            self._write(entry, sync=True)
        elif self._path:
            self.damage, self._lost = "", False
            self._begin([*self._entries, entry])
        return states

    def end(self, now: float) -> None:
        """Write that the end of the mission was published: the next mission begins a journal of its own.

        A journal that was not trusted, or has failed, is set aside.
        """
        with self._lock:
            if self._file is None and self._path:
                self.damage, self._lost = "", False
                self._begin([])
            if self._file is not None:
                self._write({"at": now, "call": END}, sync=True)
            elif self._path:
                with contextlib.suppress(OSError):
                    self._set_aside()

    def sync_soon(self) -> None:
        """Have `keep_synced` sync what was written: to be called after publishing, which its thread would delay."""
        if self._unsynced:
            self._unsynced = False
            self._written.set()

    def keep_synced(self) -> None:
        """Sync what was written, soon after each `sync_soon`, for ever: for a thread of its own."""
        while True:
            self._written.wait()
            time.sleep(DELAY)
            self._written.clear()
            file = self._file
            try:
                if file is not None:
                    file.sync()
            except OSError as problem:
                self._fail(problem)
            self._mark.sync()

    # What was found ---------------------------------------------------------------------------------------------------

    def _resume(self, begun: bool) -> None:
        try:
            os.makedirs(os.path.dirname(self._path), exist_ok=True)
            source, found, mark = _read(self._path, str(self._header.get("launch", "")))
            self.reached = mark.rank if mark else self.reached
        except OSError as problem:
            source, found = self._path, RecordsRead([], 0, f"it cannot be read: {problem}")
            if not os.path.exists(self._path) and not begun:
                self._log("err", f"no journal: {problem}")
                return
        if not source and begun:
            source, found = self._path, RecordsRead([], 0, MISSING)
        head = dict(found.records[0]) if found.records else {}
        self.after, entries = _moment(head.pop("after", 0.0)), found.records[1:]
        other = bool(head) and head.get("launch") != self._header.get("launch")
        if not source or other or (not found.damage and (not entries or entries[-1].get("call") == END)):
            # nothing is under way: there was no mission, or its end was published
            if entries:
                self.after = 0.0 if other else _moment(entries[-1].get("at"))
            elif source:
                with contextlib.suppress(OSError):
                    os.remove(source)
            self.reached = (0, False)
            self._begin([])
            return
        self.damage = found.damage
        differs = ", ".join(key for key in self._header if head.get(key) != self._header[key])
        if head and differs:
            self.damage = self.damage or f"it was written by an observer with another {differs}"
        elif head:
            self._replay(entries)
        if self.damage:
            self._log("err", f"the journal {source} is not complete: {self.damage}")
        else:
            self._log("warn", f"continues from state {self._mission.seq}, read from {source}")
            self._open(lambda: RecordFile.resume(self._path, found))

    def _replay(self, entries: List[Record]) -> None:
        try:
            replay(self._mission, entries)
        except DataError as problem:
            self.damage = self.damage or f"it cannot be replayed: {problem}"
        else:
            self._entries = entries
            self.last = max([float(entry["at"]) for entry in entries], default=0.0)

    # Writing ----------------------------------------------------------------------------------------------------------

    def _begin(self, entries: List[Record]) -> None:
        """Create the journal with these entries, and set aside the one that was there."""
        records = [{**self._header, "after": self.after}, *entries]
        self._open(lambda: RecordFile.create(self._path, records, self._set_aside))
        with contextlib.suppress(OSError):
            _delete_old(os.path.dirname(self._path))

    def _open(self, how: Callable[[], RecordFile]) -> None:
        try:
            self._file = how()
        except OSError as problem:
            self._log("err", f"no journal: {problem}")
        else:
            self._records = self._file.count
            self._write_mark()

    def _write(self, entry: Mapping[str, Any], sync: bool = False) -> None:
        with self._lock:
            if self.damage or not self._path:
                return
            if not self._lost:
                self._append(entry, sync)
            self._records += 1
            self._write_mark()
            self._unsynced = self._unsynced or not sync

    def _append(self, entry: Mapping[str, Any], sync: bool) -> None:
        if self._file is None:
            self._begin([])  # there was no room for it: there may be now
        try:
            if self._file is None:
                raise OSError("it could not be created")
            self._file.append(entry)
            if sync:
                self._file.sync()
        except OSError as problem:
            self._fail(problem)

    def _write_mark(self) -> None:
        """Mark how far the mission has come, also where the journal has failed."""
        if self._mark.problem:
            return
        self._mark.write(self._records, self._mission.seq, self._mission.status in ENDED)
        if self._mark.problem:
            self._log("err", f"no mark beside the journal: {self._mark.problem}")

    def _fail(self, problem: OSError) -> None:
        """Mark the journal: it is not the whole mission any more, and whoever reads it has to know."""
        with self._lock:
            file, self._file, self._lost = self._file, None, True
            self._log("err", f"the journal {self._path} fails: {problem}; other nodes are the only witnesses now")
            try:
                if file is not None:
                    with contextlib.suppress(OSError):
                        file.cut()
                if os.path.exists(self._path):
                    os.rename(self._path, self._path + FAILED)
                else:
                    os.close(os.open(self._path + FAILED, os.O_WRONLY | os.O_CREAT, 0o644))
                sync_folder(os.path.dirname(self._path))
            except OSError as another:
                self._log("err", f"{self._path} cannot be marked as failed: {another}")

    def _set_aside(self) -> None:
        """Rename what is in the place of the journal to a free name, and remove its mark. Raises OSError."""
        stem, ending = os.path.splitext(self._path)
        for path in (self._path, self._path + FAILED):
            number = 1
            while os.path.exists(f"{stem}-{number}{ending}"):
                number += 1
            if os.path.exists(path):
                os.rename(path, f"{stem}-{number}{ending}")
        self._mark.remove()  # not before: there must be no journal that it should have shown to be cut


def _read(path: str, launch: str) -> Tuple[str, RecordsRead, Optional[Mark]]:
    """Return the path of the journal ("" where there is none), what is in it, and the mark of a mission of this launch
    that has begun. Raises OSError."""
    source, found = "", RecordsRead([], 0)
    if os.path.exists(path):  # one that is there is newer than one that has failed
        source, found = path, read_records(path)
    elif os.path.exists(path + FAILED):
        source = path + FAILED
        found = read_records(source)._replace(damage="it could not be written any more")
    mark = read_mark(path + MARK)
    if mark is None or mark.launch != launch or mark.rank == (0, False):
        return source, found, None
    if not source:
        source, found = path, RecordsRead([], 0, MISSING)
    elif found.records and found.records[0].get("launch") != launch:
        found = RecordsRead([], 0, "it is the one of another launch")
    elif len(found.records) < mark.records and not found.damage:
        what = _lacking(mark.records - len(found.records))
        found = found._replace(damage=f"{what} missing at its end, up to state {mark.seq}")
    return source, found, mark


def _lacking(number: int) -> str:
    return "1 record is" if number == 1 else f"{number} records are"


class LastMission(NamedTuple):
    """What a journal says of the last mission of a launch.

    `unfinished`: the mission's id ("": the workspace's own) where its end was not recorded, else None; `after`: the
    moment (seconds) at which the last mission whose end was recorded was over.
    """

    unfinished: Optional[str] = None
    after: float = 0.0


def last_mission(path: str, launch: str) -> LastMission:
    """Return what is known of the last mission of this launch; nothing where the journal cannot be read."""
    try:
        _, found, mark = _read(path, launch)
    except OSError:
        return LastMission()
    if not found.records or found.records[0].get("launch") != launch:
        return LastMission(mark.mission if mark else None)
    head, last = found.records[0], found.records[-1]
    if last.get("call") == END and not found.damage:
        return LastMission(after=_moment(last.get("at")))
    begun = found.damage or len(found.records) > 1
    return LastMission(str(head.get("mission", "")) if begun else None, _moment(head.get("after")))


def replay(mission: Mission, entries: List[Dict[str, Any]]) -> None:
    """Apply the entries to a fresh mission. Raises DataError where they do not fit it."""
    for number, entry in enumerate(entries, start=1):
        try:
            CALLS[entry["call"]](mission, *entry["args"], float(entry["at"]))
            fits = {key: entry[key] for key in ("seq", "status")} == _end_of(mission)
        except Exception as problem:  # whatever an entry makes of the mission
            raise DataError(f"record {number}: {problem!r}") from problem
        if not fits:
            raise DataError(f"record {number} leads to state {mission.seq}, and should not")


def _moment(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0


def _end_of(mission: Mission) -> Dict[str, Any]:
    return {"seq": mission.seq, "status": mission.status}


def _delete_old(folder: str) -> None:
    """Delete all but the newest MAX_JOURNALS journals, and as many marks."""
    found = [entry for entry in os.scandir(folder) if entry.name.startswith("journal-")]
    for marks in (False, True):
        kind = [entry for entry in found if entry.name.endswith(MARK) == marks]
        for entry in sorted(kind, key=lambda entry: entry.stat().st_mtime)[:-MAX_JOURNALS]:
            with contextlib.suppress(OSError):
                os.remove(entry.path)
