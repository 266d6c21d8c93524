"""What a first scenario has to be about, and the numbers with which the robots can do it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, Optional, Tuple

MOST_PLACES, MOST_ROBOTS = 20, 9
MOST_DISTANCE, MOST_MOBILE, MOST_DURATION, MOST_TIME = 100, 20, 500, 1_000_000
"""The largest answers: with them every number of the scenario is one that the language has."""

BETWEEN = 3
"""Time units that pass at most between two steps of a robot, beyond their durations: an end may come 1 later than
the model's shortest time, the next step can begin after 1 more, and a command may take effect a little later."""


@dataclass(frozen=True)
class Task:
    """An event that one robot does: where, and for how many time units (0: it takes no time)."""

    event: str
    place: str
    duration: int


@dataclass(frozen=True)
class Robot:
    """A robot; `mobile`: time units per unit of distance, None: stands where its task is; `task`: None where all
    robots do the same (`catch`, `patrol`)."""

    name: str
    mobile: Optional[int]
    task: Optional[Task] = None


@dataclass(frozen=True)
class Requirements:
    """The answers. The places lie in a row, `distances` (units of distance) are those between neighbours.

    `other`: who is not controlled, "" for nobody; `mobile`: the other's time units per unit of distance, None: stands
    still. `event`: what the other does or takes part in (reach: the hand-over, respond: the call, avoid: what must
    not happen, catch: the catch). In `avoid` all robots have the one task that prevents it. Robots that move start in
    the first place, the other in the last one; never-with: the second robot in the last one, too.
    Times, in time units: `within`: by when all is done (reach); `waits`: how long the other is assumed to wait between
    two calls (respond); None: nothing is demanded or assumed; `every`: how long a place may be left alone (patrol).
    """

    kind: str
    places: Tuple[str, ...]
    distances: Tuple[int, ...]
    robots: Tuple[Robot, ...]
    other: str = ""
    mobile: Optional[int] = None
    event: str = ""
    within: Optional[int] = None
    waits: Optional[int] = None
    every: int = 0

    @property
    def names(self) -> Tuple[str, ...]:
        """Every name that was given."""
        robots = [robot.name for robot in self.robots]
        names = (*self.places, *robots, *(task.event for task in self.tasks), self.other, self.event)
        return tuple(name for name in names if name)

    @property
    def tasks(self) -> Tuple[Task, ...]:
        """The tasks of the robots, each once."""
        return tuple(dict.fromkeys(robot.task for robot in self.robots if robot.task is not None))

    @property
    def shortest_within(self) -> int:
        """Time units in which the robots can surely have done everything (kind reach): each goes all the way when it is
        its turn."""
        turns = [(robot.mobile, robot.task.duration if robot.task else 0) for robot in self.robots]
        turns += [(self.robots[-1].mobile, 0)] if self.event else []
        return sum(travel_time(self.distances, mobile) + duration + BETWEEN for mobile, duration in turns)

    @property
    def shortest_every(self) -> int:
        """Time units after which the fastest robot is surely in the same place again if it walks to and fro."""
        return 2 * travel_time(self.distances, min(robot.mobile or 1 for robot in self.robots))

    @property
    def deadline(self) -> int:
        """Time units in which the robots can answer a call, at any moment: all go to their places first, and stay
        there."""
        slowest = max(robot.mobile or 0 for robot in self.robots)
        at_work = sum((robot.task.duration if robot.task else 0) + BETWEEN for robot in self.robots)
        return travel_time(self.distances, slowest) + at_work


def travel_time(distances: Iterable[int], mobile: Optional[int]) -> int:
    """Time units that the way through all places takes; none where it stands."""
    return sum(distance * mobile + BETWEEN for distance in distances) if mobile else 0


def unused(name: str, taken: Iterable[str]) -> str:
    """The name, or the name with the first number that makes it a new one."""
    known = set(taken)
    return next(new for new in [name, *(f"{name}_{number}" for number in range(2, len(known) + 3))] if new not in known)
