"""A node that cannot begin says why in a line and exits with status 3; anything else is an error of the program."""

from __future__ import annotations

import signal
import sys
import threading
from typing import Any, Iterator, List, Mapping

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy
from rosgraph.xmlrpc import XmlRpcHandler, XmlRpcNode

from pursue_runtime.arguments import CONFIG
from pursue_runtime.data import DataError
from pursue_runtime.nodes.node import init_node, run_node, warn_without_clock
from tests.waiting import PATIENCE, until


@pytest.fixture
def log(monkeypatch: pytest.MonkeyPatch) -> Iterator[List[str]]:
    """What happens, in its order: the node's name as it connects to ROS, then what it logs as fatal."""
    lines: List[str] = []
    handlers = {sign: signal.getsignal(sign) for sign in (signal.SIGINT, signal.SIGTERM)}

    def connect(name: str, disable_signals: bool) -> None:
        assert disable_signals and all(signal.getsignal(sign) == signal.SIG_DFL for sign in handlers)
        lines.append(name)

    monkeypatch.setattr(rospy, "init_node", connect)
    monkeypatch.setattr(sys, "argv", ["observer", "__name:=observer"])
    monkeypatch.setattr(rospy, "logfatal", lambda text, *parts: lines.append(text % parts))
    yield lines
    for sign, handler in handlers.items():
        signal.signal(sign, handler)


def test_its_exit_status_is_what_it_returns(log: List[str]) -> None:
    assert run_node("observer", [], lambda _: len(log)) == 1
    assert log == ["observer"]


@pytest.mark.parametrize("problem", [DataError("model.yaml: no 100%"), KeyError("a parameter")])
def test_what_it_refuses_is_logged_and_its_status_is_3(log: List[str], problem: Exception) -> None:
    def run(_: Mapping[str, str]) -> int:
        raise problem

    assert run_node("observer", [], run, KeyError) == 3
    assert log == ["observer", str(problem)]


def test_it_gets_the_arguments_of_its_process(log: List[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rospy, "get_param", lambda *_: {"config": "/elsewhere"})
    monkeypatch.setattr(rospy, "logwarn", lambda text, *parts: log.append(text % parts))
    monkeypatch.setattr(sys, "argv", ["observer", "--config", "/here", "__name:=observer", "_config:=/elsewhere"])
    told: Any = {}
    assert run_node("observer", [CONFIG], lambda given: told.update(given) or 0) == 0
    assert told == {"config": "/here"}
    assert len(log) == 2 and "ignored parameters: ~config" in log[1]


def test_an_argument_that_is_not_known_is_refused_before_it_connects(
    log: List[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["observer", "--plan", "x"])
    assert run_node("observer", [CONFIG], lambda _: 0) == 3
    assert log == [] and "unrecognized arguments: --plan x" in capsys.readouterr().err


def test_another_exception_is_raised(log: List[str]) -> None:
    def run(_: Mapping[str, str]) -> int:
        raise KeyError("a parameter")

    with pytest.raises(KeyError):
        run_node("observer", [], run)
    assert log == ["observer"]


def test_the_server_of_a_node_ends_when_rospy_closes_its_socket(log: List[str]) -> None:
    init_node("observer")
    node = XmlRpcNode(0, XmlRpcHandler())
    serving = threading.Thread(target=node.run, daemon=True)
    serving.start()
    until(lambda: node.uri, "the server is ready")
    node.shutdown("the mission is over")
    serving.join(PATIENCE)
    assert not serving.is_alive()


@pytest.mark.parametrize(("simulated", "seconds", "warned"), [(True, 0, True), (True, 7, False), (False, 7, False)])
def test_a_node_whose_time_stands_still_says_so(
    monkeypatch: pytest.MonkeyPatch, simulated: bool, seconds: int, warned: bool
) -> None:
    lines: List[str] = []
    monkeypatch.setattr(rospy.rostime, "is_wallclock", lambda: not simulated)
    monkeypatch.setattr(rospy, "get_rostime", lambda: rospy.Time(seconds))
    monkeypatch.setattr(rospy, "is_shutdown", lambda: False)
    monkeypatch.setattr(rospy, "logwarn", lines.append)
    warn_without_clock(wait=0.0)
    assert [line.split(":")[0] for line in lines] == [
        "/use_sim_time is true, but nobody publishes /clock"
    ] * warned  # fmt: skip
