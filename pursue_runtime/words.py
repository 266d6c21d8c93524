"""The topics of a mission, and the words on `pursue/events`."""

from __future__ import annotations

import re
from typing import NamedTuple, Optional

EVENTS = "pursue/events"
STATE, SYSTEM_STATE = "pursue/state", "pursue/system_state"
PLAN = "pursue/plan"

START, PING, STOP, FINISH = "_start_", "_ping_", "_stop_", "Finish!"
PLANNED, FAILED = "_plan_", "_failed_"
BLOCKED, FREE = "_blocked_", "_free_"


class Word(NamedTuple):
    """A word on pursue/events: who does what; `seq` is the number of the state it is a command for, None: a report."""

    agent: str
    event: str
    seq: Optional[int] = None


_WORD = re.compile(r"\s*(?:(\w+):)?(\w+)[!?]?(?:@(\d{1,18}))?\s*", re.ASCII)


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
