"""One robot over HTTP: its answers are not trusted, and each exchange ends in time."""

from __future__ import annotations

import json
import socket
import time
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List

import pytest
from fake_robot import KEY, FakeRobot, bundle, certificate, saying, serving
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.tools.transport.client import ANSWER_LIMIT, Robot, Unreached, health, plain, send_order
from pursue_gen.tools.transport.client import _status as status_of
from pursue_runtime.bundle import ABORT, Order, write_order
from tests.waiting import PATIENCE

NEW, _ = bundle()
GOOD: Dict[str, Any] = {
    "format": 1, "robot": "bot1", "ticket": "0" * 32, "current": "", "next": None, "prepared": NEW, "kept": [NEW],
    "history": ["", NEW], "scenario": "catch", "packages": ["observer"], "mission_runs": False, "limit": 10,
    "answer": None, "reader": True,
}  # fmt: skip


def http(body: bytes, status: str = "200 OK", length: str = "") -> bytes:
    return f"HTTP/1.1 {status}\r\nContent-Length: {length or len(body)}\r\n\r\n".encode() + body


def asked(answer: bytes, pause: float = 0.0, times: int = 1, timeout: float = PATIENCE) -> str:
    """Why an answer cannot be used, when a robot's health is asked."""
    with saying(answer, pause, times) as port, pytest.raises(Unreached) as problem:
        health(Robot("bot1", "127.0.0.1", port, timeout=timeout))
    assert problem.value.sent
    assert str(problem.value).isprintable()
    return str(problem.value)


def test_a_robot_tells_how_it_is() -> None:
    robot = FakeRobot("bot1", ("observer",))
    robot.history, robot.kept = [NEW], [NEW]
    with serving([robot]) as (place,):
        status = health(place)
    assert (status.robot, status.current, status.next, status.packages) == ("bot1", "", None, ("observer",))
    assert status.standing == ""
    assert status.holds(NEW)
    assert replace(status, next=NEW).standing == NEW


def test_an_order_is_answered_with_how_it_is_then() -> None:
    robot = FakeRobot("bot1")
    order = Order(ABORT, NEW, "bot1", robot.ticket)
    with serving([robot]) as (place,):
        answer = send_order(place, write_order(order, KEY))
        again = send_order(place, write_order(order, KEY))
    assert answer.ok
    assert answer.status is not None
    assert answer.status.ticket == robot.ticket != order.ticket
    assert (again.ok, again.http) == (False, 409)


@pytest.mark.parametrize(
    "answer",
    [
        b"",
        b"\0" * 100,
        b"junk\r\n\r\n",
        b"HTTP/1.1 200 OK\r\nContent-Length: -5\r\n\r\n{}",
        b"HTTP/1.1 200 OK\r\nContent-Length: \xff\r\n\r\n",
        b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nZZ\r\n",
        b"HTTP/1.1 99999 OK\r\n\r\n",
        b"HTTP/1.1 200 OK\r\n" + b"x: y\r\n" * 1000,
        b"HTTP/1.1 200 OK\r\nx: " + b"y" * 100_000,
        b"HTTP/1.1 100 Continue\r\n\r\n" * 1000,
        http(b""),
        http(b"junk"),
        http(b"[]"),
        http(b"null"),
        http(b"\xff\xfe"),
        http(b"[" * 100_000),
        http(b"{}"),
        http(json.dumps(GOOD).encode(), length="100000"),
        http(b"1" * 100_000),
        http(json.dumps(GOOD).encode(), "503 Service Unavailable"),
        http(b"{}", "404 Not Found"),
        http(b"{}", "302 Found\r\nLocation: http://127.0.0.1:1/"),
    ],
)
def test_junk_is_no_answer(answer: bytes) -> None:
    assert asked(answer)


def test_gigabytes_are_not_read() -> None:
    head = b"HTTP/1.1 200 OK\r\nContent-Length: 1000000000000\r\n\r\n"
    assert "more than" in asked(head + b" " * (ANSWER_LIMIT + 1), times=100)
    endless = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n" + b"100000\r\n" + b" " * 2**20 + b"\r\n"
    assert asked(endless + (b"100000\r\n" + b" " * 2**20 + b"\r\n") * 10)


@pytest.mark.parametrize(
    "answer", [b"H", b"HTTP/1.1 200 OK\r\nContent-Length: 9000\r\n\r\n", b"HTTP/1.1 100 Continue\r\n\r\n"]
)
def test_a_slow_drip_ends_in_time(answer: bytes) -> None:
    started = time.monotonic()
    # Each byte comes long before the timeout of one reading; all together would take four minutes.
    assert "no " in asked(answer, pause=0.05, times=4800, timeout=0.3)
    assert time.monotonic() - started < PATIENCE


def test_who_says_nothing_is_given_up() -> None:
    assert asked(b"", pause=1.0, times=100, timeout=0.2) == "no answer in time"


def test_a_reader_that_is_silent_is_reported() -> None:
    assert asked(http(b'{"reader": false, "robot": "bot1"}', "503 X")) == "its pursue_reader is silent"
    assert asked(http(b'{"ok": false, "code": "no_keys", "message": "no key"}', "503 X")) == "no key"
    assert asked(http(b'{"ok": false, "code": "no_keys"}', "503 X")) == "refuses: no_keys"
    assert asked(http(b'{"ok": false, "code": "no_keys", "message": " \\u0000"}', "503 X")) == "refuses: no_keys"
    assert asked(http(b'{"ok": false, "code": 7, "message": []}', "503 X")) == "its pursue_reader is silent"


def test_an_order_may_take_longer_than_a_look() -> None:
    done = json.dumps({"ok": True, "code": "prepared", "message": "", "status": GOOD}).encode()
    with saying(http(done), wait=0.5) as port:
        assert send_order(Robot("bot1", "127.0.0.1", port, timeout=0.2), "an order").ok
    with saying(http(done), wait=PATIENCE) as port, pytest.raises(Unreached):
        health(Robot("bot1", "127.0.0.1", port, timeout=0.2))


def test_who_takes_no_bundle_is_given_up() -> None:
    with socket.socket() as deaf:
        deaf.bind(("127.0.0.1", 0))
        deaf.listen(1)
        robot = Robot("bot1", "127.0.0.1", deaf.getsockname()[1], timeout=0.2)
        with pytest.raises(Unreached) as problem:
            send_order(robot, "an order", b"x" * 10_000_000)
    assert problem.value.sent


def test_an_answer_before_the_bundle_was_taken_is_received() -> None:
    refusal = json.dumps({"ok": False, "code": "too_large", "message": "too large", "status": None}).encode()
    heard: List[int] = []
    with saying(http(refusal, "413 Payload Too Large"), pause=PATIENCE) as port:
        robot = Robot("bot1", "127.0.0.1", port, timeout=PATIENCE)
        answer = send_order(robot, "an order", b"x" * 100_000, heard.append)
    assert (answer.ok, answer.http, answer.code, answer.status) == (False, 413, "too_large", None)
    assert heard


@pytest.mark.parametrize(
    ("robot", "why"),
    [
        (Robot("bot1", "127.0.0.1", 1), "connection refused"),
        (Robot("bot1", "no-such-machine.invalid", 1), "no machine is called no-such-machine.invalid"),
        (Robot("bot1", "a..b", 1), ""),
    ],
)
def test_where_nothing_listens_nothing_was_sent(robot: Robot, why: str) -> None:
    with pytest.raises(Unreached) as problem:
        health(robot)
    assert why in str(problem.value)
    assert not problem.value.sent


def test_a_robots_text_cannot_command_the_terminal() -> None:
    assert plain("a\x1b[2Jb\nc\x00\u202ed") == "a [2Jb c d"
    assert len(plain("x" * 10_000)) < 400
    body = json.dumps({"ok": False, "code": "x", "message": "\x1b]0;you\x07", "status": GOOD}).encode()
    with saying(http(body, "422 Unprocessable")) as port:
        robot = Robot("bot1", "127.0.0.1", port, timeout=PATIENCE)
        assert send_order(robot, "an order").message.isprintable()


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=5) | st.just(NEW),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=2),
    max_leaves=5,
)


@given(name=st.sampled_from(sorted(GOOD)), value=JSON)
def test_what_a_robot_says_of_itself_is_checked(name: str, value: Any) -> None:
    try:
        status = status_of({**GOOD, name: value})
    except Unreached:
        return
    if hasattr(status, name):
        kind = {"next": (str, type(None)), "prepared": (str, type(None)), "mission_runs": bool, "limit": int}
        assert isinstance(getattr(status, name), kind.get(name, (str, tuple)))
    assert all(len(mission) in (0, 64) for mission in (*status.kept, *status.history, status.current))


@pytest.mark.parametrize("name", [name for name in GOOD if name not in ("answer", "reader", "next", "prepared")])
def test_what_is_left_out_is_noticed(name: str) -> None:
    with pytest.raises(Unreached):
        status_of({key: value for key, value in GOOD.items() if key != name})


def test_with_tls_the_certificate_that_is_named_counts(tmp_path: Path) -> None:
    mine, other = tmp_path / "mine.pem", tmp_path / "other.pem"
    mine.write_bytes(certificate("127.0.0.1"))
    other.write_bytes(certificate("127.0.0.1"))
    robot = FakeRobot("bot1")
    with serving([robot], tls=mine) as (place,):
        assert health(place).robot == "bot1"
        for wrong in (replace(place, ca=other), replace(place, ca=None)):
            with pytest.raises(Unreached, match="its certificate is not accepted") as problem:
                health(wrong)
            assert not problem.value.sent
        with pytest.raises(Unreached):
            health(replace(place, tls=False))
    assert robot.requests == ["health"]


def test_with_tls_the_name_of_the_machine_counts(tmp_path: Path) -> None:
    file = tmp_path / "bot1.pem"
    file.write_bytes(certificate("bot1.local"))
    with serving([FakeRobot("bot1")], tls=file) as (place,), pytest.raises(Unreached, match="certificate"):
        health(place)


def test_with_tls_who_does_not_speak_it_is_reported() -> None:
    with serving([FakeRobot("bot1")]) as (place,), pytest.raises(Unreached) as problem:
        health(replace(place, tls=True, timeout=0.5))  # it may wait for the end of what it takes for a line
    assert not problem.value.sent


def test_with_tls_a_handshake_that_never_comes_ends_in_time() -> None:
    with saying(b"", pause=1.0, times=100) as port, pytest.raises(Unreached) as problem:
        health(Robot("bot1", "127.0.0.1", port, tls=True, timeout=0.2))
    assert str(problem.value) == "no answer in time"
