"""The topics of a mission, and the words on `pursue/events`."""

from __future__ import annotations

import re
from typing import NamedTuple, Optional

EVENTS = "pursue/events"
STATE, SYSTEM_STATE = "pursue/state", "pursue/system_state"
PLAN = "pursue/plan"
SEEN = "pursue/seen"

START, PING, STOP, FINISH = "_start_", "_ping_", "_stop_", "Finish!"
PLANNED = "_plan_"
FAILED, BLOCKED, FREE = "_failed_", "_blocked_", "_free_"
HELD, RESUME, DISPLACED, BACK = "_held_", "_resume_", "_displaced_", "_back_"

MAX_TEXT_LENGTH = 300
"""The most characters of the text in a report about a robot; a longer one is cut."""


class Word(NamedTuple):
    """A word on pursue/events: who does what; `seq` is the number of the state it is a command for, None: a report."""

    agent: str
    event: str
    seq: Optional[int] = None


_WORD = re.compile(r"\s*(?:(\w+):)?(\w+)[!?]?(?:@(\d{1,1000}))?\s*", re.ASCII)


def parse_word(text: str) -> Optional[Word]:
    """Reads `[agent:]event[@seq]` (agent "" where none is named); None for anything else."""
    match = _WORD.fullmatch(text)
    if match is None:
        return None
    agent, event, seq = match.groups()
    return Word(agent or "", event, None if seq is None else int(seq))


def format_word(word: Word) -> str:
    """Writes what parse_word reads."""
    prefix = word.agent + ":" if word.agent else ""
    return prefix + word.event + ("" if word.seq is None else f"@{word.seq}")


class RobotReport(NamedTuple):
    """A word about a robot or a way, such as `bot1:_failed_`, and a text that says why ("": none)."""

    agent: str
    event: str
    text: str = ""


_REPORT = re.compile(
    rf"\s*(\w+):({'|'.join((FAILED, BLOCKED, FREE, HELD, RESUME, DISPLACED, BACK))})(?:\s+(\S.*))?\s*", re.ASCII
)


def parse_report(text: str) -> Optional[RobotReport]:
    """Read `robot:_failed_ why` and the other reports about a robot; None for anything else."""
    match = _REPORT.fullmatch(text)
    return RobotReport(match.group(1), match.group(2), _one_line(match.group(3) or "")) if match else None


def format_report(report: RobotReport) -> str:
    """Write what parse_report reads."""
    return f"{report.agent}:{report.event} {_one_line(report.text)}".rstrip()


def _one_line(text: str) -> str:
    """The text without line breaks and other characters that are not printed, cut where it is too long."""
    return " ".join("".join(char if char.isprintable() else " " for char in text).split())[:MAX_TEXT_LENGTH].rstrip()
