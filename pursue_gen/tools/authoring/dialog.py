"""The questions that lead to a first scenario. Each has a suggestion, and a bad answer is asked for again."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Callable, List, Optional, TextIO, Tuple, TypeVar

from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.tools.authoring import answers
from pursue_gen.tools.authoring.goals import GOALS, Goal
from pursue_gen.tools.authoring.requirements import (
    MOST_DISTANCE,
    MOST_DURATION,
    MOST_MOBILE,
    MOST_PLACES,
    MOST_ROBOTS,
    Requirements,
    Robot,
    Task,
    unused,
)

Answer = TypeVar("Answer")

_PLACES = ("desk", "shelf", "window")
_EVENTS = ("fetch", "sort", "clean", "fill", "count", "paint", "weigh", "label", "pack")
_PATIENCE = 20  # bad answers in a row: then it is no person who answers
LONGEST_LINE = 10_000
"""Letters of what a person types before Enter."""


class Dialog:
    """Writes to one stream and reads from another; with `quiet` it takes every suggestion instead."""

    def __init__(self, source: TextIO, screen: TextIO, quiet: bool = False) -> None:
        self._source, self._screen, self._quiet = source, screen, quiet

    def show(self, text: str) -> None:
        """Shows a line."""
        if not self._quiet:
            self._screen.write(f"{text}\n")

    def ask(self, question: str, suggestion: str, accept: Callable[[str], Answer]) -> Answer:
        """The answer, as `accept` reads it; it raises ValueError for a bad one, which is asked for again.

        Raises PursueError (exit status 2) where there is none to be had.
        """
        if self._quiet:
            return accept(suggestion)
        for _ in range(_PATIENCE):
            self._screen.write(f"{question} [{suggestion or 'nobody'}] ")
            self._screen.flush()
            try:
                return accept(self._line() or suggestion)
            except ValueError as problem:
                self.show(f"  {problem}")
        raise _ended(f"{_PATIENCE} answers in a row could not be used")

    def _line(self) -> str:
        try:
            line = self._source.readline(LONGEST_LINE)
        except UnicodeDecodeError:
            raise _ended("what was typed is not text in UTF-8") from None
        if len(line) == LONGEST_LINE:
            raise _ended("what was typed is no answer: its line does not end")
        if not line:
            self._screen.write("\n")
            raise _ended("the answers ended before the questions did")
        if not self._source.isatty():  # a terminal has shown the answer already
            self.show(line.strip())
        return line.strip()


def _ended(message: str) -> PursueError:
    return usage_error(message, "nothing was written; answer all questions, or take the suggestions with --yes")


def ask_requirements(dialog: Dialog, kind: Optional[str], places: Optional[str], robots: Optional[int]) -> Requirements:
    """The requirements, from what is given and the answers to the rest.

    Raises PursueError as `Dialog.ask`, and for `places` that cannot be (exit status 2).
    """
    if kind is None:
        dialog.show("What is the goal?")
        for number, (word, each) in enumerate(GOALS.items(), 1):
            dialog.show(f"  {number} {word}: {each.meaning}")
        kind = dialog.ask("Number or word?", next(iter(GOALS)), answers.a_choice(list(GOALS)))
    goal = GOALS[kind]
    found = _places(dialog, goal, places)
    distances = tuple(
        dialog.ask(f"How far is it from {a} to {b}, in a unit of your choice?", "4", answers.a_number(1, MOST_DISTANCE))
        for a, b in zip(found, found[1:])
    )
    suggested: List[str] = []
    for number in range(robots or goal.robots):
        suggested.append(unused(f"bot{number + 1}", (*found, *suggested)))
    given = tuple(suggested)
    if robots is None:
        question = "Which robots are there? (names, with commas between them)"
        given = dialog.ask(question, ", ".join(suggested), answers.names(found, 1, MOST_ROBOTS))
    team = _team(dialog, goal, found, given)
    taken = Requirements(kind, found, distances, team).names
    other, event = _other(dialog, goal, taken, team)
    least = goal.slow_enough(found, distances, team)
    mobile = _pace(dialog, least, other) if least else None
    required = Requirements(kind, found, distances, team, other, mobile, event)
    time = goal.time(required)
    if time is None:
        return required
    field, question, suggestion, accept = time
    answer: Any = {field: dialog.ask(question, suggestion, accept) or None}
    return replace(required, **answer)


def _places(dialog: Dialog, goal: Goal, given: Optional[str]) -> Tuple[str, ...]:
    accept = answers.names((), goal.fewest_places, MOST_PLACES)
    if given is None:
        question = "What places are there? (names in a row, neighbours side by side, with commas between them)"
        return dialog.ask(question, ", ".join(_PLACES), accept)
    try:
        return accept(given)
    except ValueError as problem:
        hint = f"for example --places {','.join(_PLACES)}"
        raise usage_error(f"--places {given}: {problem}", hint) from None


def _team(dialog: Dialog, goal: Goal, places: Tuple[str, ...], names: Tuple[str, ...]) -> Tuple[Robot, ...]:
    """The robots with what each has to do, and how fast it is."""
    team: List[Robot] = []
    taken = (*places, *names)
    for number, name in enumerate(names):
        task: Optional[Task] = None
        allowed = goal.allowed(places, number)
        if goal.tasks == "all":
            task = team[0].task if team else _task(dialog, "What prevents it?", "lock", allowed, 0, taken)
        elif goal.tasks:
            task = _task(dialog, f"What does {name} do?", _EVENTS[number], allowed, number + 1, taken)
            taken += (task.event,)
        team.append(Robot(name, _speed(dialog, goal, number, name), task))
    return tuple(team)


def _task(
    dialog: Dialog, question: str, event: str, places: Tuple[str, ...], place: int, taken: Tuple[str, ...]
) -> Task:
    """What is done, where and for how long; `place`: the number of the suggested place, or the last one."""
    event = dialog.ask(question, unused(event, taken), answers.a_name(taken))
    where = dialog.ask(f"Where is {event} done?", places[min(place, len(places) - 1)], answers.one_of(places))
    question = f"How many units of time does {event} take? (0: none)"
    return Task(event, where, dialog.ask(question, "3", answers.a_number(0, MOST_DURATION)))


def _speed(dialog: Dialog, goal: Goal, number: int, name: str) -> Optional[int]:
    """Units of time per unit of distance; None for a robot that stands."""
    stands = goal.may_stand
    suggestion = "0" if number > 1 and goal.later_stand else "1"
    question = f"How many units of time does {name} need for one unit of distance?"
    question += " (0: it stays where it works)" if stands else ""
    return dialog.ask(question, suggestion, answers.a_number(0 if stands else 1, MOST_MOBILE)) or None


def _other(dialog: Dialog, goal: Goal, taken: Tuple[str, ...], team: Tuple[Robot, ...]) -> Tuple[str, str]:
    """Who is not controlled, and the event of theirs; "" where there is none."""
    if goal.apart and len(team) > 1:
        dialog.show(f"{team[0].name} and {team[1].name} will never meet.")
        return "", ""
    if not goal.who:
        return "", ""
    accept = answers.a_name if goal.other else answers.a_name_or_nobody
    suggestion = unused(goal.other, taken) if goal.other else ""
    other = dialog.ask(goal.who.format(robot=team[0].name), suggestion, accept(taken))
    taken = (*taken, other)
    event = unused(goal.event, taken) if other and goal.event else ""
    return other, dialog.ask(goal.what, event, answers.a_name(taken)) if goal.what else event


def _pace(dialog: Dialog, least: int, other: str) -> int:
    why = f"were {other} faster, the robots could not be sure to be in time"
    question = f"How many units of time does {other} need for one unit of distance? (at least {least})"
    return dialog.ask(question, str(max(least, 2)), answers.a_number(least, max(100, 10 * least), why))
