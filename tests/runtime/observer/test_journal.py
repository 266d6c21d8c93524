"""An observer that was killed goes on where it was: the journal holds all that changed the mission."""

from __future__ import annotations

import errno
import json
import os
import threading
import zlib
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.bounded import DATA, read_json
from pursue_runtime.data import DataError
from pursue_runtime.folders import scenario_folder
from pursue_runtime.model import Model
from pursue_runtime.observer import records
from pursue_runtime.observer.journal import Journal, last_mission
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.records import MARK, format_record, read_records
from pursue_runtime.state import LIVE, SystemState, format_state
from pursue_runtime.strategy import read_cover
from tests.runtime.observer.test_holding import COVER, EVERYWHERE, answer
from tests.runtime.observer.test_mission import CHASE
from tests.runtime.texts import read
from tests.waiting import until

HEADER = {"scenario": "chase", "model": "1", "launch": "x"}
PLAY = [
    *[("hear", word) for word in ("_start_", "bot_a2b", "nonsense", "bot_going_a_to_b2b")],
    *[("silent", "one"), ("searching", 1, 10.0), ("planned", 1, answer(EVERYWHERE))],
    *[("hear", "one:_plan_@1"), ("back", "one")],
    *[("tick",), ("hear", "dog:catch@7")],
]


class Life:
    """One observer: a fresh mission, and its journal."""

    def __init__(self, path: Path, header: Any = None, begun: bool = False) -> None:
        self.logs: List[Tuple[str, str]] = []
        log = lambda level, message: self.logs.append((level, message))
        cover = read_cover(read(COVER))
        chase = Model(read(CHASE))
        self.mission = Mission(chase, cover, log, on_uncovered="plan", controllers=["one"])
        self.journal = Journal(self.mission, str(path), header or HEADER, log, begun)

    def play(self, *calls: Any, first: int = 0) -> List[Any]:
        """Calls, one time unit after the other; what was published."""
        states = []
        for moment, (name, *arguments) in enumerate(calls, start=first):
            states += self.journal.call(name, *arguments, now=1000.0 + moment)
            self.journal.sync_soon()  # as the observer does when it has published them
        return states

    def state(self) -> str:
        """Everything that is published, but for the clocks of the moment."""
        text: str = format_state(self.mission.state(2000.0))
        return text


def journals(path: Path) -> List[str]:
    """The names of the files in the folder of the journal, but for marks."""
    return sorted(name for name in os.listdir(path.parent) if not name.endswith(MARK))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "pursue" / "chase" / "journal-x.jsonl"


@pytest.mark.parametrize("death", range(len(PLAY) + 1))
def test_a_new_observer_is_where_the_old_one_was(path: Path, death: int) -> None:
    whole, before = Life(path.with_name("journal-y.jsonl")), Life(path)
    told = whole.play(*PLAY)
    assert told[-1].seq == 8 and told[-1].plan == 1
    published = before.play(*PLAY[:death])
    after = Life(path)
    assert after.state() == before.state()
    assert [state.seq for state in published + after.play(*PLAY[death:], first=death)] == [state.seq for state in told]
    assert after.state() == whole.state()


def test_a_new_observer_still_has_the_plan_in_force_for_those_who_come_later(path: Path) -> None:
    before = Life(path)
    before.play(*PLAY)
    assert before.mission.in_force["plan"] == 1
    assert Life(path).mission.in_force == before.mission.in_force


def test_a_new_observer_knows_the_ways_that_are_blocked(path: Path) -> None:
    before = Life(path)
    before.play(*PLAY[:2], ("hear", "bot:_blocked_"), ("hear", "going_a_to_b:_free_"))
    assert Life(path).mission.ways.blocked == set()
    before.play(("hear", "going_a_to_b:_blocked_"), first=4)
    again = Life(path).mission
    assert again.ways.blocked == {("a", "b")} and again.plan_request == before.mission.plan_request


@pytest.mark.parametrize("adopts", [False, True])
def test_no_plan_of_a_lost_request_is_taken_for_one_that_is_requested_after_a_restart(path: Path, adopts: bool) -> None:
    """A controller still has the answer to request 1, and its receipt comes again."""
    before = Life(path)
    states = before.play(*PLAY[:4])
    assert before.mission.plan_request.number == 1
    life = Life(path)
    life.journal.adopt(states[-1], 1004.0) if adopts else life.journal.call("restarted", now=1004.0)
    again = Life(path)
    again.journal.call("restarted", now=1005.0)
    number = again.mission.plan_request.number
    assert number > life.mission.plan_request.number > 1
    again.play(("planned", 1, answer(EVERYWHERE)), ("hear", "one:_plan_@1"), first=6)
    assert again.mission.plan == 0
    again.play(("planned", number, answer(EVERYWHERE)), ("hear", "one:_plan_@1"), first=8)
    assert again.mission.plan == 0
    again.play(("hear", f"one:_plan_@{number}"), first=10)
    assert again.mission.plan == Life(path).mission.plan == number


def test_a_new_observer_knows_when_something_was_last_written(path: Path) -> None:
    assert Life(path).journal.last == 0.0
    before = Life(path)
    before.play(("hear", "_start_"), ("hear", "nonsense"))
    assert Life(path).journal.last == before.journal.last == 1000.0


def test_what_changes_nothing_is_not_written(path: Path) -> None:
    life = Life(path)
    life.play(("hear", "_start_"))
    size = path.stat().st_size
    life.play(("hear", "_ping_"), ("hear", "nonsense"), ("hear", "dog:catch@9"), ("tick",), first=1)
    assert path.stat().st_size == size


def test_a_line_is_written_before_anybody_receives_of_the_state(path: Path) -> None:
    life = Life(path)
    states = life.play(("hear", "_start_"))
    assert read_records(str(path)).records[-1]["seq"] == states[-1].seq


def test_a_torn_last_line_is_as_if_it_had_not_happened(path: Path) -> None:
    life = Life(path)
    life.play(*PLAY[:3])
    mark = path.with_name(path.name + MARK).read_bytes()
    life.play(PLAY[3], first=3)
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-1]) + lines[-1][:20])
    path.with_name(path.name + MARK).write_bytes(mark)  # which is written after the record
    again = Life(path)
    assert again.mission.seq == 2 and not [text for level, text in again.logs if level == "err"]
    again.play(*PLAY[3:], first=3)
    assert Life(path).state() == again.state()


# What cannot be trusted -----------------------------------------------------------------------------------------------


def write(path: Path, entries: List[Any]) -> None:
    """A journal of these records, whatever they are."""
    path.write_bytes(b"".join(format_record(number, entry) for number, entry in enumerate(entries)))


@pytest.mark.parametrize("change", [
    {"call": "mark"}, {"seq": 5}, {"args": [7]}, {"args": None}, {"call": "planned", "args": []}, {"at": "noon"},
])
def test_a_journal_that_cannot_be_replayed_is_not_trusted(path: Path, change: Dict[str, Any]) -> None:
    Life(path).play(*PLAY[:4])
    found = read_records(str(path)).records
    write(path, [*found[:2], {**found[2], **change}, *found[3:]])
    life = Life(path)
    assert "replayed" in life.journal.damage and not life.journal.is_open


BRACKETS = b"[" * 200000 + b"\n"


@pytest.mark.parametrize("line", [0, 2])
@pytest.mark.parametrize("damage", [b"", b"rubbish\n", b"\x00" * 100 + b"\n", BRACKETS, b"{}\n", b"\n"])
def test_a_hole_or_a_wrong_head_is_not_trusted(path: Path, line: int, damage: bytes) -> None:
    Life(path).play(*PLAY[:4])
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([*lines[:line], damage, *lines[line + 1:]]))
    for _ in range(2):  # it stays as it is
        life = Life(path)
        assert life.journal.damage and not life.journal.is_open
        assert life.mission.status in ("waiting", "running")


@pytest.mark.parametrize("content", [
    b"", b"\n", BRACKETS, b"[" * 200000, format_record(0, {}).replace(b"{}", b"[]"), b'{"format": 1, "launch": "x"}\n',
])
def test_a_journal_without_a_head_is_not_trusted(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True)
    path.write_bytes(content)
    assert Life(path).journal.damage and path.read_bytes() == content


def test_a_journal_that_must_be_there_and_is_missing_is_like_a_damaged_one(path: Path) -> None:
    assert Life(path, begun=True).journal.damage == "it is missing" and not path.exists()
    Life(path)
    assert not Life(path, begun=True).journal.damage, "of the next mission, perhaps"


def test_brackets_with_a_right_checksum_are_no_record() -> None:
    line = format_record(3, {}).replace(b" 2 {}", b" %d %s" % (len(BRACKETS) - 1, BRACKETS[:-1]))
    covered = line[9:-1]
    assert records.parse_record(b"%08x %s\n" % (zlib.crc32(covered), covered)) is None


def test_whatever_was_read_within_bounds_can_be_read_as_a_record() -> None:
    deep: Any = 1
    for _ in range(DATA.depth):
        deep = [deep]
    record = {"at": 1e9, "call": "planned", "args": [1, read_json(json.dumps(deep))], "seq": 3, "status": "holding"}
    assert records.parse_record(format_record(4, record)) == (4, record)


def test_a_record_may_be_as_long_as_the_limit(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    line = format_record(1, {"call": "hear", "args": ["word"]})
    monkeypatch.setattr(records, "MAX_RECORD", len(line))
    assert format_record(1, {"call": "hear", "args": ["word"]}) == line
    path.parent.mkdir(parents=True)
    path.write_bytes(format_record(0, {}) + line)
    assert [record.get("call") for record in read_records(str(path)).records] == [None, "hear"]
    with pytest.raises(OSError, match="longer than"):
        format_record(1, {"call": "hear", "args": ["words"]})


def test_a_journal_is_on_the_disk_before_it_has_its_name_and_its_name_before_it_counts(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: List[str] = []
    sync, rename = os.fsync, os.rename
    inodes = lambda: {each.stat().st_ino: each.name for each in (path.parent, *path.parent.iterdir())}
    monkeypatch.setattr(os, "fsync", lambda file: (done.append(inodes()[os.fstat(file).st_ino]), sync(file)))
    monkeypatch.setattr(os, "rename", lambda old, new: (done.append("rename"), rename(old, new)))
    path.parent.mkdir(parents=True)
    records.RecordFile.create(str(path), [{}, {"call": "hear"}])
    assert done == [f"{path.name}.new", "rename", path.parent.name]


def test_a_record_that_is_longer_than_the_limit_is_none(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Life(path).play(*PLAY)
    monkeypatch.setattr(records, "MAX_RECORD", 200)
    assert "is damaged" in Life(path).journal.damage, "a plan"


def test_a_call_with_a_record_that_is_too_long_is_taken_and_the_journal_marked(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(records, "MAX_RECORD", 200)
    life = Life(path)
    assert life.play(*PLAY)[-1].seq == 8
    assert not life.journal.is_open and journals(path) == [path.name + ".failed"]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The journal of PLAY."""
    path = tmp_path_factory.mktemp("whole") / "journal-x.jsonl"
    Life(path).play(*PLAY)
    return path.read_bytes()


def trusted(path: Path, content: bytes, whole: bytes) -> Optional[int]:
    """How many records of the whole journal are trusted where these bytes are found, None where it is not trusted at
    all. What is trusted is the beginning of the whole."""
    path.write_bytes(content)
    life = Life(path)
    if life.journal.damage:
        return None
    found = path.read_bytes()
    assert whole.startswith(found)
    return found.count(b"\n")


@given(st.data())
def test_what_is_cut_out_is_a_torn_end_or_not_trusted(
    tmp_path_factory: pytest.TempPathFactory, whole: bytes, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("journal") / "journal-x.jsonl"
    start = data.draw(st.integers(0, len(whole) - 1))
    end = data.draw(st.integers(start + 1, len(whole)))
    rest = whole[:start] + whole[end:]
    left = trusted(path, rest, whole)
    last = whole.splitlines(keepends=True)[-1]
    if whole.startswith(rest) and b"\n" in rest:
        assert left == rest.count(b"\n")
    elif last in rest.splitlines(keepends=True):
        assert left is None, "a later record shows that others are missing"
    else:
        assert left in (None, whole[:start].count(b"\n"))


@given(st.data())
def test_a_byte_that_is_wrong_is_a_torn_end_or_not_trusted(
    tmp_path_factory: pytest.TempPathFactory, whole: bytes, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("journal") / "journal-x.jsonl"
    place = data.draw(st.integers(0, len(whole) - 1))
    byte = data.draw(st.integers(0, 255).filter(lambda byte: byte != whole[place]))
    left = trusted(path, whole[:place] + bytes([byte]) + whole[place + 1:], whole)
    in_the_last = place >= whole.rindex(b"\n", 0, -1) + 1
    assert left == (whole.count(b"\n") - 1 if in_the_last else None)


@given(st.data())
def test_no_damage_ends_in_an_exception(
    tmp_path_factory: pytest.TempPathFactory, whole: bytes, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("journal") / "journal-x.jsonl"
    start = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(start, len(whole)))
    trusted(path, whole[:start] + data.draw(st.binary(max_size=20)) + whole[end:], whole)


def test_the_journal_of_another_launch_is_set_aside(path: Path) -> None:
    Life(path).play(*PLAY[:4])
    life = Life(path, {**HEADER, "launch": "z"})
    assert life.mission.status == "waiting" and life.journal.is_open and not life.journal.damage
    assert len(journals(path)) == 2


def test_a_journal_of_this_launch_and_another_model_is_not_trusted(path: Path) -> None:
    Life(path).play(*PLAY[:4])
    assert "another model" in Life(path, {**HEADER, "model": "2"}).journal.damage


def test_an_end_that_was_not_reported_is_reported_again_and_then_it_is_over(path: Path) -> None:
    Life(path).play(("hear", "_start_"), ("hear", "_stop_"))
    again = Life(path)
    assert again.mission.status == "stopped"
    again.journal.end(1005.0)
    after = Life(path)
    assert after.mission.status == "waiting" and after.journal.after == 1005.0
    assert Life(path).journal.after == 1005.0, "also after another restart"


def test_what_was_not_trusted_is_set_aside_when_its_end_was_published(path: Path) -> None:
    Life(path).play(*PLAY[:4])
    path.write_bytes(b"rubbish\n")
    life = Life(path)
    life.journal.call("stop", "it is damaged", now=1010.0)
    assert life.mission.status == "stopped" and path.read_bytes() == b"rubbish\n"
    life.journal.end(1011.0)
    after = Life(path)
    assert after.mission.status == "waiting" and not after.journal.damage and after.journal.after == 1011.0


# What cannot be written, and what the disk has ------------------------------------------------------------------------


class Disk:
    """`os.write` and what goes wrong with it, from one call on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, good: int, short: bool = False) -> None:
        self.left = good
        write, rename, self.fails_to_rename = os.write, os.rename, False

        def limited(descriptor: int, content: bytes) -> int:
            self.left -= 1
            if self.left >= 0:
                return write(descriptor, content)
            if short and self.left == -1:
                return write(descriptor, content[:10])
            raise OSError(errno.ENOSPC, "No space left on device")

        def renamed(old: Any, new: Any) -> None:
            if self.fails_to_rename:
                raise OSError(errno.EROFS, "Read-only file system")
            rename(old, new)

        monkeypatch.setattr(os, "write", limited)
        monkeypatch.setattr(os, "rename", renamed)


@pytest.mark.parametrize("short", [False, True])
def test_a_journal_that_cannot_be_written_is_marked_before_the_next_word(
    path: Path, monkeypatch: pytest.MonkeyPatch, short: bool
) -> None:
    with monkeypatch.context() as broken:
        Disk(broken, good=3, short=short)
        life = Life(path)
        published = life.play(*PLAY[:2])
        assert journals(path) == [path.name]
        published += life.play(PLAY[3], first=2)
        assert journals(path) == [path.name + ".failed"], "the robot has arrived, and it is not written"
        assert [state.seq for state in published] == [1, 2, 3], "the mission goes on"
    again = Life(path)
    assert "could not be written" in again.journal.damage and again.mission.seq == 2
    assert read_records(f"{path}.failed").damage == "", "what was written of the last record is cut off"
    assert last_mission(str(path), "x").unfinished == ""


def test_a_journal_that_cannot_even_be_marked_is_what_it_was(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as broken:
        disk = Disk(broken, good=3)
        life = Life(path)
        life.play(*PLAY[:2])
        disk.fails_to_rename = True
        assert life.play(PLAY[3], first=2)[-1].seq == 3 and not life.journal.is_open
    assert any("cannot be marked" in text for _, text in life.logs)
    assert Life(path).mission.seq == 2, "other nodes have to know more"


def test_where_there_was_never_room_for_a_journal_there_is_a_mark(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as broken:
        Disk(broken, good=0)
        life = Life(path)
        assert not life.journal.is_open and not Life(path).journal.damage, "no mission has begun"
        life.play(("hear", "_start_"))
    assert Life(path).journal.damage


def test_a_journal_begins_as_soon_as_there_is_room_for_it(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as broken:
        Disk(broken, good=0)
        life = Life(path)
    life.play(*PLAY[:2])
    assert life.journal.is_open and Life(path).mission.seq == 2


def test_all_that_is_written_comes_to_the_disk_without_another_call(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first sync waits until more was written: that is synced as well."""
    sizes: List[int] = []
    begun, go_on = threading.Event(), threading.Event()

    def sync(descriptor: int) -> None:
        size = os.fstat(descriptor).st_size
        if os.fstat(descriptor).st_ino != path.stat().st_ino:
            return  # the mark
        if threading.current_thread().name == "journal":
            begun.set()
            assert go_on.wait(100)
        sizes.append(size)

    monkeypatch.setattr(os, "fdatasync", sync)
    life = Life(path)
    threading.Thread(target=life.journal.keep_synced, name="journal", daemon=True).start()
    life.play(("hear", "_start_"))
    assert sizes == [path.stat().st_size], "the start is there at once"
    life.play(PLAY[1], first=1)
    assert begun.wait(100) and len(sizes) == 1, "a word does not wait for the disk"
    life.play(PLAY[3], first=2)
    go_on.set()
    assert until(lambda: sizes[-1] == path.stat().st_size, "a sync of everything")
    life.play(("hear", "_stop_"), first=3)
    assert sizes[-1] == path.stat().st_size, "so is the end"


def test_the_thread_that_syncs_sleeps_until_the_states_are_published(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    life = Life(path)
    life.play(("hear", "_start_"))
    synced = threading.Event()
    monkeypatch.setattr(os, "fdatasync", lambda _: synced.set())
    threading.Thread(target=life.journal.keep_synced, daemon=True).start()
    before = path.stat().st_size
    assert life.journal.call(*PLAY[1], now=1001.0)
    assert path.stat().st_size > before, "it is in the file before it is published"
    assert not synced.wait(0.1)
    life.journal.sync_soon()
    assert synced.wait(100)


def test_a_disk_that_fails_to_sync_marks_the_journal(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    life = Life(path)
    life.play(("hear", "_start_"))

    def sync(_: int) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(os, "fdatasync", sync)
    threading.Thread(target=life.journal.keep_synced, daemon=True).start()
    life.play(PLAY[1], first=1)
    until(lambda: not path.exists() and not life.journal.is_open, "the mark")
    assert Life(path).journal.damage


# What other nodes have seen -------------------------------------------------------------------------------------------


def seen(path: Path, *calls: Any) -> Tuple[SystemState, "Life"]:
    """The state after these calls in another journal, as a node has seen it two seconds later."""
    life = Life(path.with_name("journal-other.jsonl"))
    life.play(*calls)
    os.remove(path.with_name("journal-other.jsonl"))
    return life.mission.state(1000.0 + len(calls) + 1), life


@pytest.mark.parametrize("known", [0, 1, 2])
def test_a_mission_goes_on_from_what_other_nodes_have_seen(path: Path, known: int) -> None:
    state, other = seen(path, *PLAY[:2])
    Life(path).play(*PLAY[:known])
    os.rename(path, f"{path}.failed")
    life = Life(path)
    life.journal.adopt(state, 1005.0)
    assert life.journal.is_open and not life.journal.damage and life.state() == other.state()
    words = ("hear", "bot_going_a_to_b2b"), ("tick",)
    assert [state.seq for state in life.play(*words, first=6)] == [state.seq for state in other.play(*words, first=6)]
    again = Life(path)
    assert again.state() == life.state() == other.state() and not again.journal.damage
    assert not os.path.exists(f"{path}.failed")


@pytest.mark.parametrize("death", range(1, len(PLAY) + 1))
def test_wherever_a_mission_was_when_its_journal_was_lost_it_is_there_again(path: Path, death: int) -> None:
    """The journal has only what it must have: the plan in force."""
    state, other = seen(path, *PLAY[:death])
    in_force = next(number for number, call in enumerate(PLAY, start=1) if "_plan_" in str(call))
    life = Life(path)
    life.play(*PLAY[:in_force if state.plan else 0])
    os.rename(path, f"{path}.failed")
    life = Life(path)
    published = life.journal.adopt(state, state.stamp)
    assert life.mission.position(2000.0) == other.mission.position(2000.0)
    assert [each.seq for each in published] in ([state.seq], [state.seq, state.seq + 1])
    assert published[0]._replace(late=()) == state._replace(late=())
    assert (life.mission.in_force, life.mission.status in LIVE) == (other.mission.in_force, state.status in LIVE)
    assert Life(path).state() == life.state()


def test_where_the_journal_is_whole_a_later_state_is_added_to_it(path: Path) -> None:
    state, other = seen(path, *PLAY[:2])
    Life(path).play(*PLAY[:1])
    life = Life(path)
    life.journal.adopt(state, 1005.0)
    assert [record.get("call") for record in read_records(str(path)).records] == [None, "hear", "adopted"]
    assert Life(path).state() == other.state()


def test_where_time_was_set_back_a_state_is_adopted_at_its_own_time(path: Path) -> None:
    state, other = seen(path, *PLAY[:2])
    life = Life(path)
    (published,) = life.journal.adopt(state, state.stamp - 60.0)
    assert life.journal.last == published.stamp == state.stamp
    assert life.mission.position(2000.0) == other.mission.position(2000.0)


def test_where_there_is_still_no_room_the_mark_stays(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    state, _ = seen(path, *PLAY[:2])
    Life(path).play(*PLAY[:1])
    os.rename(path, f"{path}.failed")
    life = Life(path)
    with monkeypatch.context() as broken:
        Disk(broken, good=0)
        life.journal.adopt(state, 1005.0)
        life.play(PLAY[3], first=6)
    assert life.mission.seq == 3 and Life(path).journal.damage


def test_a_plan_is_taken_from_the_journal_that_has_failed(path: Path) -> None:
    state, other = seen(path, *PLAY)
    assert state.plan == 1
    Life(path).play(*PLAY[:8])
    os.rename(path, f"{path}.failed")
    life = Life(path)
    life.journal.adopt(state, 1015.0)
    assert life.mission.in_force == other.mission.in_force and Life(path).mission.in_force == life.mission.in_force


@pytest.mark.parametrize("change", [
    {"plan": 1}, {"unit": 2.0}, {"locations": {}}, {"clocks": {}}, {"values": {}}, {"clocks": {"Cbot": float("nan")}},
    {"locations": {**dict.fromkeys(("bot", "dog", "thief", "rule", "states", "reachObj"), "moon")}}, {"seq": 0},
])
def test_a_state_of_another_model_or_plan_is_not_adopted(path: Path, change: Dict[str, Any]) -> None:
    state, _ = seen(path, *PLAY[:2])
    life = Life(path)
    before = life.state()
    with pytest.raises(DataError):
        life.journal.adopt(state._replace(**change), 1005.0)
    assert life.state() == before and Life(path).mission.status == "waiting"


def test_robots_that_wait_are_as_they_were_seen(path: Path) -> None:
    state, _ = seen(path, *PLAY[:2], ("hear", "bot:_held_"))
    assert (state.status, state.held) == ("holding", ("bot",))
    life = Life(path)
    assert [each.held for each in life.journal.adopt(state, 1004.0)] == [("bot",)], "nothing has changed since"
    assert life.play(("hear", "bot:_resume_"), first=4)[-1].status == "running"
    assert Life(path).state() == life.state()


def test_an_end_that_was_seen_is_adopted_as_the_end(path: Path) -> None:
    state, _ = seen(path, *PLAY[:2], ("hear", "_stop_"))
    life = Life(path)
    (published,) = life.journal.adopt(state, 1005.0)
    assert (published.status, published.reason, published.seq) == ("stopped", "_stop_ was published", 2)
    assert Life(path).mission.status == "stopped"


# Which journal counts -------------------------------------------------------------------------------------------------

MISSION = {**HEADER, "mission": "0123456789ab"}


def test_a_new_observer_learns_whose_mission_was_under_way(path: Path) -> None:
    assert last_mission(str(path), "x").unfinished is None
    life = Life(path, MISSION)
    assert last_mission(str(path), "x").unfinished is None, "it has not begun"
    life.play(("hear", "_start_"))
    assert last_mission(str(path), "x").unfinished == "0123456789ab"
    assert last_mission(str(path), "y").unfinished is None, "that was in another launch"
    life.play(("hear", "_stop_"), first=1)
    assert last_mission(str(path), "x").unfinished == "0123456789ab", "nobody may have heard of its end"
    life.journal.end(1003.0)
    assert last_mission(str(path), "x") == (None, 1003.0)
    Life(path, MISSION)
    assert last_mission(str(path), "x") == (None, 1003.0), "also when the next journal has begun"


def test_the_workspaces_own_mission_may_have_no_name(path: Path) -> None:
    Life(path).play(("hear", "_start_"))
    assert last_mission(str(path), "x").unfinished == ""


@pytest.mark.parametrize("text", ["", "rubbish\nrubbish\n", "[]\n{}\n", '{"format": 1}\n{"call": "hear"}\n'])
def test_what_is_no_journal_says_of_no_mission_that_it_is_under_way(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True)
    path.write_text(text)
    assert last_mission(str(path), "x").unfinished is None


def test_a_journal_of_a_mission_that_never_began_leaves_nothing_behind(path: Path) -> None:
    Life(path, MISSION)
    Life(path).play(("hear", "_start_"))
    assert journals(path) == [path.name]
    assert Life(path).mission.seq == 1


def test_the_newest_journals_are_kept(path: Path) -> None:
    path.parent.mkdir(parents=True)
    for number in range(30):
        old = path.with_name(f"journal-{number:02}.jsonl")
        old.write_text("")
        os.utime(old, (number, number))
    Life(path)
    kept = sorted(entry for entry in journals(path) if entry != path.name)
    assert kept == [f"journal-{number:02}.jsonl" for number in range(11, 30)]


def test_without_a_place_for_it_the_mission_runs_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    life = Life(tmp_path / "file" / "journal.jsonl")
    assert life.play(("hear", "_start_"))[-1].seq == 1
    assert not life.journal.is_open and any(level == "err" for level, _ in life.logs)


def test_the_journals_are_under_ros_home() -> None:
    assert scenario_folder({"ROS_HOME": "/some/where"}, "example") == "/some/where/pursue/example"
    assert scenario_folder({}, "example").endswith("/.ros/pursue/example")
