"""Recordings on the disk: bags and journals, whole, compressed, cut off, damaged."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, List

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from recordings import PLAY, SCENARIO, game, mission, write_bag, write_journal

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.replay import MissionRecord, check, read_recording
from pursue_gen.tools.replay.bag import Message
from pursue_gen.tools.replay.journal import Journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.read import from_messages

GAME: Dict[str, Any] = {
    "format": 1,
    "name": "scenario_1",
    "scenario": SCENARIO.read_text(encoding="utf-8"),
    "rules": {"ends": "reported", "reaction": 0.1, "slack": {}},
    "controllers": "distributed",
    "reach_obj": "dedicated",
}


def read(path: Path) -> MissionRecord:
    """The record in a bag."""
    found = read_recording(path)
    assert isinstance(found, MissionRecord)
    return found


@pytest.mark.parametrize("compression", ["", "BZ2", "LZ4"])
def test_a_bag_is_read_whatever_its_compression(tmp_path: Path, compression: str) -> None:
    record = read(write_bag(mission(), tmp_path / "m.bag", GAME, compression))
    assert not record.problems and record.game == GAME
    assert [state.seq for state in record.states] == list(range(11))
    assert {word.node for word in record.words} == {"UI", *(node for _, _, node in PLAY)}
    assert [(order.robot, order.is_goal) for order in record.orders] == [
        ("bot1", True), ("bot2", True), ("bot1", False), ("bot2", False)
    ]  # fmt: skip
    assert check(record, game()).kept


NAMESPACES = [
    ({"bot1": "tb3_0", "bot2": "/lab/tb3_1"}, "/tb3_0/move_base_simple/goal", "/lab/tb3_1/pursue/actions"),
    ({"bot1": "", "bot2": "bot"}, "/move_base_simple/goal", "/bot/pursue/actions"),
    ({"bot1": "tb3", "bot2": "lab/tb3"}, "/tb3/move_base_flex/move_base/goal", "/lab/tb3/pursue/actions"),
    ({"bot1": "tb3", "bot2": "lab/tb3"}, "/floor/tb3/move_base/goal", "/floor/lab/tb3/pursue/actions"),
]


@pytest.mark.parametrize(("namespaces", "goal", "action"), NAMESPACES)
def test_the_orders_of_a_robot_are_those_in_its_namespace(namespaces: Dict[str, str], goal: str, action: str) -> None:
    told = json.dumps({**GAME, "namespaces": namespaces}).encode()
    word = b"fetch@7"
    record = from_messages([
        Message("/pursue/game", "", "recorder", 1.0, struct.pack("<L", len(told)) + told),
        Message(goal, "", "controller_bot1", 2.0, b"\0" * 100),
        Message(action, "", "controller_bot2", 3.0, struct.pack("<L", len(word)) + word),
    ])  # fmt: skip
    assert [(order.robot, order.is_goal) for order in record.orders] == [("bot1", True), ("bot2", False)]


def test_a_journal_is_worked_out_to_the_same_states(tmp_path: Path) -> None:
    journal = read_recording(write_journal(PLAY, tmp_path / "j.jsonl", unit=0.5))
    assert isinstance(journal, Journal)
    record = reconstruct(journal, Moves(game().network), game().objective)
    assert list(record.states) == mission(unit=0.5).states[1:]
    findings = check(record, game())
    assert (findings.kept, findings.won, findings.findings) == (True, True, ())


def test_a_command_that_the_observer_has_kept_until_it_was_due_led_to_the_state_after_it(tmp_path: Path) -> None:
    """A controller whose clock is ahead is early, by less than the tolerance: the journal has the word, then a tick."""
    journal = read_recording(write_journal(PLAY, tmp_path / "j.jsonl"))
    assert isinstance(journal, Journal)
    (at,) = (number for number, entry in enumerate(journal.entries) if entry.args == ("bot1:bot1_c2b@2",))
    word = journal.entries[at]
    early, due = replace(word, at=word.at - 0.15, seq=2), replace(word, at=word.at - 0.08, call="tick", args=())
    journal = replace(journal, entries=(*journal.entries[:at], early, due, *journal.entries[at + 1:]))
    record = reconstruct(journal, Moves(game().network), game().objective)
    assert [(state.event, state.agent) for state in record.states if state.seq == 3] == [("bot1_c2b", "bot1")]
    findings = check(record, game())
    assert (findings.kept, findings.won) == (True, True), findings.findings


def test_a_journal_shows_where_the_world_left_the_model(tmp_path: Path) -> None:
    play = tuple((at - 1.0 if "c_to_b2b" in word else at, word, node) for at, word, node in PLAY)
    journal = read_recording(write_journal(play, tmp_path / "j.jsonl"))
    assert isinstance(journal, Journal)
    findings = check(reconstruct(journal, Moves(game().network), game().objective), game())
    assert [(f.kind, f.seq) for f in findings.findings] == [("early", 5)]


def test_a_journal_that_ends_in_the_middle_of_a_line_is_read_as_far_as_it_goes(tmp_path: Path) -> None:
    path = write_journal(PLAY, tmp_path / "j.jsonl")
    path.write_bytes(path.read_bytes()[:-150])
    journal = read_recording(path)
    assert isinstance(journal, Journal)
    findings = check(reconstruct(journal, Moves(game().network), game().objective), game())
    assert not findings.kept and "line " in findings.findings[0].text


@pytest.mark.parametrize(
    "content, said",
    [
        (b"", "neither a bag nor a journal"),
        (b"\x7fELF", "neither a bag nor a journal"),
        (b"#ROSBAG V1.2\n", "another format"),
        (b"#ROSBAG V2.0\n", "holds no state of a mission"),
        (b"{}", "is no journal"),
        (b'{"format": 1, "scenario": "s", "unit": "a"}', "no length of a time unit"),
        (b'{"format": 1, "scenario": "s"}', "nothing has happened"),
    ],
)
def test_what_is_no_recording_is_refused_with_what_was_expected(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "file"
    path.write_bytes(content)
    with pytest.raises(PursueError) as refused:
        read_recording(path)
    assert refused.value.exit_status == 2
    assert said in refused.value.diagnostics[0].message and refused.value.diagnostics[0].hint


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PursueError) as refused:
        read_recording(tmp_path / "none.bag")
    assert refused.value.exit_status == 2


@lru_cache(maxsize=None)
def whole(kind: str, folder: Path) -> bytes:
    """The bytes of a good recording."""
    if kind == "journal":
        return write_journal(PLAY, folder / "whole.jsonl").read_bytes()
    return write_bag(mission(), folder / f"whole{kind}.bag", GAME, kind).read_bytes()


def checked(path: Path) -> bool:
    """True where the file can be read and the mission in it is all well; anything but a PursueError fails the test."""
    try:
        found = read_recording(path)
    except PursueError as problem:
        assert problem.exit_status == 2
        return False
    record = reconstruct(found, Moves(game().network), game().objective) if isinstance(found, Journal) else found
    findings = check(record, game())
    return findings.kept and findings.won


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("recordings")


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(kind=st.sampled_from(["", "BZ2", "LZ4", "journal"]), part=st.floats(0.0, 0.999))
@example(kind="LZ4", part=0.7571204649100453)  # ends where a record of the index ends
def test_what_is_cut_off_anywhere_is_read_as_far_as_it_goes(folder: Path, kind: str, part: float) -> None:
    content = whole(kind, folder)
    path = folder / "cut"
    path.write_bytes(content[: int(len(content) * part)])
    good = checked(path)
    # Only what stands after a journal's last event may be missing; of a bag nothing, its index included.
    assert not good or (kind == "journal" and part > 0.9)


def record_ends(bag: bytes) -> List[int]:
    """Where each record of a bag ends: two parts, each after its length."""
    ends, place = [], bag.index(b"\n") + 1
    while place < len(bag):
        for _ in range(2):
            place += 4 + struct.unpack_from("<L", bag, place)[0]
        ends.append(place)
    return ends


@pytest.mark.parametrize("kind", ["", "BZ2", "LZ4"])
def test_a_bag_that_is_cut_off_between_two_records_is_incomplete(folder: Path, tmp_path: Path, kind: str) -> None:
    bag = whole(kind, folder)
    *ends, end = record_ends(bag)
    assert end == len(bag) and len(ends) > 20
    path = tmp_path / "cut.bag"
    for place in ends:
        path.write_bytes(bag[:place])
        assert not checked(path), place


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(kind=st.sampled_from(["", "BZ2", "LZ4", "journal"]), data=st.data())
def test_damaged_bytes_never_end_in_a_traceback(folder: Path, kind: str, data: st.DataObject) -> None:
    content = bytearray(whole(kind, folder))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path = folder / "damaged"
    path.write_bytes(bytes(content))
    checked(path)


def test_a_bag_that_was_never_closed_is_read_to_its_end(folder: Path, tmp_path: Path) -> None:
    """rosbag writes the length of a chunk when it closes it; until then it is 0 and the records follow."""
    content = whole("", folder)
    place = content.index(b"\n") + 1
    for length in (4, 4):  # the head and the data of the first record
        place += length + struct.unpack_from("<L", content, place)[0]
    place += 4 + struct.unpack_from("<L", content, place)[0]  # the head of the chunk
    (size,) = struct.unpack_from("<L", content, place)
    path = tmp_path / "open.bag"
    path.write_bytes(content[:place] + b"\0\0\0\0" + content[place + 4 : place + 4 + size])
    found = read_recording(path)
    assert isinstance(found, MissionRecord)
    assert [state.seq for state in found.states] == list(range(11))
    assert found.problems


def test_json_of_another_shape_on_our_topics_is_passed_over(tmp_path: Path) -> None:
    made = mission()
    for at, topic, text in ((1.0, "plan", "[1]"), (2.0, "plan", "{"), (3.0, "system_state", "x")):
        made.heard.append((at, f"/pursue/{topic}", "somebody", text))
    made.heard.append((4.0, "/pursue/plan", "observer", json.dumps({"plan": "x"})))
    record = read(write_bag(made, tmp_path / "m.bag"))
    assert record.problems == ("3 messages on our topics could not be read",)


@pytest.mark.parametrize("recorded, order", [(99.3, 100.0), (100.2, 100.2), (90.0, 90.0)])
def test_a_goal_is_not_given_before_it_is_sent_unless_the_clocks_are_others(recorded: float, order: float) -> None:
    """The recorder's clock may be late, and a goal may reach it before the state that it follows from."""
    goal = struct.pack("<LLL", 0, 100, 0) + struct.pack("<L", 3) + b"map" + struct.pack("<7d", *[0.0] * 6, 1.0)
    for topic, data in (("move_base_simple/goal", goal), ("move_base/goal", goal[:12] + bytes(12) + goal)):
        record = from_messages([Message(f"/bot1/{topic}", "", "controller_bot1", recorded, data)])
        assert [each.at for each in record.orders] == [order]


def test_a_simple_goal_that_move_base_publishes_again_as_an_action_goal_is_one_order() -> None:
    def pose(x: float, seq: int = 0) -> bytes:
        return struct.pack("<LLL", seq, 100, 0) + struct.pack("<L", 3) + b"map" + struct.pack("<7d", x, *[0.0] * 5, 1.0)

    def action_goal(name: bytes, x: float, seq: int = 0) -> bytes:
        stamps = struct.pack("<LLLL", 7, 100, 5, 0) + struct.pack("<LL", 0, 0)  # of the message and, zero, of the goal
        return stamps + struct.pack("<L", len(name)) + name + pose(x, seq)

    sent = [
        ("/bot1/move_base/goal", "bot1/move_base", action_goal(b"", 1.0)),  # may be recorded first
        ("/bot1/move_base_simple/goal", "controller_bot1", pose(1.0)),
        ("/bot1/move_base/goal", "bot1/move_base", action_goal(b"", 1.0, seq=1)),  # sent to a restarted one alone
        ("/bot2/move_base/goal", "controller_bot2", action_goal(b"bot2-1", 1.0)),
        ("/bot1/move_base/goal", "stranger", action_goal(b"", 2.0)),
    ]
    record = from_messages([Message(topic, "", node, 100.0, data) for topic, node, data in sent])
    assert [order.node for order in record.orders] == ["controller_bot1", "controller_bot2", "stranger"]
