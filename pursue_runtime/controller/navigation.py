"""When a robot gets its goals, and which ends and failures of its movements are reported.

Times are seconds of ROS time, `real` of the monotonic clock; distances are metres.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Any, Callable, Deque, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.resend import resend_timeout
from pursue_runtime.words import BLOCKED, FAILED, Word, format_word

GOALS, ENDS, ON_STOP = ("simple", "action"), ("words", "result", "pose", "tf"), ("finish", "cancel")

SUCCEEDED, ABORTED = 3, 4
FAILURES = {2: "preempted", ABORTED: "aborted", 5: "rejected", 8: "recalled", 9: "lost"}
"""The statuses with which a goal may end, as actionlib_msgs/GoalStatus numbers them."""


class Settings(NamedTuple):
    """How one robot is connected. Each is a parameter of the node, or of one robot: `~ends`, `~bot1/ends`."""

    goals: str = "simple"
    ends: str = "words"
    on_stop: str = "finish"
    retries: int = 2
    retry_delay: float = 1.0
    end_tolerance: float = 0.3
    end_settle: float = 0.5
    clock_skew: float = 0.5
    map_frame: str = "map"
    base_frame: str = "{robot}/base_link"
    simulated: bool = False

    @property
    def uses_results(self) -> bool:
        """Return True if results of move_base are used."""
        return self.goals == "action" or self.ends == "result"

    @property
    def uses_position(self) -> bool:
        """Return True if the controller finds from the position that the robot has arrived."""
        return self.ends in ("pose", "tf")


def read_settings(robot: str, given: Mapping[str, Any]) -> Settings:
    """The robot's settings among the node's parameters; those in the group of its name win. Raises DataError."""
    own = given.get(robot, {})
    if not isinstance(own, dict) or set(own) - set(Settings._fields):
        raise DataError(f"~{robot} is {own!r}; expected some of {', '.join(Settings._fields)}")
    values = {**given, **own}
    defaults = Settings()._asdict()
    settings = Settings(**{name: _checked(name, values[name], defaults[name]) for name in defaults if name in values})
    for name, known in (("goals", GOALS), ("ends", ENDS), ("on_stop", ON_STOP)):
        if getattr(settings, name) not in known:
            raise DataError(f"~{name} of {robot} is {getattr(settings, name)!r}; expected one of {', '.join(known)}")
    if settings.simulated and (settings.goals, settings.ends) != ("simple", "words"):
        raise DataError(
            f"goals:={settings.goals} and ends:={settings.ends} for {robot}, which is simulated: the simulator takes"
            " simple goals and reports ends as words; leave these out, or set simulate:=false for real robots"
        )
    frames = (settings.map_frame.replace("{robot}", robot), settings.base_frame.replace("{robot}", robot))
    return settings._replace(map_frame=frames[0], base_frame=frames[1])


def _checked(name: str, value: Any, default: Any) -> Any:
    """The value as the type of its default; numbers are not negative. Raises DataError."""
    kind = type(default)
    if isinstance(value, kind) and kind in (bool, str):
        return value
    number = isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value < math.inf
    if number and kind in (int, float) and kind(value) == value:
        return kind(value)
    wanted = {bool: "true or false", str: "a name", int: "a whole number", float: "a number that is not negative"}
    raise DataError(f"~{name} is {value!r}; expected {wanted[kind]}")


class Movement(NamedTuple):
    """A movement: the location of the agent meanwhile, and the POI where it ends (x, y in metres)."""

    location: str
    poi: str
    x: float
    y: float


class Goal(NamedTuple):
    """A goal for a robot, with an id of our own, which only action goals carry."""

    name: str
    movement: Movement


@dataclass
class Progress:
    """The progress of a movement: `goals` is how many were sent for it, `goal` the id of the one in progress."""

    movement: Movement
    goal_at: Optional[float] = None
    goal: str = ""
    goals: int = 0
    near_since: Optional[float] = None
    report: str = ""
    reports: int = 0
    reported: float = 0.0
    confirmed: bool = False


Log = Callable[[str, str], None]
"""Takes a level (info, warn, err) and a sentence."""


class Navigation:
    """Goals for one robot, and what follows from its results and positions."""

    def __init__(self, name: str, settings: Settings, log: Log) -> None:
        self.name = name
        self.settings = settings
        self._log = log
        self._progress: Optional[Progress] = None
        self._running = True
        self._sent = self._earliest = -math.inf  # when its last goal was sent; the earliest stamp that it may have
        self._answered: Deque[str] = deque(maxlen=8)

    @property
    def needs_position(self) -> bool:
        """Return True while positions are needed."""
        trip = self._progress
        return self.settings.uses_position and trip is not None and trip.report != self._end_word(trip)

    @property
    def goal(self) -> str:
        """Return the id of the goal in progress, "" if none."""
        return self._progress.goal if self._progress else ""

    # What happens -----------------------------------------------------------------------------------------------------

    def on_state(self, way: Optional[Movement], running: bool, lost: bool) -> None:
        """Take from a state the movement of the robot (None: none); goals are sent only while it is `running`."""
        self._running = running
        if way is None or self._progress is None or self._progress.movement != way:
            self._progress = Progress(way) if way else None  # also one that was begun by hand: its end counts
        elif lost and self._progress.report not in ("", self._end_word(self._progress)):
            self._progress.confirmed = True

    def start(self, way: Movement, now: float) -> None:
        """Start a movement: its goal is due now."""
        self._progress = Progress(way, goal_at=now)

    def on_result(self, goal: str, stamp: float, status: int, now: float) -> None:
        """Take a result of move_base for a goal that was sent at `stamp` (seconds)."""
        trip = self._progress
        if trip is None or trip.report == self._end_word(trip) or not self._is_current(trip, goal, stamp, status):
            return
        self._answered.append(goal)
        if status == SUCCEEDED:
            trip.goal = ""
            if self.settings.ends == "result":
                self._report(trip, self._end_word(trip))
            elif self.settings.uses_position and trip.near_since is None:
                self._log("warn", f"{self.name}: goal reached, but the position is not at {trip.movement.poi} yet")
        else:
            self._on_failure(trip, FAILURES[status], now)

    def on_position(self, x: float, y: float, now: float) -> None:
        """Take a position on the map (metres)."""
        trip = self._progress
        if trip is None or not self.needs_position:
            return
        if math.hypot(x - trip.movement.x, y - trip.movement.y) > self.settings.end_tolerance:
            trip.near_since = None
        elif trip.near_since is None:
            trip.near_since = now

    # What is to be done -----------------------------------------------------------------------------------------------

    def due(self, now: float, real: float) -> Tuple[Optional[Goal], Optional[str]]:
        """Return the goal to send and the word to publish now, if any."""
        trip = self._progress
        if trip is None:
            return None, None
        if trip.near_since is not None and now >= self._arrival_at(trip.near_since) and self.needs_position:
            self._report(trip, self._end_word(trip))
        goal, word = None, None
        if self._running and trip.goal_at is not None and now >= trip.goal_at:
            goal = self._next_goal(trip, now)
        if trip.report and not trip.confirmed and (trip.reports == 0 or real >= self._resend_at(trip)):
            trip.reports, trip.reported, word = trip.reports + 1, real, trip.report
        return goal, word

    def next_moments(self) -> Tuple[Optional[float], Optional[float]]:
        """Return when to call `due` again, in ROS time and on the real clock; None: not before the next input."""
        trip = self._progress
        if trip is None:
            return None, None
        moments: List[float] = [trip.goal_at] if self._running and trip.goal_at is not None else []
        if trip.near_since is not None and self.needs_position:
            moments.append(self._arrival_at(trip.near_since))
        return min(moments, default=None), (self._resend_at(trip) if trip.reports and not trip.confirmed else None)

    # How --------------------------------------------------------------------------------------------------------------

    def _next_goal(self, trip: Progress, now: float) -> Goal:
        # A simple goal gets its id and stamp from the robot, whose clock may be behind. The goal before may still be
        # answered (it is preempted by this one): what is nearer to that one is not taken for the answer to this.
        self._earliest = now - min(self.settings.clock_skew, (now - self._sent) / 2)
        self._sent = now
        trip.goals += 1
        trip.goal, trip.goal_at = f"{self.name}-{trip.movement.location}-{trip.goals}-{now:.6f}", None
        return Goal(trip.goal, trip.movement)

    def _is_current(self, trip: Progress, goal: str, stamp: float, status: int) -> bool:
        """Return True if the result belongs to the goal in progress."""
        if not trip.goal or (status != SUCCEEDED and status not in FAILURES):
            return False
        if self.settings.goals == "action":
            return goal == trip.goal
        if goal and goal in self._answered:
            return False
        if not stamp or stamp >= self._earliest:  # who gives no stamp (a person, with rostopic) means now
            return True
        self._log("info", f"{self.name}: ignored a result from {self._sent - stamp:.1f} s before the current goal")
        return False

    def _on_failure(self, trip: Progress, how: str, now: float) -> None:
        trip.goal = ""
        if trip.goals <= self.settings.retries:
            self._log("warn", f"{self.name} on its way to {trip.movement.poi}: {how}; trying again")
            trip.goal_at = now + self.settings.retry_delay
        else:
            self._log("err", f"{self.name} on its way to {trip.movement.poi}: {how} {trip.goals} times; giving up")
            self._report(trip, format_word(Word(self.name, BLOCKED if how == FAILURES[ABORTED] else FAILED)))

    @staticmethod
    def _report(trip: Progress, word: str) -> None:
        """Report this word until the state shows it; no further goal is due."""
        trip.report, trip.reports, trip.confirmed, trip.goal_at = word, 0, False, None

    @staticmethod
    def _resend_at(trip: Progress) -> float:
        return trip.reported + resend_timeout(trip.reports)

    def _arrival_at(self, near_since: float) -> float:
        return near_since + self.settings.end_settle

    def _end_word(self, trip: Progress) -> str:
        return f"{self.name}_{trip.movement.location}2{trip.movement.poi}"
