"""The topics of a mission, and the words on `pursue/events`."""

from __future__ import annotations

import re
from typing import NamedTuple, Optional, Tuple

EVENTS = "pursue/events"
STATE, SYSTEM_STATE = "pursue/state", "pursue/system_state"
PLAN = "pursue/plan"
MARKERS = "pursue/markers"
SEEN = "pursue/seen"
PLAIN_WORDS = "pursue/plain_words"
ORDERS, ANSWERS = "pursue/orders", "pursue/answers"
"""What people order while a mission is under way, a topic and a service, and the answers."""
CANCELLED = "_cancelled_"
"""Behind the event of an order: the event of the state in which it is cancelled."""
LEAVES, JOINS = "_leaves_", "_joins_"
"""The events of the states in which a robot is taken out of service, and brought back."""

START, PING, STOP, FINISH = "_start_", "_ping_", "_stop_", "Finish!"
PLANNED = "_plan_"
ORDERED = "_order_"
REPORTED = "_reported_"
FAILED, STUCK, BLOCKED, FREE = "_failed_", "_stuck_", "_blocked_", "_free_"
HELD, RESUME, DISPLACED, BACK = "_held_", "_resume_", "_displaced_", "_back_"

MAX_TEXT_LENGTH = 300
"""The most characters of the text in a report about a robot; a longer one is cut."""


class Word(NamedTuple):
    """A word on pursue/events: who does what.

    `seq` is the number of the state it is a command for, None: a report. `as_of` is the number of a state in which
    what is reported was going on, None: the report has no number, and counts in any state. `at` is the ROS time
    (seconds) at which it became true, None: when it was received; of an order, and its acknowledgement, when that was
    given.
    """

    agent: str
    event: str
    seq: Optional[int] = None
    as_of: Optional[int] = None
    at: Optional[float] = None


_NUMBER = r"(\d{1,1000})(?:~(\d{1,12}\.\d{1,9}))?"
_WORD = re.compile(rf"\s*(?:(\w+):)?(\w+)[!?]?(?:([@#]){_NUMBER})?\s*", re.ASCII)


def parse_word(text: str) -> Optional[Word]:
    """Reads `[agent:]event[@seq[~at]]` or `[agent:]event#as_of[~at]` (agent "" where none is named); None for anything
    else."""
    match = _WORD.fullmatch(text)
    if match is None:
        return None
    agent, event, sign, digits, at = match.groups()
    number, moment = _read_number(digits, at)
    seq, as_of = (number, None) if sign == "@" else (None, number)
    return Word(agent or "", event, seq, as_of, moment)


def event_in(text: str) -> str:
    """The event in `[agent:]event[@seq][#as_of]`; of any other text about the same part."""
    return text.partition("@")[0].partition("#")[0].rpartition(":")[2]


def format_word(word: Word) -> str:
    """Writes what parse_word reads."""
    prefix = word.agent + ":" if word.agent else ""
    return prefix + word.event + _number("@", word.seq, word.at) + _number("#", word.as_of, word.at)


class RobotReport(NamedTuple):
    """A word about a robot or a way, such as `bot1:_failed_`, and a text that says why ("": none).

    `as_of` and `at` are as in Word.
    """

    agent: str
    event: str
    text: str = ""
    as_of: Optional[int] = None
    at: Optional[float] = None


_REPORT = re.compile(
    rf"\s*(\w+):({'|'.join((FAILED, STUCK, BLOCKED, FREE, HELD, RESUME, DISPLACED, BACK))})"
    rf"(?:#{_NUMBER})?(?:\s+(\S.*))?\s*",
    re.ASCII,
)


def parse_report(text: str) -> Optional[RobotReport]:
    """Read `robot:_failed_ why` and the other reports about a robot; None for anything else."""
    match = _REPORT.fullmatch(text)
    if match is None:
        return None
    agent, event, as_of, at, why = match.groups()
    return RobotReport(agent, event, one_line(why or ""), *_read_number(as_of, at))


def format_report(report: RobotReport) -> str:
    """Write what parse_report reads."""
    return f"{report.agent}:{report.event}{_number('#', report.as_of, report.at)} {one_line(report.text)}".rstrip()


def said_at(text: str) -> Optional[float]:
    """Return the ROS time (seconds) at which what a text reports became true; None where it does not say."""
    report = parse_report(text) or parse_word(text)
    return report.at if report is not None and report.as_of is not None else None


def _number(sign: str, number: Optional[int], at: Optional[float]) -> str:
    """The number and the time as they stand in a word: a time only behind a number."""
    if number is None:
        return ""
    return f"{sign}{number}" if at is None else f"{sign}{number}~{at:.6f}"


def _read_number(number: Optional[str], at: Optional[str]) -> Tuple[Optional[int], Optional[float]]:
    """The number and the time from their texts."""
    return None if number is None else int(number), None if at is None else float(at)


def one_line(text: str) -> str:
    """The text without line breaks and other characters that are not printed, cut where it is too long."""
    return " ".join("".join(char if char.isprintable() else " " for char in text).split())[:MAX_TEXT_LENGTH].rstrip()
