"""What people order at the terminal or on the page, and the answers, on ROS."""

from __future__ import annotations

from typing import Callable

import rospy
from pursue_msgs.msg import OrderAnswer
from std_msgs.msg import String

from pursue_runtime.event_words import ANSWERS, ORDERS
from pursue_runtime.model import Model
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.observer.ordering import LONGEST, is_order


class UIOrders:
    """Publishes what is ordered; `answered` gets each answer: the order, whether it is accepted, and a sentence."""

    def __init__(self, model: Model, ending: Ending, answered: Callable[[str, bool, str], object]) -> None:
        self._menu, self._answered = model.orders, answered
        self._orders = rospy.Publisher(ORDERS, String, queue_size=20, tcp_nodelay=True)
        subscribe(ANSWERS, OrderAnswer, self._on_answer, ending, queue_size=100)

    def typed(self, text: str) -> bool:
        """Publish an order, such as `tea within 5 min`, `bot1 at room4 within 10 min`, `cancel tea` or `leave bot1`;
        return False for what may be something else."""
        if not is_order(text, self._menu):
            return False
        self.order(text)
        return True

    def order(self, text: str) -> None:
        """Publish what is an order, or is to be one: who takes it says what is wrong with it."""
        self._orders.publish(text[: 2 * LONGEST])

    def _on_answer(self, message: OrderAnswer) -> None:
        self._answered(message.order, message.accepted, message.text)
