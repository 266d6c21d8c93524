"""Why a robot's navigation gives up a goal: its texts, and what each means for the mission.

The texts are those of move_base 1.17 (`move_base.cpp`), of move_base_flex (`mbf_abstract_nav`), whose relay passes them
on, and move_base_flex's names of its outcome codes (`mbf_utility::outcome2str`), which its results have as numbers.
"""

from __future__ import annotations

from typing import NamedTuple

from pursue_runtime.controller.goal import ABORTED, FAILURES, Answer
from pursue_runtime.event_words import BLOCKED, FAILED, STUCK
from pursue_runtime.sentences import quoted


class Meaning(NamedTuple):
    """`says` is a clause for people. `event` is reported when the goal is sent no more: the way is closed to this robot
    (BLOCKED), the robot alone cannot go on and says nothing of its way (STUCK), or it can be sent nowhere (FAILED).
    `again`: the same goal may succeed when it is sent once more."""

    says: str
    event: str
    again: bool = True


NO_WAY = Meaning("it finds no way", BLOCKED)
INVALID = Meaning("its navigation refuses the pose of its goal", BLOCKED, again=False)
NO_MOTION = Meaning("it finds no free motion", STUCK)
TO_AND_FRO = Meaning("it moves to and fro", STUCK)
STANDS = Meaning("it does not move when it should", STUCK)
OFF_ITS_WAY = Meaning("it has lost its way", STUCK)
OCCUPIED = Meaning("its spot there is occupied", STUCK)
HEMMED_IN = Meaning("it stands too near to an obstacle", STUCK)
NO_POSITION = Meaning("it does not know where it is", FAILED)
BROKEN = Meaning("its navigation does not work", FAILED)

_MEANINGS = (
    # move_base
    ("Failed to find a valid plan", NO_WAY),
    ("Failed to find a valid control", NO_MOTION),
    ("Robot is oscillating", TO_AND_FRO),  # also of move_base_flex
    ("Aborting on goal because it was sent with an invalid quaternion", INVALID),
    ("Failed to pass global plan to the controller", OFF_ITS_WAY),
    ("Aborting on the goal because the node has been killed", BROKEN),
    ("Reached a case that should not be hit in move_base", BROKEN),
    # move_base_flex
    ("Global planner returned an empty path", NO_WAY),
    ("Global planner exceeded the patience time", NO_WAY),
    ("Oscillation detected", TO_AND_FRO),
    ("Robot ignored velocity commands", STANDS),
    ("All recovery behaviors failed", NO_MOTION),
    ("Could not get the current robot pose", NO_POSITION),
    ("Could not get the robot pose", NO_POSITION),
    ("Could not transform the plan to the global frame", NO_POSITION),
    ("Controller started with", BROKEN),  # without a path, with an empty or invalid plan
    ("Controller has been stopped", BROKEN),
    ("Global planner has been stopped", BROKEN),
    ("Another thread is still planning", BROKEN),
    ("Could not connect to the move_base_flex actions", BROKEN),
    ("No plugin", BROKEN),
    # the names of its outcome codes: 56, 58; 13, 105; 12, 104; …
    ("No path found", NO_WAY),
    ("Empty path", NO_WAY),
    ("Blocked path", NO_WAY),
    ("Out of map", NO_WAY),
    ("Invalid goal", INVALID),
    ("Blocked goal", OCCUPIED),
    ("Goal blocked", OCCUPIED),
    ("Blocked start", HEMMED_IN),
    ("Start blocked", HEMMED_IN),
    ("Collision", HEMMED_IN),
    ("Impassable", HEMMED_IN),
    ("Oscillation", TO_AND_FRO),
    ("Robot stuck", STANDS),
    ("No valid command", NO_MOTION),
    ("Missed goal", OFF_ITS_WAY),
    ("Missed path", OFF_ITS_WAY),
    ("Invalid path", OFF_ITS_WAY),
    ("Invalid start", NO_POSITION),
    ("TF error", NO_POSITION),
    ("Map error", BROKEN),
    ("Internal error", BROKEN),
    ("Not initialized", BROKEN),
    ("Invalid plugin", BROKEN),
    ("Stopped", BROKEN),
)
"""How a text begins, small letters or capitals, and its meaning."""


_OUTCOMES = {
    12: "Collision", 13: "Oscillation", 14: "Start blocked", 15: "Goal blocked", 16: "TF error", 17: "Internal error",
    52: "Invalid start", 53: "Invalid goal", 54: "Blocked start", 55: "Blocked goal", 56: "No path found",
    57: "Global planner exceeded the patience time", 58: "Empty path", 59: "TF error", 60: "Not initialized",
    61: "Invalid plugin", 62: "Internal error", 63: "Out of map", 64: "Map error", 65: "Stopped",
    102: "No valid command", 103: "No valid command", 104: "Collision", 105: "Oscillation", 106: "Robot stuck",
    107: "Missed goal", 108: "Missed path", 109: "Blocked goal", 110: "Blocked path", 111: "Invalid path",
    112: "TF error", 113: "Not initialized", 114: "Invalid plugin", 115: "Internal error", 116: "Out of map",
    117: "Map error", 118: "Stopped",
}  # fmt: skip
"""Codes of `mbf_msgs` (MoveBase, GetPath, ExePath), and their names above; not those that say only that it failed."""


def outcome_name(code: int) -> str:
    """Return the name of an outcome code of move_base_flex; "" where it says no more than that the goal failed."""
    return _OUTCOMES.get(code, "")


def meaning_of(answer: Answer) -> Meaning:
    """Return what an answer means that ends a goal with a failure: what its outcome says, else its text: plugins have
    texts of their own. A text that is not known is quoted; it says no more than that the robot cannot go on, if its
    goal was aborted."""
    text = answer.text.strip()
    for said in (answer.outcome, text):
        for begin, meaning in _MEANINGS:
            if said.casefold().startswith(begin.casefold()):
                return meaning
    says = f"its goal was {FAILURES[answer.status]}" + (f": {quoted(text)}" if text else "")
    return Meaning(says, STUCK if answer.status == ABORTED else FAILED)
