"""The topics of a mission, and the words on `pursue/events`."""

from __future__ import annotations

import re
from typing import NamedTuple, Optional

EVENTS = "pursue/events"
STATE, SYSTEM_STATE = "pursue/state", "pursue/system_state"
PLAN = "pursue/plan"
MARKERS = "pursue/markers"
SEEN = "pursue/seen"

START, PING, STOP, FINISH = "_start_", "_ping_", "_stop_", "Finish!"
PLANNED = "_plan_"
FAILED, BLOCKED, FREE = "_failed_", "_blocked_", "_free_"
HELD, RESUME, DISPLACED, BACK = "_held_", "_resume_", "_displaced_", "_back_"

MAX_TEXT_LENGTH = 300
"""The most characters of the text in a report about a robot; a longer one is cut."""


class Word(NamedTuple):
    """A word on pursue/events: who does what.

    `seq` is the number of the state it is a command for, None: a report. `as_of` is the number of a state in which
    what is reported was going on, None: the report has no number, and counts in any state.
    """

    agent: str
    event: str
    seq: Optional[int] = None
    as_of: Optional[int] = None


_WORD = re.compile(r"\s*(?:(\w+):)?(\w+)[!?]?(?:@(\d{1,1000})|#(\d{1,1000}))?\s*", re.ASCII)


def parse_word(text: str) -> Optional[Word]:
    """Reads `[agent:]event[@seq]` or `[agent:]event#as_of` (agent "" where none is named); None for anything else."""
    match = _WORD.fullmatch(text)
    if match is None:
        return None
    agent, event, seq, as_of = match.groups()
    return Word(agent or "", event, None if seq is None else int(seq), None if as_of is None else int(as_of))


def format_word(word: Word) -> str:
    """Writes what parse_word reads."""
    prefix = word.agent + ":" if word.agent else ""
    number = "" if word.seq is None else f"@{word.seq}"
    return prefix + word.event + number + _number(word.as_of)


class RobotReport(NamedTuple):
    """A word about a robot or a way, such as `bot1:_failed_`, and a text that says why ("": none).

    `as_of` is as in Word.
    """

    agent: str
    event: str
    text: str = ""
    as_of: Optional[int] = None


_REPORT = re.compile(
    rf"\s*(\w+):({'|'.join((FAILED, BLOCKED, FREE, HELD, RESUME, DISPLACED, BACK))})"
    r"(?:#(\d{1,1000}))?(?:\s+(\S.*))?\s*",
    re.ASCII,
)


def parse_report(text: str) -> Optional[RobotReport]:
    """Read `robot:_failed_ why` and the other reports about a robot; None for anything else."""
    match = _REPORT.fullmatch(text)
    if match is None:
        return None
    agent, event, as_of, why = match.groups()
    return RobotReport(agent, event, _one_line(why or ""), None if as_of is None else int(as_of))


def format_report(report: RobotReport) -> str:
    """Write what parse_report reads."""
    return f"{report.agent}:{report.event}{_number(report.as_of)} {_one_line(report.text)}".rstrip()


def _number(as_of: Optional[int]) -> str:
    """The number of a report as it stands in a word."""
    return "" if as_of is None else f"#{as_of}"


def _one_line(text: str) -> str:
    """The text without line breaks and other characters that are not printed, cut where it is too long."""
    return " ".join("".join(char if char.isprintable() else " " for char in text).split())[:MAX_TEXT_LENGTH].rstrip()
