"""What people order, on ROS: the topic and the service pursue/orders, and the answers on pursue/answers, on the side of
the observer and on that of the UI."""

from __future__ import annotations

import queue
import threading
from typing import Any, Callable, Dict, Iterable, List

import rospy
from pursue_msgs.msg import OrderAnswer as AnswerMessage
from pursue_msgs.srv import Order as OrderService
from std_msgs.msg import String

from pursue_runtime.event_words import ANSWERS, ORDERS
from pursue_runtime.model import Model
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.observer.ordering import LONGEST, OrderAnswer, called, is_order
from pursue_runtime.sentences import in_words

LOOK = 0.5
"""Seconds of real time after which a caller of the service is told that the node ends."""


class OrderDesk:
    """Passes orders on, and answers who waits for them. `take` gets the text of an order, `now` gives ROS time."""

    def __init__(self, take: Callable[[str], object], now: Callable[[], float], ending: Ending) -> None:
        self._take, self._now = take, now
        self._lock = threading.Lock()
        self._callers: Dict[str, List[queue.Queue[AnswerMessage]]] = {}
        self._answers = rospy.Publisher(ANSWERS, AnswerMessage, queue_size=100, tcp_nodelay=True)
        subscribe(ORDERS, String, self._on_order, ending, queue_size=100)
        rospy.Service(ORDERS, OrderService, self._on_call)

    def answer(self, answers: Iterable[OrderAnswer]) -> None:
        """Publish answers, and give them to those who wait for them: of several with one text to the first."""
        for each in answers:
            by = rospy.Time.from_sec(max(0.0, each.by))
            message = AnswerMessage(each.order, each.accepted, by, each.possible, in_words(each.text(self._now())))
            self._answers.publish(message)
            with self._lock:
                waiting = self._callers.get(each.order)
                if waiting:
                    waiting.pop(0).put(message)

    def _on_order(self, message: String) -> None:
        self._take(message.data)

    def _on_call(self, request: Any) -> AnswerMessage:
        """Wait for the answer, in a thread of the caller's own."""
        answer: queue.Queue[AnswerMessage] = queue.Queue(1)
        with self._lock:
            self._callers.setdefault(called(request.order), []).append(answer)
        self._take(request.order)
        while not rospy.is_shutdown():
            try:
                return answer.get(timeout=LOOK)
            except queue.Empty:
                continue
        raise rospy.ServiceException("the observer ends")


class UIOrders:
    """Publishes what is ordered; `answered` gets each answer: the order, whether it is accepted, and a sentence."""

    def __init__(self, model: Model, ending: Ending, answered: Callable[[str, bool, str], object]) -> None:
        self._menu, self._answered = model.orders, answered
        self._orders = rospy.Publisher(ORDERS, String, queue_size=20, tcp_nodelay=True)
        subscribe(ANSWERS, AnswerMessage, self._on_answer, ending, queue_size=100)

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

    def _on_answer(self, message: AnswerMessage) -> None:
        self._answered(message.order, message.accepted, message.text)
