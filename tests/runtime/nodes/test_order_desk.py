"""What people order goes from topic and service to the mission, and each caller gets the answer to the own order."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any, Dict, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.model import Model
from pursue_runtime.nodes import order_desk
from pursue_runtime.nodes.order_desk import OrderDesk, UIOrders
from pursue_runtime.observer.ordering import OrderAnswer
from tests.runtime.models import desk, model_data, mover
from tests.waiting import PATIENCE, until


@pytest.fixture
def graph(monkeypatch: pytest.MonkeyPatch) -> Dict[str, Any]:
    """What nodes make of rospy: the callbacks of topics and services, and what is published."""
    made: Dict[str, Any] = {"published": []}
    publisher = SimpleNamespace(publish=made["published"].append)
    subscribe = lambda topic, _, callback, *__, **___: made.__setitem__(topic, callback)
    monkeypatch.setattr(order_desk.rospy, "Publisher", lambda *_, **__: publisher)
    monkeypatch.setattr(order_desk, "subscribe", subscribe)
    monkeypatch.setattr(order_desk.rospy, "Service", lambda name, _, call: made.__setitem__(f"service {name}", call))
    monkeypatch.setattr(order_desk.rospy, "is_shutdown", lambda: False)
    return made


def test_a_caller_waits_for_the_answer_to_the_own_order(graph: Dict[str, Any]) -> None:
    taken: List[str] = []
    there = OrderDesk(taken.append, lambda: 100.0, None)  # type: ignore[arg-type]
    call, got = graph["service pursue/orders"], []
    texts = ("tea", "coffee  within 5 min", "tea")
    ask = lambda text: got.append(call(SimpleNamespace(order=text)))
    callers = [threading.Thread(target=ask, args=(text,), daemon=True) for text in texts]
    for number, caller in enumerate(callers):
        caller.start()
        until(lambda known=number: len(taken) > known, "the order is taken")
    there.answer([OrderAnswer("coffee within 5 min", False, possible=7.0, why="no")])
    callers[1].join(PATIENCE)
    there.answer([OrderAnswer("tea", True, 130.0), OrderAnswer("tea", False, why="it waits")])
    for caller in callers:
        caller.join(PATIENCE)
    assert [each.text for each in graph["published"]] == [
        "refused: no; it could be promised within 7 time units", "accepted: answered in 30 s at the latest",
        "refused: it waits",
    ]  # fmt: skip
    assert sorted(each.text for each in got) == sorted(each.text for each in graph["published"])
    assert graph["published"][1].by.to_sec() == 130.0


def test_what_comes_on_the_topic_is_taken(graph: Dict[str, Any]) -> None:
    taken: List[str] = []
    OrderDesk(taken.append, lambda: 100.0, None)  # type: ignore[arg-type]
    graph["pursue/orders"](SimpleNamespace(data="tea within 3"))
    assert taken == ["tea within 3"]


def test_the_ui_publishes_orders_of_its_scenario_alone_and_gets_the_answers(graph: Dict[str, Any]) -> None:
    answers: List[Any] = []
    model = Model(model_data(mover("bot", "robot", 9), desk("tea")))
    orders = UIOrders(model, None, lambda *answer: answers.append(answer))  # type: ignore[arg-type]
    assert orders.typed("tea within 3") and not any(map(orders.typed, ("coffee", "", "teapot")))
    assert orders.typed("cancel tea") and orders.typed("urgent tea within 3") and not orders.typed("cancel")
    assert graph["published"] == ["tea within 3", "cancel tea", "urgent tea within 3"]
    assert not any(map(orders.typed, ("cancel coffee", "urgent", "bot at a", "tea" * 99)))
    assert orders.typed("bot at a within 3 min") and orders.typed("cancel bot at a")
    orders.order("x" * 999)  # of a page: who takes it says what is wrong with it
    assert graph["published"][3:] == ["bot at a within 3 min", "cancel bot at a", "x" * 400]
    graph["pursue/answers"](SimpleNamespace(order="tea", accepted=True, text="accepted"))
    assert answers == [("tea", True, "accepted")]


def test_without_orders_robots_leave_and_join_all_the_same(graph: Dict[str, Any]) -> None:
    orders = UIOrders(Model(model_data(mover("bot", "robot", 9))), None, lambda *_: None)  # type: ignore[arg-type]
    assert not any(map(orders.typed, ("tea", "leave", "join bot at hall")))
    assert orders.typed("leave bot") and orders.typed("join  bot")
    assert graph["published"] == ["leave bot", "join  bot"]


def test_where_the_scenario_has_no_orders_some_can_be_written(graph: Dict[str, Any]) -> None:
    orders = UIOrders(Model(model_data(mover("bot", "robot", 9))), None, lambda *_: None)  # type: ignore[arg-type]
    assert not orders.typed("tea") and orders.typed("bot at a within 3")
