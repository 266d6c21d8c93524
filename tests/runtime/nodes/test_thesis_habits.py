"""What nodes do as the thesis's did, where a parameter asks for it: print states, publish words without decoration."""

from __future__ import annotations

from typing import Any, ClassVar, Dict, List, Tuple

import pytest

from tests.runtime.models import model_data, mover, state, worker
from tests.waiting import until

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.model import Model
from pursue_runtime.nodes.node import Ending
from pursue_runtime.nodes.state_message import PlainWords, StatePrinter
from pursue_runtime.parameters import ParameterError

MODEL = Model(model_data(mover("bot", "robot", 9), worker("nurse", "human")))


def at(seq: int, event: str = "", **more: Any) -> Any:
    return state(MODEL, seq, 100.0 + seq, {"Cbot": 1.25}, event=event, **more)


def printer(monkeypatch: pytest.MonkeyPatch, parameters: Dict[str, object]) -> StatePrinter:
    monkeypatch.setattr(rospy, "get_param", lambda name, default=None: parameters)
    monkeypatch.setattr(rospy, "get_name", lambda: "/controller_bot")
    return StatePrinter(Ending())


def test_a_node_prints_each_state_once_with_its_name(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    printing = printer(monkeypatch, {"print_state": True})
    told: List[str] = []
    for one in (at(3, "bot_a2b", bot="going_a_to_b"), at(3, "bot_a2b", bot="going_a_to_b"), at(4, status="won")):
        printing.on_state(one)

    def printed() -> bool:
        told.extend(capsys.readouterr().out.splitlines())
        return "controller_bot: status is won" in told and told[-1].startswith("controller_bot: C")

    until(printed, "the second state is printed")
    assert all(line.startswith("controller_bot: ") for line in told)
    assert told.count("controller_bot: the system state is:") == 2, "a heartbeat is no new state"
    assert told[:4] == [
        "controller_bot: the system state is:", "controller_bot: seq is 3", "controller_bot: status is running",
        "controller_bot: bot is going_a_to_b",
    ]
    names = {line.split()[1] for line in told if " is " in line}
    assert {"bot", "nurse", "reachObj", "Pbot", "Prule", "Cbot", "Cnurse", "Creach"} <= names
    assert "controller_bot: Cbot is 1.250" in told


def test_nothing_is_printed_unless_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    assert printer(monkeypatch, {}).write is None
    with pytest.raises(ParameterError, match="~print_state is 'perhaps'; expected true or false"):
        printer(monkeypatch, {"print_state": "perhaps"})


class Publisher:
    """Takes the place of rospy's: `published` has what was published by topic and text."""

    published: ClassVar[List[Tuple[str, str]]] = []

    def __init__(self, topic: str, *_: object, **__: object) -> None:
        self._topic = topic

    def publish(self, text: str) -> None:
        self.published.append((self._topic, text))


@pytest.fixture
def published(monkeypatch: pytest.MonkeyPatch) -> List[Tuple[str, str]]:
    monkeypatch.setattr(rospy, "Publisher", Publisher)
    monkeypatch.setattr(rospy, "resolve_name", lambda name: f"/{name}")
    monkeypatch.setattr(Publisher, "published", [])
    return Publisher.published


def test_each_event_is_published_once_and_plainly(published: List[Tuple[str, str]]) -> None:
    plain = PlainWords(at(0, status="waiting"))
    course = [
        at(0, status="waiting"), at(1, "_start_"), at(2, "bot_a2b", agent="bot"), at(2, "bot_a2b", agent="bot"),
        at(2, "bot_a2b", status="holding"), at(3, "bot_going_a_to_b2b"), at(4, "screw", status="won"),
        at(4, "screw", status="won"),
    ]
    for one in course:
        plain.on_state(one)
    words = ["_start_", "bot_a2b", "bot_going_a_to_b2b", "screw", "Finish!"]
    assert published == [("pursue/plain_words", word) for word in words]


def test_an_observer_that_comes_back_repeats_no_event(published: List[Tuple[str, str]]) -> None:
    plain = PlainWords(at(7, "bot_a2b"))
    plain.on_state(at(7, "bot_a2b"))
    plain.on_state(at(8, "bot_going_a_to_b2b"))
    plain.on_state(at(8, status="stopped"))
    assert [word for _, word in published] == ["bot_going_a_to_b2b"], "and a mission that is stopped does not finish"


def test_plain_words_are_never_heard_as_reports(
    monkeypatch: pytest.MonkeyPatch, published: List[Tuple[str, str]]
) -> None:
    monkeypatch.setattr(rospy, "resolve_name", lambda name: "/pursue/events")
    with pytest.raises(ParameterError, match="pursue/plain_words is remapped to pursue/events"):
        PlainWords(at(0))
    assert published == []
