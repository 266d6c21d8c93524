"""A journal that was cut at the end of a record is found by the mark beside it, or by what the master keeps."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any, Dict, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.observer.journal import last_mission
from pursue_runtime.observer.records import format_record, read_records
from pursue_runtime.observer.witnesses import Restart, find_state
from pursue_runtime.state import SystemState
from tests.runtime.observer.test_journal import HEADER, MISSION, PLAY, Life, path

__all__ = ["path"]


def mark_of(path: Path) -> Path:
    """The file of the mark."""
    return path.with_name(f"{path.name}.mark")


def cut(path: Path, records: int) -> None:
    """Leave so many records, each whole."""
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:records]))
    assert not read_records(str(path)).damage


def found(life: Life, **seen: SystemState) -> Restart:
    """How a restarted observer goes on."""
    journal = life.journal
    return find_state(life.mission.state(2000.0), journal.damage, journal.after, seen, True, journal.reached)


@given(st.data())
def test_wherever_a_journal_is_cut_a_new_observer_stops_and_says_what_is_missing(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("journal") / "journal-x.jsonl"
    Life(path).play(*PLAY[:data.draw(st.integers(1, len(PLAY)))])
    whole = read_records(str(path)).records
    left = data.draw(st.integers(1, len(whole) - 1))
    cut(path, left)
    for _ in range(2):  # it stays as it is
        life = Life(path)
        stop = found(life).stop
        assert not life.journal.is_open and "no other node has seen" in stop
        lacking = len(whole) - left
        assert f"{lacking} record{'s are' if lacking > 1 else ' is'} missing at its end" in stop
        assert f"up to state {whole[-1]['seq']}" in stop
    assert len(path.read_bytes().splitlines()) == left, "nothing was written to it"


def test_what_was_published_is_in_the_mark(path: Path) -> None:
    life = Life(path)
    for number, call in enumerate(PLAY):
        states = life.play(call, first=number)
        kept = read_records(str(mark_of(path))).records[0]
        assert kept["records"] == len(read_records(str(path)).records)
        assert not states or (kept["seq"], kept["ended"]) == (states[-1].seq, states[-1].status == "won")
    assert kept["seq"] == 8


def test_a_journal_that_is_ahead_of_its_mark_is_whole(path: Path) -> None:
    """The observer was killed before it had written the mark, or the mark did not come to the disk."""
    life = Life(path)
    life.play(*PLAY[:2])
    shutil.copy(mark_of(path), path.with_name("kept"))
    life.play(*PLAY[2:5], first=2)
    os.replace(path.with_name("kept"), mark_of(path))
    again = Life(path)
    assert again.journal.is_open and found(again) == Restart() and again.state() == life.state()
    cut(path, 3)
    assert Life(path).journal.damage, "the mark is up to date again"


@pytest.mark.parametrize(
    "content",
    [None, b"", b"rubbish\n", b"\x00" * 100, format_record(0, {"seq": 9})],
    ids=["none", "empty", "text", "zeros", "record"],
)
def test_a_whole_journal_needs_no_mark(path: Path, content: Any) -> None:
    before = Life(path)
    before.play(*PLAY[:4])
    os.remove(mark_of(path))
    if content is not None:
        mark_of(path).write_bytes(content)
    life = Life(path)
    assert life.journal.is_open and life.state() == before.state() and found(life) == Restart()
    life.play(*PLAY[4:], first=4)
    if content is None:
        cut(path, 3)
        assert Life(path).journal.damage, "it was written again"
    else:
        assert mark_of(path).read_bytes() == content, "a file that is no mark stays as it is"
        assert any("no mark beside the journal" in text for _, text in life.logs)


def test_a_journal_that_was_deleted_is_missing_by_its_mark(path: Path) -> None:
    Life(path, MISSION).play(*PLAY[:4])
    os.remove(path)
    assert last_mission(str(path), "x").unfinished == MISSION["mission"]
    assert "it is missing" in found(Life(path, MISSION)).stop


def test_where_both_are_gone_the_mark_of_the_master_counts(path: Path) -> None:
    """What `Newest.reached` says of the state before."""
    Life(path).play(*PLAY[:4])
    os.remove(path)
    os.remove(mark_of(path))
    own = Life(path).mission.state(2000.0)
    stop = find_state(own, "", 0.0, {}, True, (3, False)).stop
    assert "it leads to state 0, and the mission had come to state 3" in stop
    assert "had ended in state 3" in find_state(own, "", 0.0, {}, True, (3, True)).stop


def test_the_journal_of_another_launch_in_its_place_is_none_of_this_mission(path: Path) -> None:
    Life(path).play(*PLAY[:4])
    shutil.copy(mark_of(path), path.with_name("kept"))
    Life(path, {**HEADER, "launch": "z"}).play(*PLAY[:2])
    os.replace(path.with_name("kept"), mark_of(path))
    assert last_mission(str(path), "x").unfinished == ""
    assert "another launch" in found(Life(path)).stop


def test_another_launch_begins_anew(path: Path) -> None:
    Life(path).play(*PLAY[:4])
    cut(path, 2)
    life = Life(path, {**HEADER, "launch": "z"})
    assert found(life) == Restart() and life.journal.is_open
    life.play(*PLAY[:4])
    assert Life(path, {**HEADER, "launch": "z"}).state() == life.state()


def test_the_next_mission_of_a_launch_begins_at_0(path: Path) -> None:
    Life(path).play(*PLAY[:3], ("hear", "_stop_"))
    Life(path).journal.end(1005.0)
    life = Life(path)
    assert found(life) == Restart() and life.mission.status == "waiting" and life.journal.is_open
    life.play(("hear", "_start_"), first=10)
    assert Life(path).state() == life.state()


def test_a_journal_from_which_the_end_was_cut_does_not_go_on(path: Path) -> None:
    """The end has the number of the state before."""
    Life(path).play(*PLAY[:2], ("hear", "_stop_"))
    cut(path, 3)
    assert "1 record is missing" in found(Life(path)).stop


def test_what_others_have_seen_is_adopted_where_it_is_not_behind_the_mark(path: Path) -> None:
    life = Life(path)
    states = {state.seq: state for state in life.play(*PLAY[:4])}
    cut(path, 2)
    again = Life(path)
    assert found(again, UI=states[3]) == Restart(adopt=states[3])
    assert "had come to state 3, and UI know of state 2 only" in found(again, UI=states[2]).stop
    again.journal.adopt(states[3], 1010.0)
    assert Life(path).state() == again.state() == life.state()
    assert not Life(path).journal.damage


def test_a_mission_whose_journal_has_failed_is_still_marked(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the journal cannot be renamed."""
    life = Life(path)
    life.play(*PLAY[:2])

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as broken:
        broken.setattr(os, "write", full)
        broken.setattr(os, "rename", full)
        states: List[SystemState] = life.play(*PLAY[3:4], first=2)
    assert states[-1].seq == 3 and not read_records(str(path)).damage
    assert "1 record is missing at its end, up to state 3" in found(Life(path)).stop


def test_a_mission_that_was_stopped_before_it_began_is_not_begun(path: Path) -> None:
    Life(path).play(("stop", "the master is lost"))
    cut(path, 1)
    assert "missing" in found(Life(path)).stop


def test_old_marks_go_with_old_journals(path: Path) -> None:
    path.parent.mkdir(parents=True)
    for number in range(30):
        for ending in ("", ".mark"):
            old = path.with_name(f"journal-{number:02}.jsonl{ending}")
            old.write_text("")
            os.utime(old, (number, number))
    Life(path)
    kept: Dict[str, int] = {ending: len(list(path.parent.glob(f"*{ending}"))) for ending in (".jsonl", ".mark")}
    assert kept == {".jsonl": 20, ".mark": 20}
