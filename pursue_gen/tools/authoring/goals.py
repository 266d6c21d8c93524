"""The goals that a first scenario can have: what is asked for each, and what is written of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterable, List, Mapping, Optional, Tuple

from pursue_gen.tools.authoring import answers
from pursue_gen.tools.authoring.requirements import BETWEEN, MOST_TIME, Requirements, Robot, travel_time, unused

Places = Tuple[str, ...]
Lines = Callable[[Requirements], List[str]]

Question = Tuple[str, str, str, Callable[[str], int]]
"""The field of the requirements that it is about, the question, the suggestion, and what is accepted (0: nothing)."""


@dataclass(frozen=True)
class Goal:
    """A goal. Somebody who is not controlled, and an event of theirs, may belong to it."""

    meaning: str
    wanted: Lines  # what is wanted
    fewest_places: int = 2  # who is to be avoided or caught is somewhere else at first
    robots: int = 1  # so many are suggested
    tasks: str = "each"  # which robots have a task: "each" its own, "all" the same one, "" none
    allowed: Callable[[Places, int], Places] = lambda places, robot: places  # where the robot of a number can have it
    may_stand: bool = True  # a robot need not move; who catches or makes way has to
    later_stand: bool = False  # from the third on it had better not: many that move make it hard which plan is right
    who: str = ""  # asks for who is not controlled; "": there is nobody
    other: str = ""  # the name that is suggested for them; "": there may be nobody
    apart: bool = False  # the second robot, where there is one, is who would else be asked for
    slow_enough: Callable[[Places, Tuple[int, ...], Tuple[Robot, ...]], int] = lambda *_: 0
    """The smallest `mobile` of theirs with which the robots surely win; 0: that is not asked for."""
    what: str = ""  # asks for their event; "": that is not asked for
    event: str = ""  # the name that is suggested for it; "": there is none
    takes_part: str = ""  # the word behind which they have it
    does: Callable[[Requirements, int], bool] = lambda given, robot: False  # whether the robot of a number can do it
    time: Callable[[Requirements], Optional[Question]] = lambda given: None  # the question for a time
    events: Lines = lambda given: []  # how their event is declared
    steps: Lines = lambda given: [task.event for task in given.tasks]  # the events that wait for their turn, in order
    order: Lines = lambda given: []  # what says when events can happen, beside that


def _of_two(given: Requirements) -> List[str]:
    comment = "// It takes two: one who can do it, and one who reacts to it."
    return [comment, f'event "{given.event}" collaborative'] if given.event else []


def _once(given: Requirements) -> List[str]:
    within = f" within {given.within}" if given.within is not None else ""
    return ["// What is wanted.", f"reach_objective: do {given.event or given.tasks[-1].event}{within}"]


def _by_when(given: Requirements) -> Question:
    least, why = given.shortest_within, "in less time the robots may not be done"
    question = f"By when, in units of time from the start? (0: at any time; at least {least})"
    return "within", question, "0", answers.a_number(least, MOST_TIME, why, or_nothing=True)


def _between_calls(given: Requirements) -> Question:
    question = f"How long does {given.other} wait at least between one {given.event} and the next? (0: unknown)"
    return "waits", question, "0", answers.a_number(0, MOST_TIME)


def _answered(given: Requirements) -> List[str]:
    return [
        "// What has to hold always. Try a shorter time: when it is too short, solve says so, and what would help.",
        f"objective: if {given.event} then {given.tasks[-1].event} within {given.deadline}",
    ]


def _prevented(given: Requirements) -> List[str]:
    state, prevents = unused("safe", given.names), given.tasks[0].event
    return [
        f"// A state is true or false. When {prevents} has made this one true, {given.event} is not possible.",
        f'state "{state}": initially false, true_if {prevents}',
        f"stateDependency: {given.event} only_if {state} is_false",
    ]


def _slow_to_avoid(places: Places, distances: Tuple[int, ...], robots: Tuple[Robot, ...]) -> int:
    (task,) = {robot.task for robot in robots if robot.task is not None}
    at = places.index(task.place)
    travel = travel_time(distances[:at], _fastest(robots))
    return max(1, -(-(travel + task.duration + BETWEEN) // sum(distances[at:])))


def _slow_to_catch(places: Places, distances: Tuple[int, ...], robots: Tuple[Robot, ...]) -> int:
    return _fastest(robots) + -(-BETWEEN // min(distances))  # on each way it gains more than it loses by turning


def _fastest(robots: Iterable[Robot]) -> int:
    return min(robot.mobile or 0 for robot in robots)  # 0: one stands where its task is


def _apart(given: Requirements) -> List[str]:
    return [
        "// What must always hold (never at one place, and never face to face on a way), and what has to be done.",
        f"objective: {given.robots[0].name} never_with {given.other or given.robots[1].name}",
        f"reach_objective: do {given.tasks[-1].event}",
    ]


def _how_often(given: Requirements) -> Question:
    least = given.shortest_every
    question = f"How long may a place be left alone, in units of time? (at least {least})"
    accept = answers.a_number(least, MOST_TIME, "the way to all places and back takes that long")
    return "every", question, str(least), accept


def _patrolled(given: Requirements) -> List[str]:
    who = given.robots[0].name if len(given.robots) == 1 else "any robot"
    return [
        "// What has to hold always: in each place again, at most so many units of time after it was left.",
        f"objective: patrol {', '.join(given.places)} every {given.every} by {who}",
    ]


GOALS: Mapping[str, Goal] = {
    "reach": Goal(
        "the robots do something, one after the other", _once, fewest_places=1, event="handOver",
        who="Does somebody you do not control wait for it, to be handed something? (a name, or nobody)",
        takes_part="reacts_to", does=lambda given, robot: bool(given.event) and robot == len(given.robots) - 1,
        time=_by_when, events=_of_two,
        steps=lambda given: [*(task.event for task in given.tasks), *filter(None, [given.event])],
    ),
    "respond": Goal(
        "whenever somebody calls, the robots answer in time", _answered, fewest_places=1, later_stand=True,
        who="Who calls? (somebody you do not control)", other="visitor", what="What is the call?", event="callRobot",
        takes_part="can_do", time=_between_calls, events=lambda given: [f'event "{given.event}"'],
        steps=lambda given: [given.event, *(task.event for task in given.tasks)],
    ),
    "avoid": Goal(
        "something must never happen, and a robot prevents it",
        lambda given: ["// What must never happen.", f"objective: avoid {given.event}"],
        tasks="all", allowed=lambda places, robot: places[:-1],  # it cannot happen where the other is at first
        later_stand=True, who="Who might do it? (somebody you do not control)", other="burglar",
        slow_enough=_slow_to_avoid, what="What must never happen?", event="breakIn", takes_part="can_do",
        events=lambda given: [f'event "{given.event}" location {given.tasks[0].place}'], order=_prevented,
    ),
    "never-with": Goal(
        "the robots do something, and two of those who are there never meet", _apart, robots=2,
        # in a row of places nobody gets past another one: who must not meet leaves the other's end free
        allowed=lambda places, robot: {0: places[:-1], 1: places[1:]}.get(robot, places), may_stand=False,
        who="Whom must {robot} never meet? (somebody you do not control, who stays where {robot} is not)",
        other="patient", apart=True,
    ),
    "catch": Goal(
        "the robots catch somebody who runs away", _once, tasks="", may_stand=False,
        who="Who runs away? (somebody you do not control)", other="thief", slow_enough=_slow_to_catch,
        what="What is it called when they do?", event="catchThief", takes_part="reacts_to",
        does=lambda given, robot: True, events=_of_two,
    ),
    "patrol": Goal(
        "the robots are at each place again and again", _patrolled, tasks="", may_stand=False, time=_how_often
    ),
}  # fmt: skip
"""The goals, by the words with which they are chosen."""
