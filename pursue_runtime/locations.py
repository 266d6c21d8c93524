"""Names of locations: a POI, a movement (`going_<a>_to_<b>`), an action with a duration (`doing_<event>_in_<poi>`); of
what is being found out, and whose turn it is at a place.

The only place for these two prefixes, and for those of the variable of an agent's position and of its clock; the
generator has them from here.
"""

from __future__ import annotations

from typing import Iterable, NamedTuple, Optional

_MOVEMENT, _ACTION = "going_", "doing_"

_DONE, _STOP, _PART = "DONE", "STOP", "PART"

PASSAGE, AWAITS, HAS = "_passage", "awaits_", "has_"
"""Behind the name of a place the automaton of its order of passage; before a robot, and the number of its visit, a
location of it: it is to come, or is there or on its way there."""

FINDING_OUT = _ACTION + "finding_out"
"""The location of a state that has been shown, until it is known what it is."""

SOMEWHERE = _ACTION + "being_somewhere"
"""The location of an agent of whom it is not known yet where it starts."""

TO_BE_SAID = (FINDING_OUT, SOMEWHERE)
"""The locations that are left with one of several words, which somebody has to say."""


def movement(origin: str, destination: str) -> str:
    """Return the location of an agent that moves from one POI to another."""
    return f"{_MOVEMENT}{origin}_to_{destination}"


def action(event: str, poi: str) -> str:
    """Return the location of an agent in an action with a duration, at a POI."""
    return f"{_ACTION}{event}_in_{poi}"


def is_movement(location: str) -> bool:
    """Return True for the location of an agent that moves."""
    return location.startswith(_MOVEMENT)


def is_action(location: str) -> bool:
    """Return True for the location of an agent in an action with a duration."""
    return location.startswith(_ACTION) and location not in TO_BE_SAID


def is_under_way(location: str) -> bool:
    """Return True for the location of a movement or an action, and for what somebody has to say."""
    return is_movement(location) or is_action(location) or location in TO_BE_SAID


def is_end(source: str, target: str) -> bool:
    """Return True where the edge from source to target ends a movement or an action, or finds something out."""
    return source != target and is_under_way(source)


def breaks_off(source: str, word: str) -> bool:
    """Return True for the word with which an action at this location is broken off: that of its event, and STOP."""
    return _is_of(source, word, _STOP)


def ends_part(source: str, word: str) -> bool:
    """Return True for the word with which a part of an action at this location ends that is not the last one: that of
    its event, and PART."""
    return _is_of(source, word, _PART)


def part_of(word: str) -> str:
    """Return the word of the end of a part for that of the end of an action; "" for other words."""
    return word[: -len(_DONE)] + _PART if word.endswith(_DONE) else ""


def end_of(word: str) -> str:
    """Return the word of the end of an action for that of the end of a part; "" for other words."""
    return word[: -len(_PART)] + _DONE if word.endswith(_PART) else ""


def event_of(word: str) -> str:
    """Return the event of a word: for that of the end of an action the action."""
    return word[: -len(_DONE)] if word.endswith(_DONE) else word


def _is_of(source: str, word: str, end: str) -> bool:
    """Return True for the word of the event that goes on at this location with that end behind it."""
    return word.endswith(end) and is_action(source) and source.startswith(action(word[: -len(end)], ""))


def action_of(location: str) -> str:
    """Return the event of an action's location; other locations as they are."""
    return location[len(_ACTION) :].rsplit("_in_", 1)[0] if is_action(location) else location


def place_of(location: str, places: Iterable[str]) -> str:
    """Return the POI, one of the places, where an agent is, also in an action; of a movement the location as it is.

    A POI may have `_in_` in its name: the longest that fits is meant.
    """
    if not is_action(location):
        return location
    return max((place for place in places if location.endswith(f"_in_{place}")), key=len, default=location)


class Visit(NamedTuple):
    """A visit, with its number in the order of passage; `is_there`: the robot has the place."""

    robot: str
    number: int
    is_there: bool

    @property
    def rank(self) -> int:
        """How many locations of the order come before."""
        return 2 * self.number + self.is_there


def visit_at(location: str) -> Optional[Visit]:
    """Return the visit that a location of an order of passage stands for; None for other locations."""
    for prefix in (AWAITS, HAS):
        robot, _, number = location[len(prefix) :].rpartition("_")
        if location.startswith(prefix) and robot and number.isdigit():
            return Visit(robot, int(number), prefix == HAS)
    return None


def place_passed(automaton: str) -> str:
    """Return the place of an order of passage; "" for the names of other automata."""
    return automaton.rpartition(PASSAGE)[0]


def position_variable(agent: str) -> str:
    """Return the variable that holds where an agent is."""
    return f"P{agent}"


def automaton_clock(name: str) -> str:
    """Return the clock of an agent (how long since its last movement or action began or ended), or of `obj`."""
    return f"C{name}"
