"""The server that robots leave switched on: what it takes, what it answers, and what it does not wait for."""

from __future__ import annotations

import base64
import datetime
import ipaddress
import json
import ssl
import time
from pathlib import Path
from typing import Any, Callable, Iterator, List, Optional, Tuple

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID

from pursue_runtime import bundle as mission_bundle
from pursue_runtime.http_server import ServerError, bind
from pursue_runtime.manager.manager import LONGEST_HEADER
from pursue_runtime.manager.server import Limits, tls
from tests.runtime.manager_stage import ROBOT, Desk, Robot, ask, exchange, head, parse, send
from tests.waiting import connected, dripping, flooded, rest, until

Serve = Callable[..., Robot]


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """`serve(...)`: a robot that trusts desk 1."""
    Desk().trusted_by(tmp_path / "keys")
    started: List[Robot] = []

    def start(**options: Any) -> Robot:
        started.append(Robot(tmp_path, **options))
        return started[-1]

    yield start
    for robot in started:
        robot.close()


# What it is for

def test_it_says_how_the_robot_is(serve: Serve) -> None:
    robot = serve()
    told = ask(robot)
    assert (told.http, told.facts["reader"], told.facts["ticket"]) == (200, True, robot.reader.ticket)
    assert told.headers["Content-Type"] == "application/json" and "Server" not in told.headers
    robot.reader.there = False
    told = ask(robot)
    assert (told.http, told.facts) == (503, {"robot": ROBOT, "reader": False})


def test_a_mission_goes_to_the_reader_and_its_answer_comes_back(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    digest, content = desk.bundle()
    order = desk.order(robot.reader.ticket, mission=digest, body=content)
    told = send(robot, order, content)
    assert (told.http, told.facts["ok"], told.facts["code"]) == (200, True, "prepared")
    assert told.facts["status"]["ticket"] == robot.reader.ticket and digest in told.facts["status"]["kept"]
    (message,) = robot.reader.messages
    assert message == {"order": order, "bundle": base64.b64encode(content).decode()}
    until(lambda: any(f"prepare, mission {digest[:12]}" in line for line in robot.notes), "a line in the log")


def test_orders_without_a_bundle_need_no_body(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    assert send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64)).http == 200
    answer = exchange(robot.port, head(Pursue_Order=desk.order(robot.reader.ticket, "abort")))
    assert parse(answer).http == 200
    assert all("bundle" not in message for message in robot.reader.messages)


def test_an_order_counts_once(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    order = desk.order(robot.reader.ticket, "commit", "a" * 64)
    assert send(robot, order).http == 200
    told = send(robot, order)
    assert (told.http, told.facts["code"]) == (409, "old_ticket")
    assert told.facts["status"]["ticket"] == robot.reader.ticket, "with the right one"
    assert len(robot.reader.messages) == 1


def test_what_the_reader_refuses_is_reported(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    robot.reader.verdict = {"ok": False, "code": "bad_bundle", "message": "not right"}
    told = send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64))
    assert (told.http, told.facts["ok"], told.facts["message"]) == (422, False, "not right")


def test_a_large_mission_arrives_whole(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    digest, content = desk.bundle(files={"observer/model.yaml": b"x" * 3_000_000})
    told = send(robot, desk.order(robot.reader.ticket, mission=digest, body=content), content)
    assert told.http == 200
    assert base64.b64decode(robot.reader.messages[0]["bundle"]) == content


def test_a_client_that_asks_first_gets_a_continue(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    order = desk.order(robot.reader.ticket, body=b"abc")
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=3, Pursue_Order=order, Expect="100-continue"))
        assert there.recv(1000).startswith(b"HTTP/1.1 100 ")
        there.sendall(b"abc")
        assert there.recv(1000).startswith(b"HTTP/1.1 200 ")
    refused = head(Content_Length=3, Pursue_Order=order, Expect="100-continue")
    assert exchange(robot.port, refused).startswith(b"HTTP/1.1 409 "), "a used ticket"


def test_a_ticket_that_is_used_up_while_the_body_comes_is_old(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    order = desk.order(robot.reader.ticket, body=b"abc")
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=3, Pursue_Order=order) + b"ab")
        until(lambda: robot.server.busy, "the upload has begun")
        robot.reader.ticket = "f" * 32
        robot.say(robot.reader.status())
        until(lambda: robot.manager.status()["ticket"] == "f" * 32, "the reader has begun anew")
        there.sendall(b"c")
        assert there.recv(1000).startswith(b"HTTP/1.1 409 ")
    assert robot.reader.messages == []


# What it refuses, before it reads

def test_a_refused_body_is_not_read_and_the_answer_is_received(serve: Serve) -> None:
    robot = serve()
    order = Desk(2).order(robot.reader.ticket, body=b"x" * 500_000)
    told = parse(exchange(robot.port, head(Content_Length=500_000, Pursue_Order=order), b"x" * 500_000))
    assert (told.http, told.facts["code"]) == (401, "unknown_key")
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=50_000_000, Pursue_Order=order))
        assert there.recv(100).startswith(b"HTTP/1.1 401 "), "without a byte of the body"
    assert robot.reader.messages == []


def test_a_gigabyte_is_refused_by_its_announcement(serve: Serve) -> None:
    robot = serve()
    told = ask(robot, "/mission", "POST", Content_Length=2**30, Pursue_Order="junk")
    assert told.http == 400
    size = 2**30
    order = Desk().order(robot.reader.ticket, size=size, bundle="a" * 64)
    told = ask(robot, "/mission", "POST", Content_Length=size, Pursue_Order=order)
    assert (told.http, told.facts["code"]) == (413, "too_large")


def test_a_refused_client_that_goes_on_sending_is_cut_off(serve: Serve) -> None:
    robot = serve()
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=10**9, Pursue_Order="junk"))
        sent = 0
        with pytest.raises(OSError):
            while sent < 100 << 20:
                sent += there.send(b"x" * 65536)
    assert sent < 50 << 20
    assert ask(robot).http == 200


def test_a_body_that_is_not_the_one_of_the_order_is_refused(serve: Serve) -> None:
    robot = serve()
    order = Desk().order(robot.reader.ticket, body=b"abc")
    told = send(robot, order, b"abd")
    assert (told.http, told.facts["code"]) == (422, "bad_bundle")
    assert robot.reader.messages == []
    assert send(robot, order, b"abc").http == 200, "the ticket is still good"


@pytest.mark.parametrize("path, method, http", [
    ("/", "GET", 404), ("/nothing", "POST", 404), ("/../health", "GET", 404), ("/%2e%2e/health", "GET", 404),
    ("/health/", "GET", 404), ("//health", "GET", 404), ("/mission/../../etc/passwd", "POST", 404),
    ("/health", "POST", 405), ("/health", "PUT", 405), ("/health", "HEAD", 405), ("/mission", "GET", 405),
    ("/mission", "DELETE", 405), ("/mission", "OPTIONS", 405), ("/mission", "BREW", 405), ("/health?x=%00", "GET", 200),
])
def test_there_is_nothing_else(serve: Serve, path: str, method: str, http: int) -> None:
    robot = serve()
    answer = exchange(robot.port, head(path, method, Content_Length=0))
    assert answer.startswith(b"HTTP/1.1 %d " % http)
    assert b"Traceback" not in answer and b"ornado" not in answer and b"/usr" not in answer


@pytest.mark.parametrize("lines, http", [
    ("GET /health HTTP/1.1\r\nHost: a b", 400), ("GET /health HTTP/1.1\r\nHost: a\r\nHost: b", 400),
    ("GET /health HTTP/1.1\r\nHost: a\x00b", 400), ("GET /health HTTP/1.1\r\nContent-Length: -1", 400),
    ("GET /health HTTP/1.1\r\nContent-Length: 1_0", 400), ("GET /health HTTP/1.1\r\nContent-Length: 5", 400),
    ("POST /mission HTTP/1.1\r\nContent-Length: 5, 6", 400), ("POST /mission HTTP/1.1\r\nContent-Length: 5, 5", 400),
    ("POST /mission HTTP/1.1\r\nPursue-Order: a\r\nPursue-Order: b", 400), ("GET /health HTTP/1.1\r\nno colon", 400),
    ("GET /health HTTP/3", 400), ("GET\x00 / HTTP/1.1", 405), ("\x16\x03\x01\x02\x00", 400), ("", 400),
    ("GET /health HTTP/1.1\r\nA: " + "x" * 70000, 0),
])
def test_what_is_no_request_of_ours_does_no_harm(serve: Serve, lines: str, http: int) -> None:
    robot = serve()
    told = parse(exchange(robot.port, lines.encode("latin1")[:65536] + b"\r\n\r\n", b"\r\n" * 100))
    assert told.http in (http, 0) and told.facts.get("ok", False) is False
    assert ask(robot).http == 200
    assert "errors" not in robot.record.counts, robot.lines


def test_a_right_order_in_chunks_needs_a_length(serve: Serve) -> None:
    robot = serve()
    order = Desk().order(robot.reader.ticket, body=b"abc")
    for more in ({}, {"Content_Length": 3}):
        request = head(Transfer_Encoding="chunked", Pursue_Order=order, **more)
        assert parse(exchange(robot.port, request)).http == 411
    assert parse(exchange(robot.port, head(Pursue_Order=order))).http == 411


@pytest.mark.parametrize("method, path", [("POST", "/mission"), ("GET", "/health"), ("BREW", "/mission"), ("PUT", "/")])
def test_chunks_are_not_even_counted(serve: Serve, method: str, path: str) -> None:
    """A negative size leads tornado 6.2 into a loop without end: all other clients would wait for ever."""
    robot = serve()
    for more in (b"-1\r\n", b"zz\r\n", b"-0\r\n", b"+5\r\nabcde\r\n"):
        answer = parse(exchange(robot.port, head(path, method, Transfer_Encoding="chunked") + more))
        assert answer.http in (400, 404, 405, 411)
    assert ask(robot).http == 200
    assert "errors" not in robot.record.counts, robot.lines


def test_one_request_a_connection_whatever_follows(serve: Serve) -> None:
    robot = serve()
    order = head(Content_Length=0, Pursue_Order=Desk().order(robot.reader.ticket, "commit"))
    answer = exchange(robot.port, head("/health", "GET") * 20 + order + b"\x00junk\r\n\r\n")
    assert answer.count(b"HTTP/1.1") == 1 and b"Connection: close" in answer
    assert ask(robot).http == 200
    until(lambda: robot.record.counts.get("200") == 2, "two were answered")
    assert robot.reader.messages == []


def test_where_others_reach_it_and_no_key_is_trusted_no_details_are_returned(serve: Serve, tmp_path: Path) -> None:
    for key in (tmp_path / "keys").iterdir():
        key.unlink()
    robot = serve(exposed=True)
    for told in (ask(robot), ask(robot, "/nothing"), send(robot, Desk().order(robot.reader.ticket))):
        assert (told.http, told.facts["code"]) == (503, "no_keys")
    Desk().trusted_by(tmp_path / "keys")
    assert ask(robot).http == 200


# Who takes long

def test_one_order_at_a_time(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    order = desk.order(robot.reader.ticket, body=b"x" * 1000)
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=1000, Pursue_Order=order) + b"x" * 10)
        until(lambda: robot.server.busy, "the upload has begun")
        told = send(robot, order, b"x" * 1000)
        assert (told.http, told.facts["code"]) == (503, "busy")
        assert ask(robot).http == 200
    until(lambda: not robot.server.busy, "who goes lets others in")
    assert send(robot, order, b"x" * 1000).http == 200


def test_a_body_that_drips_is_not_waited_for(serve: Serve) -> None:
    robot = serve(window=0.3)
    order = Desk().order(robot.reader.ticket, body=b"x" * 100_000)
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=100_000, Pursue_Order=order))
        with dripping(there, b"x"):
            assert rest(there).startswith(b"HTTP/1.1 408 ")
    # On a busy machine the next one may be too slow as well.
    until(lambda: send(robot, order, b"x" * 100_000).http == 200, "it is free for others, and the ticket still good")


def test_a_body_that_is_fast_enough_but_too_long_under_way_ends_too(serve: Serve) -> None:
    robot = serve(upload=0.5, rate=1.0, window=0.1)
    order = Desk().order(robot.reader.ticket, body=b"x" * 100_000)
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=100_000, Pursue_Order=order))
        with dripping(there, b"x" * 10):
            assert rest(there).startswith(b"HTTP/1.1 408 ")


def test_a_head_that_drips_is_closed(serve: Serve) -> None:
    with connected(serve(header=0.3).port) as there:
        there.sendall(b"GET /health HTTP/1.1\r\nA: ")
        with dripping(there, b"x"):
            assert rest(there) == b""


@pytest.mark.parametrize("address", ["127.0.0.1", "127.0.0.2"])
def test_a_flood_keeps_no_order_out(serve: Serve, address: str) -> None:
    robot, desk = serve(), Desk()
    with flooded(robot.port, address):
        assert ask(robot).http == 200
        assert send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64)).http == 200
        assert robot.record.counts["turned away"] >= 100 - robot.server.limits.connections // 2


def test_an_upload_that_has_begun_is_not_ended_by_a_flood(serve: Serve) -> None:
    robot = serve()
    order = Desk().order(robot.reader.ticket, body=b"abc")
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=3, Pursue_Order=order) + b"ab")
        until(lambda: robot.server.busy, "the upload has begun")
        with flooded(robot.port, "127.0.0.1"):
            assert ask(robot).http == 200, "all of them have been accepted"
            there.sendall(b"c")
            assert there.recv(1000).startswith(b"HTTP/1.1 200 ")


def test_a_reader_that_does_not_answer_is_reported_in_time(serve: Serve) -> None:
    robot, desk = serve(patience=0.3), Desk()
    robot.reader.answers = False
    told = send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64))
    assert (told.http, told.facts["code"]) == (504, "no_answer")
    robot.reader.answers = True
    again = lambda: send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64))
    until(lambda: again().http == 200, "the reader answers again")


def test_a_client_that_leaves_while_the_reader_works_harms_nobody(serve: Serve) -> None:
    robot, desk = serve(), Desk()
    robot.reader.answers = False
    order = desk.order(robot.reader.ticket, "commit", "a" * 64)
    with connected(robot.port) as there:
        there.sendall(head(Content_Length=0, Pursue_Order=order))
        until(lambda: robot.reader.messages, "the reader has it")
    time.sleep(0.1)
    assert robot.server.busy, "the order goes its way"
    robot.reader.answers = True
    robot.reader.hear(json.dumps(robot.reader.messages[0]))
    until(lambda: not robot.server.busy, "and ends")
    assert send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64)).http == 200
    assert "errors" not in robot.record.counts, robot.lines


def test_an_internal_error_is_reported_without_details(serve: Serve) -> None:
    robot = serve(there=lambda: 1 // 0)
    told = ask(robot)
    assert (told.http, told.facts["code"], told.facts["message"]) == (500, "internal", "something went wrong here")
    assert any("ZeroDivisionError" in line for line in robot.lines)


# TLS

def certificate(folder: Path, password: Optional[bytes] = None) -> Tuple[Path, Path]:
    """A self-made one for 127.0.0.1, and its key."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "robot")])
    start = datetime.datetime(2020, 1, 1)
    made = (
        x509.CertificateBuilder().subject_name(name).issuer_name(name).public_key(key.public_key()).serial_number(1)
        .not_valid_before(start).not_valid_after(start + datetime.timedelta(days=36500))
        .add_extension(x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))]), False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), True).sign(key, hashes.SHA256())
    )
    lock: Any = serialization.BestAvailableEncryption(password) if password else serialization.NoEncryption()
    (folder / "cert.pem").write_bytes(made.public_bytes(serialization.Encoding.PEM))
    (folder / "key.pem").write_bytes(
        key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, lock)
    )
    return folder / "cert.pem", folder / "key.pem"


@pytest.mark.filterwarnings("ignore:ssl.TLSVersion:DeprecationWarning")
def test_with_a_certificate_it_speaks_tls_only_and_no_old_one(serve: Serve, tmp_path: Path) -> None:
    cert, key = certificate(tmp_path)
    context = tls(str(cert), str(key))
    robot, desk = serve(context=context), Desk()
    client = ssl.create_default_context(cafile=str(cert))
    told = send(robot, desk.order(robot.reader.ticket, "commit", "a" * 64), tls=client)
    assert told.http == 200
    digest, content = desk.bundle(files={"observer/model.yaml": b"x" * 300_000})
    assert send(robot, desk.order(robot.reader.ticket, mission=digest, body=content), content, client).http == 200
    assert parse(exchange(robot.port, head("/health", "GET"))).http == 0
    assert exchange(serve(context=context, header=0.3).port, b"") == b"", "who says nothing is not waited for"
    old = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    old.check_hostname, old.verify_mode = False, ssl.CERT_NONE
    old.set_ciphers("ALL:@SECLEVEL=0")
    old.minimum_version = old.maximum_version = ssl.TLSVersion.TLSv1_1
    with pytest.raises(ssl.SSLError):
        exchange(robot.port, head("/health", "GET"), tls=old)
    assert send(robot, desk.order(robot.reader.ticket, "abort"), tls=client).http == 200
    assert "errors" not in robot.record.counts, robot.lines


def test_a_certificate_that_cannot_be_used_is_reported_with_what_to_do(tmp_path: Path) -> None:
    assert tls("", "") is None
    cert, key = certificate(tmp_path)
    locked = tmp_path / "locked"
    locked.mkdir()
    for files in ((str(tmp_path / "none.pem"), ""), (str(key), str(key)), (str(cert), ""),
                  tuple(map(str, certificate(locked, b"secret")))):
        with pytest.raises(ServerError, match="PEM files"):
            tls(*files)
    with pytest.raises(ServerError, match="--certificate"):
        tls("", str(key))


# Beginning and end

def test_a_port_that_is_taken_is_reported_with_what_to_do(serve: Serve) -> None:
    robot = serve()
    with pytest.raises(ServerError, match=f"port {robot.port}.*choose another ~port"):
        bind("127.0.0.1", robot.port, "~port")


@pytest.mark.parametrize("host, port", [("192.0.2.1", 0), ("no such host", 0), ("x" * 300, 0), ("127.0.0.1", 70000)])
def test_an_address_that_is_not_ours_is_reported(host: str, port: int) -> None:
    with pytest.raises(ServerError, match="choose another"):
        bind(host, port, "~port")


def test_the_port_is_free_again_at_once(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    with connected(robot.port) as held:
        assert ask(robot).http == 200
        robot.close()
        assert held.recv(10) == b""
    for taken in bind("127.0.0.1", robot.port, "~port"):
        taken.close()


def test_limits_and_words_are_those_of_the_bundles() -> None:
    assert LONGEST_HEADER > mission_bundle.ORDER_LENGTH
    assert Limits().longest < 600
