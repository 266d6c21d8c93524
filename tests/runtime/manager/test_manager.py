"""Whose orders count at a robot's door, what is answered, and how little strangers can do to its log."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Dict, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime import bundle as mission_bundle
from pursue_runtime.bundle import KeyFolder
from pursue_runtime.manager import manager as manager_core
from pursue_runtime.manager.manager import (
    HTTP,
    Manager,
    RequestLog,
    RequestRefused,
    check_bundle,
    mission_message,
    parse_length,
    topic_names,
)
from tests.runtime.manager_stage import ROBOT, Desk

TICKET = "0" * 31 + "1"
MISSION = "a" * 64


def status(**more: object) -> str:
    return json.dumps({"format": 1, "robot": ROBOT, "ticket": TICKET, "limit": 1000, "answer": None, **more})


@pytest.fixture
def manager(tmp_path: Path) -> Any:
    """One that trusts desk 1 and hears its reader."""
    Desk().trusted_by(tmp_path)
    made = Manager(ROBOT, KeyFolder(str(tmp_path)), lambda: True)
    made.on_status(status())
    return made


def refused(manager: Any, text: Any, length: Any = 0, chunked: bool = False) -> Any:
    with pytest.raises(RequestRefused) as caught:
        manager.check_order(text, length, chunked)
    return caught.value.answer.http, caught.value.answer.code


def test_a_right_order_is_taken(manager: Any) -> None:
    for body in (b"", b"bundle"):
        order = manager.check_order(Desk().order(TICKET, mission=MISSION, body=body), len(body), False)
        assert (order.action, order.mission, order.size) == ("prepare", MISSION, len(body))
    assert manager.check_order(Desk().order(TICKET, "commit", MISSION), None, False).action == "commit"


def test_each_reason_to_refuse_has_its_word(manager: Any) -> None:
    desk = Desk()
    good = desk.order(TICKET, body=b"12345")
    assert refused(manager, None) == (400, "bad_order")
    assert refused(manager, "") == (400, "bad_order")
    assert refused(manager, "x" * 5000) == (400, "bad_order")
    assert refused(manager, "a.b.c") == (400, "bad_order")
    assert refused(manager, "é.ü.\x00") == (400, "bad_order")
    assert refused(manager, Desk(2).order(TICKET)) == (401, "unknown_key")
    assert refused(manager, good[:-4] + ("AAA=" if good[-4:] != "AAA=" else "BBB=")) == (401, "bad_signature")
    assert refused(manager, desk.order(TICKET, robot="bot2")) == (403, "wrong_robot")
    assert refused(manager, desk.order("f" * 32)) == (409, "old_ticket")
    assert refused(manager, good, None) == (411, "no_length")
    assert refused(manager, good, 5, chunked=True) == (411, "no_length")
    assert refused(manager, desk.order(TICKET, body=b"x" * 1001), 1001) == (413, "too_large")
    assert refused(manager, good, 4) == (400, "bad_length")
    assert refused(manager, desk.order(TICKET, "commit", MISSION, b"12345"), 5) == (400, "bad_order")


def test_the_smaller_limit_counts(tmp_path: Path) -> None:
    Desk().trusted_by(tmp_path)
    manager = Manager(ROBOT, KeyFolder(str(tmp_path)), lambda: True, limit=10)
    manager.on_status(status())
    assert refused(manager, Desk().order(TICKET, body=b"x" * 11), 11) == (413, "too_large")


def test_without_a_reader_nothing_is_taken(tmp_path: Path) -> None:
    Desk().trusted_by(tmp_path)
    there: List[bool] = []
    manager = Manager(ROBOT, KeyFolder(str(tmp_path)), lambda: bool(there))
    order = Desk().order(TICKET)
    assert refused(manager, order) == (503, "no_reader")
    there.append(True)
    assert refused(manager, order) == (503, "no_reader"), "it has not spoken yet"
    assert manager.health() == (503, {"robot": ROBOT, "reader": False})
    manager.on_status(status())
    assert manager.check_order(order, 0, False)
    assert manager.health()[0] == 200 and manager.health()[1]["reader"] is True
    there.clear()
    assert refused(manager, order) == (503, "no_reader")
    assert manager.status() == {} and manager.condition() == ("warn", "pursue_reader is silent")


@pytest.mark.parametrize("text", [
    "", "{", "[]", "null", '"x"', "[" * 100000, "{}", status(format=2), status(robot="bot2"), status(ticket=5),
    status(robot=None), status(padding="x" * (1 << 20)),
])
def test_what_is_no_status_of_our_reader_changes_nothing(manager: Any, text: str) -> None:
    before = manager.status()
    manager.on_status(text)
    assert manager.status() == before


@given(st.text(max_size=60) | st.binary(max_size=40).map(lambda b: b.decode("latin1")), st.integers(0, 2**70))
def test_junk_is_refused_and_nothing_else(tmp_path_factory: pytest.TempPathFactory, text: str, length: int) -> None:
    keys = tmp_path_factory.getbasetemp() / "no_keys"
    manager = Manager(ROBOT, KeyFolder(str(keys)), lambda: True)
    manager.on_status(status())
    assert refused(manager, text, length)[0] in (400, 401)


# Keys

def test_keys_count_from_the_moment_they_are_there_until_they_are_taken_away(tmp_path: Path) -> None:
    folder = KeyFolder(str(tmp_path / "keys"))
    manager = Manager(ROBOT, folder, lambda: True)
    manager.on_status(status())
    assert refused(manager, Desk().order(TICKET)) == (401, "unknown_key")
    assert manager.condition()[0] == "warn" and str(tmp_path / "keys") in manager.condition()[1]
    Desk().trusted_by(tmp_path / "keys")
    assert manager.check_order(Desk().order(TICKET), 0, False)
    assert manager.condition() == ("ready", "takes missions")
    (only,) = (tmp_path / "keys").iterdir()
    only.unlink()
    assert refused(manager, Desk().order(TICKET)) == (401, "unknown_key")


def test_a_key_that_is_replaced_by_one_of_the_same_size_is_read_again(tmp_path: Path) -> None:
    folder = KeyFolder(str(tmp_path))
    for seed in (1, 2):
        text = mission_bundle.write_public_key(Desk(seed).key.public_key(), "desk")
        (tmp_path / "new").write_text(text)
        os.replace(tmp_path / "new", tmp_path / "desk.pub")
        assert list(folder.keys()) == [mission_bundle.fingerprint(Desk(seed).key.public_key())]


def test_files_that_hold_no_key_are_reported(tmp_path: Path) -> None:
    Desk().trusted_by(tmp_path)
    (tmp_path / "junk.pub").write_bytes(b"\xff")
    folder = KeyFolder(str(tmp_path))
    manager = Manager(ROBOT, folder, lambda: True)
    manager.on_status(status())
    assert manager.check_order(Desk().order(TICKET), 0, False), "the others count"
    assert manager.condition()[0] == "warn" and "junk.pub" in manager.condition()[1]


def test_where_others_reach_it_and_nobody_is_trusted_everything_is_refused(tmp_path: Path) -> None:
    manager = Manager(ROBOT, KeyFolder(str(tmp_path)), lambda: True, exposed=True)
    assert manager.condition()[0] == "error"
    with pytest.raises(RequestRefused) as caught:
        manager.check_trust()
    assert (caught.value.answer.http, caught.value.answer.code) == (503, "no_keys")
    Desk().trusted_by(tmp_path)
    manager.check_trust()


# What the reader answers

def answered(manager: Any, ticket: str = TICKET, **answer: object) -> Any:
    manager.on_status(status(ticket="2" * 32, answer={"ticket": TICKET, "ok": False, "message": "m", **answer}))
    return manager.answer_to(ticket)


def test_the_readers_answer_becomes_the_servers(manager: Any) -> None:
    assert manager.answer_to(TICKET) is None
    assert answered(manager, ok=True, code="done") == (200, "done", "m", True)
    assert answered(manager, code="bad_bundle")[:2] == (422, "bad_bundle")
    assert answered(manager, code="unknown_key")[:2] == (401, "unknown_key")
    assert answered(manager, code="too_large")[:2] == (413, "too_large")
    assert answered(manager, code="not_prepared")[:2] == (409, "not_prepared")
    assert answered(manager, ok="yes", code="done")[3] is False
    assert answered(manager)[:2] == (409, "None")


def test_a_reader_that_began_anew_is_not_waited_for(manager: Any) -> None:
    manager.on_status(status(ticket="3" * 32))
    assert manager.answer_to(TICKET)[:2] == (504, "no_answer")


# Bundles, lengths, messages

def test_the_body_is_the_one_that_the_order_is_about() -> None:
    order = mission_bundle.Order("prepare", "", ROBOT, TICKET, 3, manager_core.hashlib.sha256(b"abc").hexdigest())
    check_bundle(order, b"abc")
    for body in (b"", b"ab", b"abd", b"abcd"):
        with pytest.raises(RequestRefused):
            check_bundle(order, body)


def test_messages_carry_the_order_as_it_came() -> None:
    assert json.loads(mission_message("o.k.s", b"")) == {"order": "o.k.s"}
    assert json.loads(mission_message("o", b"\x00\xff")) == {"order": "o", "bundle": "AP8="}


@pytest.mark.parametrize("text", ["", "-1", "+1", "1_0", " 1", "1 ", "0x1", "1,1", "1e3", "\u0661", "9" * 16, "1\n"])
def test_lengths_are_plain_numbers(text: str) -> None:
    with pytest.raises(RequestRefused):
        parse_length(text)
    assert parse_length(None) is None
    assert parse_length("042") == 42


# The log

def test_the_log_gets_a_line_now_and_then_and_the_counts_get_all() -> None:
    now, lines, notes = [0.0], [], []  # type: ignore[var-annotated]
    record = RequestLog(lines.append, notes.append, lambda: now[0])
    for _ in range(1000):
        record.count("401", "a stranger")
    record.count("200")
    assert lines == ["a stranger"] and record.counts == {"401": 1000, "200": 1}
    record.log("200", "a mission")
    assert notes == ["a mission"] and record.counts["200"] == 2, "strangers do not keep it out"
    now[0] = 11.0
    record.count("404", "another")
    assert lines[1:] == ["another (and 999 more that were not logged)"]


def test_topics_are_named_with_commas_between() -> None:
    assert topic_names("") == topic_names(" , ") == []
    assert topic_names("pursue/events, /bot1/x,pursue/events") == ["pursue/events", "/bot1/x"]
    for wrong in ("a b", "1a", "a,ü", "a;b", "//"):
        with pytest.raises(ValueError, match="not the name of a topic"):
            topic_names(wrong)


def test_every_word_has_a_status_of_http() -> None:
    codes: Dict[str, int] = HTTP
    assert all(400 <= http < 600 for http in codes.values())
