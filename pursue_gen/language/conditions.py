"""Conditions: what may hold at a moment of a mission, as `only_if` and objectives name it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Iterator, Optional, Tuple, Union

from pursue_gen.language.refs import Ref
from pursue_gen.language.word import Word

WORDS = (
    Word("only_if", "What has to hold when the event begins, or when an agent sets off on the way.", may_break=True),
    Word("is_true", "The state is true."),
    Word("is_false", "The state is false."),
    Word("at", "The place; in a condition: the agent stands there, idle or at work.", True),
    Word("not", "What follows does not hold."),
    Word("on_way", "The agent is between two places.", True),
    Word("doing", "The agent is busy with this event.", True),
    Word("any", "At least one of them: any robot, any agent.", True),
    Word("no", "None of them: no robot, no agent.", True),
    Word("robot", "The agents that are controllable and not human.", True),
)
"""The words of conditions, and before them, which several kinds of statements have."""


@dataclass(frozen=True)
class Who:
    """The agent that is named; None: any agent, or with `robots` any robot."""

    agent: Optional[Ref]
    robots: bool = False


@dataclass(frozen=True)
class At:
    """`who at place`: it stands there, idle or at work."""

    who: Who
    place: Ref


@dataclass(frozen=True)
class OnWay:
    """`who on_way`: it is between two places."""

    who: Who


@dataclass(frozen=True)
class Doing:
    """`who doing event`: it does an event that takes time, or takes part in one until it ends."""

    who: Who
    event: Ref


@dataclass(frozen=True)
class Holds:
    """`state is_true`, or `is_false`."""

    state: Ref
    value: bool


@dataclass(frozen=True)
class Not:
    """`not part`; `no robot …` is `not any robot …`."""

    part: Condition


@dataclass(frozen=True)
class AllOf:
    """`first and second and …`."""

    parts: Tuple[Condition, ...]


@dataclass(frozen=True)
class AnyOf:
    """`first or second or …`."""

    parts: Tuple[Condition, ...]


Atom = Union[At, OnWay, Doing, Holds]
Condition = Union[At, OnWay, Doing, Holds, Not, AllOf, AnyOf]
EventOrCondition = Union[Ref, Condition]


def atoms(condition: Condition) -> Iterator[Atom]:
    """The parts of a condition that have no parts, from left to right."""
    if isinstance(condition, Not):
        yield from atoms(condition.part)
    elif isinstance(condition, (AllOf, AnyOf)):
        for part in condition.parts:
            yield from atoms(part)
    else:
        yield condition


def names_in(condition: Condition) -> Iterator[Tuple[str, Ref]]:
    """Each name in a condition behind the kind of thing that it stands for, from left to right."""
    for atom in atoms(condition):
        if isinstance(atom, Holds):
            yield "state", atom.state
            continue
        if atom.who.agent is not None:
            yield "agent", atom.who.agent
        if isinstance(atom, At):
            yield "POI", atom.place
        elif isinstance(atom, Doing):
            yield "event", atom.event


def held_by(condition: Condition, robot: Ref) -> Condition:
    """A condition that holds only while the first one does: where any robot would do, it is this one."""
    if isinstance(condition, (AllOf, AnyOf)):
        return replace(condition, parts=tuple(held_by(part, robot) for part in condition.parts))
    if isinstance(condition, (At, OnWay, Doing)):
        return replace(condition, who=by_robot(condition.who, robot))
    return condition


def by_robot(who: Who, robot: Ref) -> Who:
    """This robot where any robot would do; else the same."""
    return Who(robot) if who.agent is None and who.robots else who


def condition_text(condition: Condition) -> str:
    """A condition as it is written in a scenario."""
    if isinstance(condition, Not):
        part = condition.part
        if not isinstance(part, (Not, AllOf, AnyOf, Holds)) and part.who.agent is None:
            return "no" + condition_text(part)[len("any") :]
        return f"not {_bracketed(part, condition_text)}"
    if isinstance(condition, (AllOf, AnyOf)):
        return _joined(condition, condition_text)
    if isinstance(condition, Holds):
        return f"{condition.state.name} is_{'true' if condition.value else 'false'}"
    who = who_text(condition.who)
    if isinstance(condition, At):
        return f"{who} at {condition.place.name}"
    return f"{who} on_way" if isinstance(condition, OnWay) else f"{who} doing {condition.event.name}"


def condition_words(condition: Condition, holds: bool = True) -> str:
    """A condition in English, as in "bot1 is at a and open is true"; with `holds` False its negation."""
    if isinstance(condition, Not):
        return condition_words(condition.part, not holds)
    if isinstance(condition, (AllOf, AnyOf)):
        return _joined(condition, condition_words) if holds else f"not ({_joined(condition, condition_words)})"
    if isinstance(condition, Holds):
        return f"{condition.state.name} is {'true' if condition.value is holds else 'false'}"
    who, verb = who_text(condition.who, shown=True), "is" if holds else "is not"
    if condition.who.agent is None and not holds:
        who, verb = "no" + who[len("any") :], "is"
    if isinstance(condition, At):
        return f"{who} {verb} at {condition.place.shown}"
    return f"{who} {verb} {'on its way' if isinstance(condition, OnWay) else f'doing {condition.event.shown}'}"


def _joined(condition: Union[AllOf, AnyOf], say: Callable[[Condition], str]) -> str:
    sign = " and " if isinstance(condition, AllOf) else " or "
    return sign.join(_bracketed(part, say) for part in condition.parts)


def _bracketed(part: Condition, say: Callable[[Condition], str]) -> str:
    return f"({say(part)})" if isinstance(part, (AllOf, AnyOf)) else say(part)


def who_text(who: Who, shown: bool = False) -> str:
    """Of whom a condition speaks; with `shown` what people read for an agent."""
    if who.agent is None:
        return f"any {'robot' if who.robots else 'agent'}"
    return who.agent.shown if shown else who.agent.name
