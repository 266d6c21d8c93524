"""The missions that were played here: from journals and recordings, damaged ones too, and nothing of anybody else."""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import Any, Dict, List

import pytest

from pursue_runtime.observer.records import format_record
from pursue_runtime.state import SystemState, format_state
from pursue_runtime.ui import past_missions
from pursue_runtime.ui.past_missions import PastMission, PastMissions, shown_missions, workspace_of

MISSION = "0123456789ab"
BEGAN = 1.7e9


def write_journal(path: Path, end: str = "won", unit: float = 2.0, began: float = BEGAN, **end_fields: Any) -> Path:
    """A mission that begins and ends 50 s later, as an observer writes it; `end` "": it was killed before."""
    head = {"format": 2, "scenario": "s", "settings": {"time_unit": unit}, "mission": MISSION, "launch": "x"}
    records: List[Dict[str, Any]] = [
        head,
        {"at": began, "call": "hear", "args": ["_start_"], "seq": 1, "status": "running"},
        {"at": began + 10, "call": "hear", "args": ["bot_a2b@1"], "seq": 2, "status": "running"},
    ]
    if end:
        last = {"at": began + 50, "call": "hear", "args": ["bot_going_a_to_b2b"], "seq": 3, "status": end}
        records += [{**last, **end_fields}, {"at": began + 51, "call": "told"}]
    path.write_bytes(b"".join(format_record(number, record) for number, record in enumerate(records)))
    return path


def write_bag(path: Path, end: str = "won", began: float = BEGAN, closed: bool = True) -> Path:
    """A bag of one chunk, as the recorder writes it (wiki.ros.org/Bags/Format/2.0)."""

    def field(name: bytes, value: bytes) -> bytes:
        return struct.pack("<L", len(name) + 1 + len(value)) + name + b"=" + value

    def record(data: bytes, *fields: bytes) -> bytes:
        head = b"".join(fields)
        return struct.pack("<L", len(head)) + head + struct.pack("<L", len(data)) + data

    def time(seconds: float) -> bytes:
        return struct.pack("<LL", int(seconds), 0)

    states = ((0, -5.0, "waiting", ""), (1, 0.0, "running", "_start_"), (7, 50.0, end, "bot_going_a_to_b2b"))
    texts = b"".join(
        format_state(SystemState(seq, began + after, {"bot": "a"}, {}, {}, event, "bot", status, "", 2.0)).encode()
        for seq, after, status, event in states
    )
    chunk = record(texts, field(b"op", b"\x05"), field(b"compression", b"none"), field(b"size", struct.pack("<L", 9)))
    start = b"#ROSBAG V2.0\n"
    place = len(start) + 4096
    position = place + len(chunk) if closed else 0
    numbers = field(b"conn_count", struct.pack("<L", 1)) + field(b"chunk_count", struct.pack("<L", 1))
    head = field(b"op", b"\x03") + field(b"index_pos", struct.pack("<Q", position)) + numbers
    padding = b" " * (4096 - 8 - len(head))
    info = field(b"op", b"\x06") + field(b"start_time", time(began - 9)) + field(b"end_time", time(began + 60))
    index = record(b"", field(b"op", b"\x07"), field(b"topic", b"/x")) + record(b"", info) if closed else b""
    path.write_bytes(start + record(padding, head) + chunk + index)
    return path


def only(folder: Path, **known: str) -> PastMission:
    (mission,) = PastMissions(str(folder), **known).read()
    return mission


@pytest.mark.parametrize("end", ["won", "lost", "stopped"])
def test_a_journal_gives_result_time_duration_and_the_command_that_replays_it(tmp_path: Path, end: str) -> None:
    path = write_journal(tmp_path / "journal-x y.jsonl".replace(" ", "_"), end)
    found = only(tmp_path, mission=MISSION, workspace="/my ws")
    assert (found.result, found.began, found.units) == (end, BEGAN, 25.0)
    assert found.replay == f"pursue-gen replay {path} --workspace '/my ws'"
    assert only(tmp_path, mission="another", workspace="/ws").replay == f"pursue-gen replay {path} SCENARIO.pur"


@pytest.mark.parametrize("fields, why", [
    ({"call": "stop", "args": ["no other plan"]}, "no other plan"),
    ({"args": ["_stop_"]}, "_stop_ was published"),
])
def test_why_a_mission_was_stopped_is_listed(tmp_path: Path, fields: Dict[str, Any], why: str) -> None:
    write_journal(tmp_path / "journal-x.jsonl", "stopped", **fields)
    assert only(tmp_path).why == why


@pytest.mark.parametrize("unit, units", [(0.5, 100.0), (1e-10, 50.0), (1e10, 50.0)])
def test_the_duration_is_in_the_time_units_of_the_mission_and_a_unit_that_none_has_is_a_second(
    tmp_path: Path, unit: float, units: float
) -> None:
    write_journal(tmp_path / "journal-x.jsonl", unit=unit)
    assert only(tmp_path).units == units


@pytest.mark.parametrize("word, why", [("_start_", ""), ("thief_a2b@2", "with thief_a2b@2")])
def test_a_mission_is_lost_with_a_word_but_not_with_its_start(tmp_path: Path, word: str, why: str) -> None:
    write_journal(tmp_path / "journal-x.jsonl", "lost", args=[word])
    assert only(tmp_path).why == why


def test_one_whose_observer_was_killed_is_not_finished_and_one_that_never_began_is_none(tmp_path: Path) -> None:
    write_journal(tmp_path / "journal-killed.jsonl", "")
    (tmp_path / "journal-waits.jsonl").write_bytes(format_record(0, {"format": 2, "launch": "y"}))
    found = only(tmp_path)
    assert (found.result, found.units) == ("not finished", 5.0)


def test_recordings_are_joined_with_the_journal_of_their_mission(tmp_path: Path) -> None:
    journal, bag = write_journal(tmp_path / "journal-x.jsonl"), write_bag(tmp_path / "mission.bag")
    write_bag(tmp_path / "mission-2.bag", "lost", BEGAN + 1000)
    first, second = sorted(PastMissions(str(tmp_path)).read(), key=lambda mission: mission.began or 0)
    assert (first.result, first.files) == ("won", (str(bag), str(journal)))
    assert first.replay == f"pursue-gen replay {bag}", "it holds its scenario"
    assert (second.result, second.began, second.units) == ("lost", BEGAN + 1000, 25.0)
    shown = shown_missions([first, second], BEGAN + 1e-6)
    assert [each["present"] for each in shown] == [True, False]


def test_a_journal_that_the_next_observer_will_rename_is_not_named_yet(tmp_path: Path) -> None:
    write_journal(tmp_path / "journal-x.jsonl")
    missions = PastMissions(str(tmp_path)).read()
    (shown,) = shown_missions(missions, BEGAN, is_settled=False)
    assert (shown["result"], shown["files"], shown["replay"]) == ("won", [], "")
    assert shown_missions(missions, BEGAN + 5, is_settled=False)[0]["files"], "that of another mission is as it is"
    assert shown_missions(missions, BEGAN)[0]["replay"]


def test_damaged_files_are_listed_as_such(tmp_path: Path) -> None:
    lines = write_journal(tmp_path / "journal-cut.jsonl", "").read_bytes().splitlines(keepends=True)
    (tmp_path / "journal-cut.jsonl").write_bytes(lines[0] + lines[1][:20] + b"\n" + lines[2])
    (tmp_path / "journal-empty.jsonl").touch()
    write_bag(tmp_path / "killed.bag.active", closed=False)
    (tmp_path / "junk.bag").write_bytes(os.urandom(6000))
    whole = write_bag(tmp_path / "short.bag").read_bytes()
    (tmp_path / "short.bag").write_bytes(whole[:-40])
    (tmp_path / "shorter.bag").write_bytes(whole[:4000])
    found = {os.path.basename(each.files[0]): each for each in PastMissions(str(tmp_path)).read()}
    assert {each.result for each in found.values()} == {"damaged"} and len(found) == 6
    assert "record 1 is damaged" in found["journal-cut.jsonl"].why
    assert found["journal-empty.jsonl"].why == "its journal: it is empty"
    assert found["killed.bag.active"].why == "its recording: its recorder did not close it"
    assert found["junk.bag"].why == "its recording: it is no bag of format 2.0"


@pytest.mark.parametrize("cut", range(0, 4800, 97))
def test_a_bag_that_ends_anywhere_or_has_a_wrong_byte_anywhere_does_no_harm(tmp_path: Path, cut: int) -> None:
    whole = bytearray(write_bag(tmp_path / "a.bag").read_bytes())
    (tmp_path / "b.bag").write_bytes(whole[:cut])
    whole[cut % len(whole)] ^= 0xFF
    (tmp_path / "c.bag").write_bytes(whole)
    assert len(PastMissions(str(tmp_path)).read()) == 3


def test_a_journal_that_could_not_be_written_to_the_end_is_listed_with_that(tmp_path: Path) -> None:
    write_journal(tmp_path / "journal-x.jsonl.failed", "")
    assert only(tmp_path).why == "its journal could not be written to the end"


def test_what_is_being_recorded_is_not_listed(tmp_path: Path) -> None:
    write_bag(tmp_path / "mission.bag.active", closed=False)
    assert PastMissions(str(tmp_path)).read(str(tmp_path / "mission.bag")) == []


def test_links_folders_pipes_and_other_names_are_not_read(tmp_path: Path) -> None:
    folder, outside = tmp_path / "s", tmp_path / "outside"
    folder.mkdir()
    outside.mkdir()
    secret = write_journal(outside / "journal-secret.jsonl")
    (folder / "journal-link.jsonl").symlink_to(secret)
    (folder / "journal-folder.jsonl").mkdir()
    os.mkfifo(folder / "journal-pipe.jsonl")
    write_journal(folder / "notes.txt")
    write_journal(folder / "journal-x.jsonl.bak")
    assert PastMissions(str(folder)).read() == []
    assert PastMissions(str(tmp_path / "nowhere")).read() == []


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may give files away")
def test_files_of_other_users_are_not_read(tmp_path: Path) -> None:
    os.chown(write_journal(tmp_path / "journal-x.jsonl"), 12345, 12345)
    assert PastMissions(str(tmp_path)).read() == []


def test_so_many_are_listed_and_large_journals_are_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(past_missions.MOST + 5):
        path = write_journal(tmp_path / f"journal-{number}.jsonl", began=BEGAN + number)
        os.utime(path, (BEGAN + number, BEGAN + number))
    listed = PastMissions(str(tmp_path)).read()
    assert len(listed) == past_missions.MOST
    assert listed[0].began == BEGAN + past_missions.MOST + 4, "the newest first"
    monkeypatch.setattr(past_missions, "MOST_BYTES", 10)
    assert {each.result for each in PastMissions(str(tmp_path)).read()} == {"not known"}


def test_files_are_read_again_when_they_change(tmp_path: Path) -> None:
    missions = PastMissions(str(tmp_path))
    write_journal(tmp_path / "journal-x.jsonl", "")
    assert [each.result for each in missions.read()] == ["not finished"]
    write_journal(tmp_path / "journal-x.jsonl", "won")
    assert [each.result for each in missions.read()] == ["won"]
    os.remove(tmp_path / "journal-x.jsonl")
    assert missions.read() == []


def test_the_workspace_is_found_where_it_has_the_game(tmp_path: Path) -> None:
    config, game = tmp_path / "ws/src/UI/config", tmp_path / "ws/src/observer/config/game.yaml"
    config.mkdir(parents=True)
    assert workspace_of(str(config)) == ""
    game.parent.mkdir(parents=True)
    game.touch()
    assert workspace_of(str(config)) == str(tmp_path / "ws")
    assert workspace_of("/opt/ws/share/UI/config") == ""
