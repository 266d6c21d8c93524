"""States as messages: what is published is read again, and what no observer publishes is refused."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.nodes import state_message
from pursue_runtime.nodes.state_message import message_of, state_of, subscribe_states
from pursue_runtime.state import SystemState

STATE = SystemState(
    7, 100.25, {"bot": "a", "rule": "first"}, {"Pbot": -12}, {"Cbot": 1.5}, "bot_a2b", "bot", "holding",
    "{bot} is late", 0.5, 2, ("bot",), "f843eea7df12", ("bot",), held=("bot",), commanded=True,
    orders=("bot:ring@7~100.250000/a!",),
)  # fmt: skip


def test_a_state_is_read_as_it_was_published() -> None:
    assert state_of(message_of(STATE)) == STATE


@pytest.mark.parametrize("field", ["automata", "variables", "clocks", "late", "orders"])
def test_a_name_that_stands_twice_is_refused(field: str) -> None:
    message = message_of(STATE._replace(late=("bot",)))
    setattr(message, field, 2 * list(getattr(message, field)))
    with pytest.raises(ValueError, match=field):
        state_of(message)


def test_who_subscribes_gets_states_and_publishers_and_counts_what_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    made: List[Any] = []

    def subscribe(topic: str, kind: Any, callback: Any, *_: object, **__: object) -> str:
        made.append(callback)
        return f"subscribed to {topic}"

    monkeypatch.setattr(state_message, "subscribe", subscribe)
    monkeypatch.setattr(state_message.rospy, "logwarn_throttle", lambda *_: None)
    ending: Any = SimpleNamespace()
    received, wrong = [], []  # type: ignore[var-annotated]
    found = subscribe_states(lambda *given: received.append(given), ending, "there", lambda: wrong.append(1))
    assert found == "subscribed to there"
    for state in (STATE, STATE._replace(status="nonsense")):
        message = message_of(state)
        message._connection_header = {"callerid": "/observer"}
        made[0](message)
    assert received == [(STATE, "/observer")] and wrong == [1]
