"""What navigation gets to know from a state, and what it gives back: what is to be sent and published."""

from __future__ import annotations

from typing import FrozenSet, NamedTuple, Optional, Tuple

from pursue_runtime.controller.goal import Goal, Movement
from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.event_words import BACK, BLOCKED, DISPLACED, FAILED, HELD, STUCK
from pursue_runtime.locations import is_movement
from pursue_runtime.orders import Order


class View(NamedTuple):
    """What a state says about one robot: its location ("": the mission does not run), and the movement (`way`) or the
    place (`post`) that it stands for; `lost` to `returning` are the lists of the state that name the robot. `seq` is
    the number of the state, `unanswered` has those of the orders to the robot that were not acknowledged."""

    location: str = ""
    way: Optional[Movement] = None
    post: Optional[Place] = None
    running: bool = True
    lost: bool = False
    held: bool = False
    displaced: bool = False
    returning: bool = False
    seq: int = 0
    unanswered: FrozenSet[int] = frozenset()

    def is_there(self, order: Order) -> bool:
        """Return True where the order can be carried out: at its location, or at the end of the way on which something
        was to be done at once."""
        if order.location == self.location:
            return True
        return order.at_once and is_movement(order.location) and order.location.endswith(f"_to_{self.location}")

    def shows(self, word: str) -> bool:
        """Return True where it shows what the robot reports with this word."""
        shown = {FAILED: self.lost, STUCK: self.lost, BLOCKED: self.lost, HELD: self.held}
        shown.update({DISPLACED: self.displaced, BACK: not self.displaced})
        return any(shown[event] for event in shown if word.partition(":")[2].startswith(event))


class Due(NamedTuple):
    """What is to be sent to a robot now, and the words to publish: on pursue/events, and on
    pursue/aboard."""

    goal: Optional[Goal] = None
    actions: Tuple[Order, ...] = ()
    word: Optional[str] = None
    aboard: Optional[str] = None
