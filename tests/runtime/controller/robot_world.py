"""A robot of the tests, with a clock: what its Navigation sends and publishes."""

from __future__ import annotations

import math
from typing import Any, List, Optional, Set, Tuple

from pursue_runtime.controller.goal import Answer, Movement
from pursue_runtime.controller.navigation import Navigation
from pursue_runtime.controller.settings import read_settings
from pursue_runtime.controller.view import View
from pursue_runtime.controller.whereabouts import Place, Position
from pursue_runtime.locations import is_action
from pursue_runtime.orders import Order

B, C = Place("b", 3.0, 4.0, 0.0), Place("c", 0.0, 0.0)
WAY = Movement("going_c_to_b", B)
BACK = Movement("going_b_to_c", C)
END, FAILED, STUCK, BLOCKED = "bot1_going_c_to_b2b", "bot1:_failed_", "bot1:_stuck_", "bot1:_blocked_"
CANCELLED = (2, 8)
HELD, DISPLACED, BACK_AGAIN = "bot1:_held_", "bot1:_displaced_", "bot1:_back_"
PENDING, ACTIVE, PREEMPTED, SUCCEEDED, ABORTED, REJECTED, RECALLED, LOST = 0, 1, 2, 3, 4, 5, 8, 9


class World:
    """A robot with a clock: both clocks run alike, `act` does what is due now."""

    def __init__(self, **settings: object) -> None:
        self.now = 100.0
        self.said: List[Tuple[str, str]] = []
        self.robot = Navigation(
            "bot1", read_settings("bot1", settings), lambda level, text: self.said.append((level, text))
        )
        self.seen = View()
        self.goals: List[Any] = []
        self.actions: List[str] = []
        self.acknowledges = True
        """The robot's side acknowledges each order as soon as it has it."""
        self.acknowledged: Set[int] = set()
        self.ordered: List[Order] = []
        self.texts: List[str] = []
        self.to_lifts: List[str] = []

    @property
    def words(self) -> List[str]:
        """What was published, without the numbers of states and the texts that say why."""
        return [text.split(" ")[0].partition("#")[0] for text in self.texts]

    def act(self) -> None:
        goal, actions, word, aboard = self.robot.due(self.now, self.now)
        self.to_lifts += [aboard] if aboard else []
        self.goals += [goal] if goal else []
        self.actions += [order.event for order in actions]
        self.texts += [word] if word else []
        if actions and self.acknowledges:
            self.acknowledged |= {order.seq for order in actions}
            self._see()

    def order(self, event: str, location: str = "b") -> None:
        """It is ordered to do the event, which goes on at a location that is no place."""
        self.ordered.append(Order("bot1", event, len(self.ordered) + 1, location, at_once=not is_action(location)))
        self.view(self.seen)
        self.robot.act(self.ordered[-1])
        self.act()

    def go(self, way: Any = WAY) -> None:
        self.state(way)
        self.robot.start(way, self.now)
        self.act()

    def state(self, way: Any = WAY, running: bool = True, **lists: bool) -> None:
        """A state in which the robot is on this way; None: the mission has ended."""
        self.view(View(way.location if way else "", way, None, running), **lists)

    def stay(self, place: Place = B, doing: str = "", running: bool = True, **lists: bool) -> None:
        """A state in which the robot is at this place, perhaps in an action."""
        location = f"doing_{doing}_in_{place.poi}" if doing else place.poi
        self.view(View(location, None, place, running), **lists)

    def view(self, view: View, **lists: bool) -> None:
        self.seen = view._replace(**lists)
        self._see()
        self.act()

    def _see(self) -> None:
        """It gets the state, which shows what was acknowledged."""
        unanswered = {order.seq for order in self.ordered} - self.acknowledged
        self.robot.on_state(self.seen._replace(unanswered=frozenset(unanswered)), self.now)

    def result(
        self, status: int, goal: Optional[str] = None, stamp: Optional[float] = None, text: str = "", outcome: str = ""
    ) -> None:
        """The answer to the last goal, unless another is named."""
        name = self.goals[-1].name if goal is None else goal
        self.robot.on_result(Answer(name, self.now if stamp is None else stamp, status, text, outcome), self.now)
        self.act()

    def status(self, *answers: Answer) -> None:
        """move_base's status."""
        self.robot.on_status(answers, self.now, self.now)
        self.act()

    def at(self, x: float, y: float, yaw: float = 0.0, height: Optional[float] = None) -> None:
        self.robot.on_position(Position(x, y, yaw, height), self.now)
        self.act()

    def vanish(self) -> None:
        """Its position is not published any more."""
        self.robot.on_position(None, self.now)
        self.act()

    def wait(self, seconds: float) -> List[float]:
        """Time passes; it is woken when it asked to be, and in the end. The moments of its words, from now."""
        begin, end = self.now, self.now + seconds
        told = []
        for _ in range(1000):
            wake = min((moment for moment in self.robot.next_moments() if moment is not None), default=math.inf)
            self.now = min(max(self.now, wake), end)
            before = len(self.words)
            self.act()
            told += [self.now - begin] * (len(self.words) - before)
            if wake > end:
                return told
        raise AssertionError("it never sleeps")
