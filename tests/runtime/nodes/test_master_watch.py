"""What answers at the master's address is recognized, and a node that ends says nothing of the master."""

from __future__ import annotations

import contextlib
import socket
import threading
from typing import Callable, Dict, Iterator, List, Tuple

import pytest

from tests.waiting import PATIENCE

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.links import FOREIGN, NOT_REGISTERED, REFUSED, UNREACHABLE, MasterWatch
from pursue_runtime.nodes import links
from pursue_runtime.nodes.links import Links


def reply(head: str, body: str) -> bytes:
    return f"{head}\r\nContent-Type: text/xml\r\nContent-Length: {len(body)}\r\n\r\n{body}".encode()


def xml(value: str) -> bytes:
    parameters = f"<params><param><value>{value}</value></param></params>"
    return reply("HTTP/1.1 200 OK", f"<?xml version='1.0'?><methodResponse>{parameters}</methodResponse>")


def array(*values: str) -> str:
    return f"<array><data>{''.join(f'<value>{value}</value>' for value in values)}</data></array>"


NOBODY_REGISTERED = array("<int>1</int>", "<string/>", array(array(), array(), array()))
ANSWERS = {
    "another master": (xml(NOBODY_REGISTERED), NOT_REGISTERED),
    "a server that takes no POST": (reply("HTTP/1.0 501 Unsupported method", "no"), FOREIGN),
    "a server of pages": (reply("HTTP/1.1 200 OK", "<html><p>Hello</html>"), FOREIGN),
    "a server of other calls": (xml("<int>7</int>"), FOREIGN),
    "a server of other lists": (xml(array("<int>1</int>", "<string/>", "<int>7</int>")), FOREIGN),
    "a node": (xml(array("<int>-1</int>", "<string>no</string>", "<int>0</int>")), FOREIGN),
    "another protocol": (b"SSH-2.0-server\r\n", FOREIGN),
    "a program that hangs up": (b"", FOREIGN),
}


@contextlib.contextmanager
def answering(answer: bytes) -> Iterator[str]:
    """The address of a server that answers every request so, and closes."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            with contextlib.suppress(OSError):  # it is closed
                while True:
                    connection, _ = server.accept()
                    with connection, contextlib.suppress(OSError):
                        connection.recv(65536)
                        connection.sendall(answer)

        threading.Thread(target=serve, daemon=True).start()
        yield f"http://127.0.0.1:{server.getsockname()[1]}"
        server.shutdown(socket.SHUT_RDWR)


@pytest.mark.parametrize("who", sorted(ANSWERS))
def test_whoever_answers_in_the_master_s_place_is_recognized(who: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(links, "CALL", PATIENCE)
    answer, found = ANSWERS[who]
    with answering(answer) as address:
        monkeypatch.setenv("ROS_MASTER_URI", address)
        assert links.ask_master() == (found, {})


def test_an_address_where_nobody_listens_is_a_master_that_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket() as held:  # bound, but it does not listen
        held.bind(("127.0.0.1", 0))
        monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{held.getsockname()[1]}")
        assert links.ask_master() == (REFUSED, {})


def test_a_master_that_does_not_answer_in_time_is_out_of_reach(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(links, "CALL", 0.05)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{silent.getsockname()[1]}")
        assert links.ask_master() == (UNREACHABLE, {})


class Watched(Links):
    """A watch that is called by hand, with what the calls find; its node is to end with the call number `ends`."""

    def __init__(self, ends: int, lost: Callable[[str], None]) -> None:
        self._lock, self._lost, self._master, self._ending = threading.Lock(), lost, MasterWatch(), self
        self.calls, self.ends = 0, ends

    @property
    def called(self) -> bool:
        return self.calls >= self.ends

    def ask_master(self) -> Tuple[str, Dict[str, List[str]]]:
        """What `links.ask_master` is replaced with."""
        self.calls += 1
        return NOT_REGISTERED, {}


@pytest.mark.parametrize("ends, lines", [(1, 0), (3, 1)])
def test_a_node_that_ends_and_is_unregistered_does_not_say_that_there_is_another_master(
    monkeypatch: pytest.MonkeyPatch, ends: int, lines: int
) -> None:
    """rospy unregisters a node that ends before `is_shutdown` is true."""
    said: List[str] = []
    monkeypatch.setattr(links.rospy, "is_shutdown", lambda: False)
    monkeypatch.setattr(links.rospy, "logerr", lambda text, *words: said.append(text % words))
    monkeypatch.setattr(links, "PERIOD", 0.0)
    watched = Watched(ends, said.append)
    monkeypatch.setattr(links, "ask_master", watched.ask_master)
    watched._watch_master()
    assert len(said) == lines
