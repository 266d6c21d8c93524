"""What people order at the terminal or on the page, and the answers, on ROS."""

from __future__ import annotations

from typing import Callable

import rospy
from pursue_msgs.msg import OrderAnswer
from std_msgs.msg import String

from pursue_runtime.event_words import ANSWERS, ORDERS
from pursue_runtime.model import Model
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.observer.ordering import CANCEL, JOIN, LEAVE, URGENT


class UIOrders:
    """Publishes what is ordered; `answered` gets each answer: the order, whether it is accepted, and a sentence."""

    def __init__(self, model: Model, ending: Ending, answered: Callable[[str, bool, str], object]) -> None:
        robots = (automaton.name for automaton in model.of_kind("robot"))
        self._menu, self._answered = model.orders, answered
        self._service = {(word, robot) for robot in robots for word in (LEAVE, JOIN)}
        self._orders = rospy.Publisher(ORDERS, String, queue_size=20, tcp_nodelay=True)
        subscribe(ANSWERS, OrderAnswer, self._on_answer, ending, queue_size=100)

    def order(self, text: str) -> bool:
        """Publish an order, such as `tea within 5 min`, `cancel tea` or `leave bot1`; return False for what is none
        of this scenario."""
        words = text.split(maxsplit=2)
        named = words[1:2] if words[:1] in ([CANCEL], [URGENT]) and len(words) > 1 else words[:1]
        if named not in [[word] for word in self._menu] and tuple(words) not in self._service:
            return False
        self._orders.publish(text)
        return True

    def _on_answer(self, message: OrderAnswer) -> None:
        self._answered(message.order, message.accepted, message.text)
