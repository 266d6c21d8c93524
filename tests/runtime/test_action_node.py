"""The node of docs/robots.md that carries out actions: each order once, in each mission."""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Callable, List

import pytest

from pursue_runtime.orders import Order, order_text

PAGE = Path(__file__).parents[2] / "docs" / "robots.md"


@pytest.fixture
def receive(monkeypatch: pytest.MonkeyPatch) -> Callable[[Order], List[str]]:
    """The node of the page, without ROS: returns what it publishes for an order."""
    published: List[str] = []
    rospy, messages = ModuleType("rospy"), ModuleType("std_msgs.msg")
    callbacks: List[Callable[[object], None]] = []
    for name in ("init_node", "spin"):
        setattr(rospy, name, lambda *_: None)
    rospy.get_namespace = lambda: "/bot1/"  # type: ignore[attr-defined]
    rospy.get_param = lambda _, default: default  # type: ignore[attr-defined]
    rospy.Publisher = lambda *_, **__: SimpleNamespace(publish=published.append)  # type: ignore[attr-defined]
    rospy.Subscriber = lambda _, __, callback: callbacks.append(callback)  # type: ignore[attr-defined]
    messages.String = str  # type: ignore[attr-defined]
    for module in (rospy, messages, ModuleType("std_msgs")):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    found = re.search(r"^    #!/usr/bin/env python3\n(?:    .*\n|\n)+", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None
    exec(compile(textwrap.dedent(found.group()), str(PAGE), "exec"), {})

    def receive(order: Order) -> List[str]:
        published.clear()
        callbacks[0](SimpleNamespace(data=order_text(order)))
        return list(published)

    return receive


def test_an_order_that_comes_again_is_acknowledged_and_done_once(receive: Callable[[Order], List[str]]) -> None:
    order = Order("bot1", "fetch", 7, "doing_fetch_in_shelf", given=100.5)
    assert receive(order) == ["bot1:_order_@7~100.500000", "bot1:fetchDONE"]
    assert receive(order) == ["bot1:_order_@7~100.500000"]


def test_the_order_of_another_mission_is_carried_out_though_its_state_has_the_same_number(
    receive: Callable[[Order], List[str]],
) -> None:
    for start in (100.0, 900.0):
        assert "bot1:fetchDONE" in receive(Order("bot1", "fetch", 7, "doing_fetch_in_shelf", given=start))
