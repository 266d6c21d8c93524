"""The questions that lead to a first scenario. Each has a suggestion, and a bad answer is asked for again."""

from __future__ import annotations

import abc
from dataclasses import replace
from typing import Callable, List, Optional, Tuple, TypeVar

from pursue_gen.diagnostics import usage_error
from pursue_gen.tools.authoring import answers
from pursue_gen.tools.authoring.requirements import (
    AVOID,
    CATCH,
    KINDS,
    MOST_DISTANCE,
    MOST_DURATION,
    MOST_MOBILE,
    MOST_PLACES,
    MOST_ROBOTS,
    MOST_TIME,
    NEVER_WITH,
    PATROL,
    REACH,
    RESPOND,
    Requirements,
    Robot,
    Task,
    allowed_places,
    fewest_places,
    may_stand,
    shortest_every,
    shortest_within,
    slow_enough,
    unused,
)

Answer = TypeVar("Answer")

_PLACES = ("desk", "shelf", "window")
_EVENTS = ("fetch", "sort", "clean", "fill", "count", "paint", "weigh", "label", "pack")
_OTHER = {RESPOND: "visitor", AVOID: "burglar", NEVER_WITH: "patient", CATCH: "thief"}
_THEIR_EVENT = {RESPOND: "callRobot", AVOID: "breakIn", CATCH: "catchThief"}
_WHO = {
    RESPOND: "Who calls? (somebody you do not control)",
    AVOID: "Who might do it? (somebody you do not control)",
    NEVER_WITH: "Whom must {robot} never meet? (somebody you do not control, who stays where {robot} is not)",
    CATCH: "Who runs away? (somebody you do not control)",
}
_WHAT = {RESPOND: "What is the call?", AVOID: "What must never happen?", CATCH: "What is it called when they do?"}


class Dialog(abc.ABC):
    """Asks a person, on a terminal or elsewhere."""

    @abc.abstractmethod
    def show(self, text: str) -> None:
        """Shows a line."""

    @abc.abstractmethod
    def ask(self, question: str, suggestion: str, accept: Callable[[str], Answer]) -> Answer:
        """The answer, as `accept` reads it; it raises ValueError for a bad one, which is asked for again.

        Raises PursueError (exit status 2) where there is none to be had.
        """


def ask_requirements(dialog: Dialog, kind: Optional[str], places: Optional[str], robots: Optional[int]) -> Requirements:
    """The requirements, from what is given and the answers to the rest.

    Raises PursueError as `Dialog.ask`, and for `places` that cannot be (exit status 2).
    """
    if kind is None:
        dialog.show("What is the goal?")
        for number, (word, meaning) in enumerate(KINDS.items(), 1):
            dialog.show(f"  {number} {word}: {meaning}")
        kind = dialog.ask("Number or word?", REACH, answers.a_choice(KINDS))
    found = _places(dialog, kind, places)
    distances = tuple(
        dialog.ask(f"How far is it from {a} to {b}, in a unit of your choice?", "4", answers.a_number(1, MOST_DISTANCE))
        for a, b in zip(found, found[1:])
    )
    many = 2 if kind == NEVER_WITH else 1
    suggested: List[str] = []
    for number in range(robots or many):
        suggested.append(unused(f"bot{number + 1}", (*found, *suggested)))
    given = tuple(suggested)
    if robots is None:
        question = "Which robots are there? (names, with commas between them)"
        given = dialog.ask(question, ", ".join(suggested), answers.names(found, 1, MOST_ROBOTS))
    team = _team(dialog, kind, found, given)
    taken = Requirements(kind, found, distances, team).names
    other, event = _other(dialog, kind, taken, team)
    mobile = _pace(dialog, kind, found, distances, team, other) if kind in (AVOID, CATCH) else None
    return _times(dialog, Requirements(kind, found, distances, team, other, mobile, event))


def _places(dialog: Dialog, kind: str, given: Optional[str]) -> Tuple[str, ...]:
    accept = answers.names((), fewest_places(kind), MOST_PLACES)
    if given is None:
        question = "What places are there? (names in a row, neighbours side by side, with commas between them)"
        return dialog.ask(question, ", ".join(_PLACES), accept)
    try:
        return accept(given)
    except ValueError as problem:
        hint = f"for example --places {','.join(_PLACES)}"
        raise usage_error(f"--places {given}: {problem}", hint) from None


def _team(dialog: Dialog, kind: str, places: Tuple[str, ...], names: Tuple[str, ...]) -> Tuple[Robot, ...]:
    """The robots with what each has to do, and how fast it is."""
    team: List[Robot] = []
    taken = (*places, *names)
    for number, name in enumerate(names):
        task: Optional[Task] = None
        if kind == AVOID:
            task = team[0].task if team else _task(dialog, "What prevents it?", "lock", places[:-1], 0, taken)
        elif kind not in (CATCH, PATROL):
            allowed = allowed_places(kind, places, number)
            task = _task(dialog, f"What does {name} do?", _EVENTS[number], allowed, number + 1, taken)
            taken += (task.event,)
        team.append(Robot(name, _speed(dialog, kind, number, name), task))
    return tuple(team)


def _task(
    dialog: Dialog, question: str, event: str, places: Tuple[str, ...], place: int, taken: Tuple[str, ...]
) -> Task:
    """What is done, where and for how long; `place`: the number of the suggested place, or the last one."""
    event = dialog.ask(question, unused(event, taken), answers.a_name(taken))
    where = dialog.ask(f"Where is {event} done?", places[min(place, len(places) - 1)], answers.one_of(places))
    question = f"How many units of time does {event} take? (0: none)"
    return Task(event, where, dialog.ask(question, "3", answers.a_number(0, MOST_DURATION)))


def _speed(dialog: Dialog, kind: str, number: int, name: str) -> Optional[int]:
    """Units of time per unit of distance; None for a robot that stands.

    Many robots that move make the question hard which plan is always right, so from the third on they stand.
    """
    stands = may_stand(kind)
    suggestion = "0" if number > 1 and kind in (RESPOND, AVOID) else "1"
    question = f"How many units of time does {name} need for one unit of distance?"
    question += " (0: it stays where it works)" if stands else ""
    return dialog.ask(question, suggestion, answers.a_number(0 if stands else 1, MOST_MOBILE)) or None


def _other(dialog: Dialog, kind: str, taken: Tuple[str, ...], team: Tuple[Robot, ...]) -> Tuple[str, str]:
    """Who is not controlled, and the event of theirs; "" where there is none."""
    if kind == REACH:
        question = "Does somebody you do not control wait for it, to be handed something? (a name, or nobody)"
        other = dialog.ask(question, "", answers.a_name_or_nobody(taken))
        return other, unused("handOver", (*taken, other)) if other else ""
    if kind == PATROL:
        return "", ""
    if kind == NEVER_WITH and len(team) > 1:
        dialog.show(f"{team[0].name} and {team[1].name} will never meet.")
        return "", ""
    question = _WHO[kind].format(robot=team[0].name)
    other = dialog.ask(question, unused(_OTHER[kind], taken), answers.a_name(taken))
    if kind == NEVER_WITH:
        return other, ""
    taken = (*taken, other)
    return other, dialog.ask(_WHAT[kind], unused(_THEIR_EVENT[kind], taken), answers.a_name(taken))


def _times(dialog: Dialog, given: Requirements) -> Requirements:
    """The requirements with a deadline, with what is assumed of the other, or with the time between two visits."""
    if given.kind == REACH:
        least, why = shortest_within(given), "in less time the robots may not be done"
        question = f"By when, in units of time from the start? (0: at any time; at least {least})"
        within = dialog.ask(question, "0", answers.nothing_or_a_number(least, MOST_TIME, why))
        return replace(given, within=within or None)
    if given.kind == RESPOND:
        question = f"How long does {given.other} wait at least between one {given.event} and the next? (0: unknown)"
        return replace(given, waits=dialog.ask(question, "0", answers.a_number(0, MOST_TIME)) or None)
    if given.kind == PATROL:
        least = shortest_every(given.distances, given.robots)
        why = "the way to all places and back takes that long"
        question = f"How long may a place be left alone, in units of time? (at least {least})"
        return replace(given, every=dialog.ask(question, str(least), answers.a_number(least, MOST_TIME, why)))
    return given


def _pace(
    dialog: Dialog, kind: str, places: Tuple[str, ...], distances: Tuple[int, ...], team: Tuple[Robot, ...], other: str
) -> int:
    least = slow_enough(kind, places, distances, team)
    why = f"were {other} faster, the robots could not be sure to be in time"
    question = f"How many units of time does {other} need for one unit of distance? (at least {least})"
    return dialog.ask(question, str(max(least, 2)), answers.a_number(least, max(100, 10 * least), why))
