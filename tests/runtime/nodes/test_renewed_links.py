"""Which connections are made anew, which are put aside, and how often the master is asked."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any, Dict, List, Tuple

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.links import REGISTERED, UNREACHABLE, MasterWatch, Peers
from pursue_runtime.nodes import links
from pursue_runtime.nodes.links import Links
from pursue_runtime.nodes.node import ERROR, OK, STALE, WARN, worse


class Topic:
    """rospy's side of a subscription: its connections to publishers, by the addresses of these."""

    def __init__(self, name: str, **publishers: str) -> None:
        self.resolved_name, self.polled = name, []  # type: ignore[var-annotated]
        self.connection_poll = SimpleNamespace(remove_fd=self.polled.append)
        self.connections = [connection(publisher, uri) for publisher, uri in publishers.items()]


def connection(publisher: str, uri: str) -> Any:
    """An open connection, that can be closed."""
    made = SimpleNamespace(callerid_pub=publisher, endpoint_id=uri, socket=object(), done=False, _reconnect=None)
    made.fileno = lambda: 7

    def close() -> None:
        made.done, made.socket = True, None

    made.close = close
    return made


@pytest.fixture
def connected(monkeypatch: pytest.MonkeyPatch) -> List[Tuple[str, str]]:
    """What is connected anew: topics and addresses. Publishers of "dead" addresses refuse calls, "mute" do not answer.
    """
    made: List[Tuple[str, str]] = []

    def call(uri: str, method: str, *_: object) -> int:
        if uri == "dead":
            raise ConnectionRefusedError
        if uri == "mute":
            raise OSError
        return 1

    monkeypatch.setattr(links, "_call", call)
    monkeypatch.setattr(links, "connect", lambda topic, uri: made.append((topic, uri)))
    monkeypatch.setattr(links.rospy, "logwarn", lambda *_: None)
    return made


def watch(monkeypatch: pytest.MonkeyPatch, *topics: Topic) -> Any:
    """A watch of these topics, without its threads."""
    made: Any = Links.__new__(Links)
    made._lock, made._peers, made._busy, made._late, made._renewals = threading.Lock(), Peers(), {"bot"}, [], 0
    monkeypatch.setattr(links, "_subscriptions", lambda: list(topics))
    return made


def test_a_silent_publisher_that_answers_gets_new_connections_and_the_old_ones_only_listen(
    monkeypatch: pytest.MonkeyPatch, connected: List[Tuple[str, str]]
) -> None:
    words, states = Topic("/words", bot="here", other="there"), Topic("/states", bot="here")
    made = watch(monkeypatch, words, states)
    made._renew("bot")
    assert connected == [("/words", "here"), ("/states", "here")]
    old = [topic.connections[0] for topic in (words, states)]
    assert all(each.endpoint_id == "here#old" and not each.done and each._reconnect == each.close for each in old)
    assert [each for _, each in made._late] == old and words.polled == [7] and not made._busy and made._renewals == 1
    assert words.connections[1].endpoint_id == "there"


def test_one_that_is_about_to_connect_is_closed_and_not_kept(
    monkeypatch: pytest.MonkeyPatch, connected: List[Tuple[str, str]]
) -> None:
    topic = Topic("/words", bot="here")
    topic.connections[0].socket = None
    made = watch(monkeypatch, topic)
    made._renew("bot")
    assert topic.connections[0].done and not made._late and connected == [("/words", "here")]


@pytest.mark.parametrize("uri, closed", [("dead", True), ("mute", False)])
def test_who_does_not_answer_gets_no_new_connection_and_a_dead_process_loses_its_own(
    monkeypatch: pytest.MonkeyPatch, connected: List[Tuple[str, str]], uri: str, closed: bool
) -> None:
    topic = Topic("/words", bot=uri)
    made = watch(monkeypatch, topic)
    made._renew("bot")
    assert (topic.connections[0].done, connected, made._late, made._renewals) == (closed, [], [], 0)


def test_a_connection_without_an_answer_is_made_anew_unless_the_answer_has_come(
    monkeypatch: pytest.MonkeyPatch, connected: List[Tuple[str, str]]
) -> None:
    topic = Topic("/words", unknown="here", bot="there")
    made = watch(monkeypatch, topic)
    assert list(links._waiting()) == [(topic, topic.connections[0])]
    for each in topic.connections:
        made._try_again(topic, each)
    assert connected == [("/words", "here")] and [each.done for each in topic.connections] == [True, False]


def test_a_master_that_answers_is_asked_every_five_seconds_and_one_that_does_not_each_second(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    answers, slept = [REGISTERED, UNREACHABLE, REGISTERED], []  # type: ignore[var-annotated]
    found: Dict[str, List[str]] = {"/words": ["bot"]}
    asked: List[object] = []
    made: Any = Links.__new__(Links)
    made._lock, made._lost, made._master = threading.Lock(), None, MasterWatch()
    made._ending = SimpleNamespace(called=False)
    monkeypatch.setattr(links, "ask_master", lambda: (answers.pop(0), found))
    monkeypatch.setattr(links, "connect_missing", asked.append)
    monkeypatch.setattr(links.time, "sleep", slept.append)
    monkeypatch.setattr(links.rospy, "is_shutdown", lambda: not answers)
    for log in ("logerr", "logwarn"):
        monkeypatch.setattr(links.rospy, log, lambda *_: None)
    made._watch_master()
    assert slept == [5.0, 1.0, 5.0] and asked == [found, found]


def test_the_worse_of_two_levels_counts() -> None:
    order = [OK, WARN, STALE, ERROR]
    assert [worse(a, b) for a in order for b in order] == [order[max(i, k)] for i in range(4) for k in range(4)]
