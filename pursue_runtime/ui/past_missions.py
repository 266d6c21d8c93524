"""The missions of a workspace that were played on this machine, from their journals and recordings. Without ROS.

Only regular files of this user in one folder are read, and of each a limited part; links are not followed.
"""

from __future__ import annotations

import os
import re
import shlex
import stat
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.event_words import START, STOP
from pursue_runtime.observer.records import RecordsRead, read_records
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, LIVE, LOST, STATUSES
from pursue_runtime.ui.bag_file import BadBag, BagSummary, read_summary

MOST = 30  # missions that are listed, the newest
MOST_FILES = 200  # files of the folder that are looked at, the newest
MOST_BYTES = 8 * 2**20  # of a journal that is read
SINCE_1970 = 1.0e9  # seconds: ROS times above are Unix times, those below are simulated
SAME = 0.01  # seconds by which the start of a mission may differ between its state and its journal
NEAR = 60.0  # seconds between the last writes to two files of one mission in simulated time

UNFINISHED, DAMAGED, UNKNOWN = "not finished", "damaged", "not known"
JOURNAL = re.compile(r"journal-[\w-]*\.jsonl(\.failed)?", re.ASCII)
BAG = re.compile(r"[^/]+\.bag(\.active)?")


class PastMission(NamedTuple):
    """A mission that was played: a status, UNFINISHED, DAMAGED or UNKNOWN, and a reason; when it began (ROS time), the
    last write to its files (Unix time), its duration in time units; its files, and the command that replays it."""

    result: str
    why: str
    began: Optional[float]
    written: float
    units: Optional[float]
    files: Tuple[str, ...]
    replay: str


def workspace_of(config: str) -> str:
    """Return the folder of the workspace with the package that has this folder `config`; "" where there is none that
    `pursue-gen replay --workspace` could use, as in the install space."""
    source = os.path.dirname(os.path.dirname(os.path.realpath(config)))
    game = os.path.join(source, "observer", "config", "game.yaml")
    return os.path.dirname(source) if os.path.basename(source) == "src" and os.path.isfile(game) else ""


def shown_missions(
    missions: Sequence[PastMission], start: Optional[float], is_settled: bool = True
) -> List[Dict[str, Any]]:
    """Return the missions for a page; the one that began at `start` (ROS time) is marked as the present one.

    Its journal is not named unless `is_settled`: the next observer of the launch renames it.
    """
    shown = []
    for mission in missions:
        is_present = None not in (start, mission.began) and abs(float(mission.began or 0) - float(start or 0)) < SAME
        moment = mission.began if mission.began is not None and mission.began > SINCE_1970 else mission.written
        units = None if mission.units is None else round(mission.units, 1)
        known: Dict[str, Any] = {"began": round(moment, 3), "units": units, "files": list(mission.files)}
        known["present"] = is_present
        if is_present and not is_settled and JOURNAL.fullmatch(os.path.basename(mission.files[0])):
            known.update(files=[], replay="")
        shown.append({**mission._asdict(), **known})
    return shown


class _Found(NamedTuple):
    """What one file says, and when ROS time was in it."""

    mission: PastMission
    first: float = 0.0
    last: float = 0.0


class PastMissions:
    """The list, read again where files have changed."""

    def __init__(self, folder: str, mission: str = "", workspace: str = "") -> None:
        """`folder`: that of the scenario; `workspace`: the folder of the workspace for the mission of this id ("": none
        is known), which replaying a journal needs."""
        self._folder, self._mission, self._workspace = folder, mission, workspace
        self._known: Dict[Tuple[str, int, int], Optional[_Found]] = {}

    def read(self, recording: str = "") -> List[PastMission]:
        """Return the missions, the newest first; without the file `recording`, which is being written."""
        found: Dict[Tuple[str, int, int], Optional[_Found]] = {}
        for path, is_bag, facts in self._files():
            if recording and path == f"{recording}.active":
                continue
            key = (path, facts.st_mtime_ns, facts.st_size)
            found[key] = self._known[key] if key in self._known else self._look(path, is_bag)
        self._known = found
        every = [each for each in found.values() if each is not None]
        journals, alone = [each for each in every if not _is_bag(each)], []
        for bag in (each for each in every if _is_bag(each)):
            at = next((number for number, each in enumerate(journals) if _belongs(bag, each)), None)
            if at is None:
                alone.append(bag)
            else:
                journals[at] = _joined(journals[at], bag)
        listed = sorted((each.mission for each in (*journals, *alone)), key=lambda mission: -mission.written)
        return listed[:MOST]

    def _files(self) -> List[Tuple[str, bool, os.stat_result]]:
        """The files of the folder that may be ours, the newest first."""
        found = []
        try:
            with os.scandir(self._folder) as entries:
                for entry in entries:
                    is_bag = bool(BAG.fullmatch(entry.name))
                    if is_bag or JOURNAL.fullmatch(entry.name):
                        found.append((entry.path, is_bag, entry.stat(follow_symlinks=False)))
        except OSError:
            return []  # there is no such folder yet
        own = (each for each in found if stat.S_ISREG(each[2].st_mode) and each[2].st_uid == os.getuid())
        return sorted(own, key=lambda each: -each[2].st_mtime_ns)[:MOST_FILES]

    def _look(self, path: str, is_bag: bool) -> Optional[_Found]:
        """What a file says; None where it holds no mission, or is nothing of ours."""
        try:
            descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
        except OSError:
            return None
        try:
            facts = os.fstat(descriptor)
            if not stat.S_ISREG(facts.st_mode) or facts.st_uid != os.getuid():
                return None
            return _look_at_bag(path, descriptor, facts) if is_bag else self._look_at_journal(path, descriptor, facts)
        except OSError as problem:
            return _Found(PastMission(DAMAGED, f"it cannot be read: {problem}", None, 0.0, None, (path,), ""))
        finally:
            os.close(descriptor)

    def _look_at_journal(self, path: str, descriptor: int, facts: os.stat_result) -> Optional[_Found]:
        if facts.st_size > MOST_BYTES:
            why = f"its journal has more than {MOST_BYTES // 2**20} MiB and was not read here"
            return _Found(PastMission(UNKNOWN, why, None, facts.st_mtime, None, (path,), self._command(path, {})))
        found = read_records(f"/proc/self/fd/{descriptor}")
        head = dict(found.records[0]) if found.records else {}
        mission = _of_journal(found, path, facts.st_mtime)
        if mission is None:
            return None
        ends = [entry["at"] for entry in found.records[1:] if isinstance(entry.get("at"), (int, float))]
        replay = self._command(path, head) if head else ""
        return _Found(mission._replace(replay=replay), mission.began or 0.0, ends[-1] if ends else 0.0)

    def _command(self, path: str, head: Mapping[str, Any]) -> str:
        """What replays a journal, which does not hold its scenario."""
        known = self._workspace and head.get("mission") == self._mission
        source = f"--workspace {shlex.quote(self._workspace)}" if known else "SCENARIO.pur"
        return f"pursue-gen replay {shlex.quote(path)} {source}"


def _of_journal(found: RecordsRead, path: str, written: float) -> Optional[PastMission]:
    """The mission of a journal; None where none has begun in it."""
    entries = [each for each in found.records[1:] if isinstance(each.get("at"), (int, float)) and "status" in each]
    live = [each for each in entries if each["status"] in LIVE]
    began = float(live[0]["at"]) if live else None
    ended = next((each for each in entries if each["status"] in ENDED), None)
    if began is None and ended is None and not found.damage:
        return None
    result, why = (str(ended["status"]), _reason(ended)) if ended is not None else (UNFINISHED, "")
    if found.damage and ended is None:
        result, why = DAMAGED, f"its journal: {found.damage}"
    elif path.endswith(".failed"):
        why = why or "its journal could not be written to the end"
    last = ended or (entries[-1] if entries else None)
    unit = _unit(found.records[0]) if found.records else 1.0
    units = max(0.0, float(last["at"]) - began) / unit if last is not None and began is not None else None
    return PastMission(result, why, began, written, units, (path,), "")


def _unit(head: Mapping[str, Any]) -> float:
    """Seconds per time unit."""
    settings = head.get("settings")
    unit = settings.get("time_unit", 1.0) if isinstance(settings, dict) else 1.0
    return float(unit) if isinstance(unit, (int, float)) and 1e-9 < unit < 1e9 else 1.0


def _reason(ended: Mapping[str, Any]) -> str:
    """Why a mission ended without goal, as far as its last record says."""
    args = ended.get("args")
    text = in_words(str(args[0]))[:300] if isinstance(args, list) and args else ""
    if ended.get("call") == "stop":
        return text
    if text.strip() == STOP:
        return f"{STOP} was published"
    return f"with {text}" if ended["status"] == LOST and text and text != START else ""


def _look_at_bag(path: str, descriptor: int, facts: os.stat_result) -> _Found:
    command = f"pursue-gen replay {shlex.quote(path)}"
    try:
        summary = read_summary(descriptor, facts.st_size)
    except BadBag as problem:
        return _Found(PastMission(DAMAGED, f"its recording: {problem}", None, facts.st_mtime, None, (path,), command))
    mission = PastMission(_result(summary), "", summary.began, facts.st_mtime, summary.units, (path,), command)
    return _Found(mission, summary.first, summary.last)


def _result(summary: BagSummary) -> str:
    if summary.status in ENDED:
        return summary.status
    return UNFINISHED if summary.status in STATUSES else UNKNOWN


def _is_bag(found: _Found) -> bool:
    return bool(BAG.fullmatch(os.path.basename(found.mission.files[0])))


def _belongs(bag: _Found, journal: _Found) -> bool:
    """True where the bag was recorded while the mission of the journal was played."""
    began = journal.mission.began
    if began is None or len(journal.mission.files) > 1 or not bag.first <= began <= bag.last:
        return False
    return began > SINCE_1970 or abs(bag.mission.written - journal.mission.written) < NEAR


def _joined(journal: _Found, bag: _Found) -> _Found:
    """The mission with both files; the recording holds all that replaying needs."""
    mission, recorded = journal.mission, bag.mission
    if mission.result not in ENDED and recorded.result in ENDED:
        mission = mission._replace(result=recorded.result, units=recorded.units or mission.units)
    files = (*recorded.files, *mission.files)
    written = max(mission.written, recorded.written)
    return journal._replace(mission=mission._replace(files=files, written=written, replay=recorded.replay))
