"""What is published of each drive, and of each action, on `pursue/drives`, as JSON."""

from __future__ import annotations

import json
from typing import Any, Dict, List, NamedTuple, Optional

from pursue_runtime.bounded import json_object

DRIVES = "pursue/drives"
"""The topic (std_msgs/String)."""

ARRIVED, FAILED, LATE, INTERRUPTED = "arrived", "failed", "late", "interrupted"
"""How a drive or an action ends: the robot is there, or it is done; the robot gave up; it was not there in the time
that it had; somebody stopped it."""
OUTCOMES = (ARRIVED, FAILED, LATE, INTERRUPTED)

_FORMAT = 1
_MOST_GOALS = 1000


class Drive(NamedTuple):
    """A drive of a robot from `a` to `b`, from `start` to `end` (seconds of ROS time). Where `action` names an event it
    is that event at `a`, which is `b` too.

    `goals`: how many it took, as failed ones are sent again; `text`: why it ended otherwise than ARRIVED.
    """

    robot: str
    a: str
    b: str
    start: float
    end: float
    outcome: str = ARRIVED
    goals: int = 1
    text: str = ""
    action: str = ""

    @property
    def seconds(self) -> float:
        """How long it took."""
        return self.end - self.start


def format_drive(drive: Drive) -> str:
    """The text of a drive."""
    data: Dict[str, Any] = {"format": _FORMAT, "robot": drive.robot, "from": drive.a, "to": drive.b}
    data.update(start=round(drive.start, 6), end=round(drive.end, 6), outcome=drive.outcome, goals=drive.goals)
    if drive.action:
        data["action"] = drive.action
    if drive.text:
        data["text"] = drive.text
    return json.dumps(data)


def parse_drive(text: str) -> Optional[Drive]:
    """The drive in a text that `format_drive` has written; None for anything else."""
    data = json_object(text)
    if data is None or data.get("format") != _FORMAT or data.get("outcome") not in OUTCOMES:
        return None
    values: List[Any] = [data.get(key) for key in ("robot", "from", "to", "start", "end")]
    robot, a, b, start, end = values
    goals, why, action = data.get("goals", 1), data.get("text", ""), data.get("action", "")
    if not all(isinstance(name, str) and name for name in (robot, a, b)):
        return None
    if not isinstance(why, str) or not isinstance(action, str):
        return None
    if not _is_time(start) or not _is_time(end) or end < start:
        return None
    if not isinstance(goals, int) or isinstance(goals, bool) or not 0 <= goals <= _MOST_GOALS:
        return None
    return Drive(robot, a, b, float(start), float(end), data["outcome"], goals, why, action)


def _is_time(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e15
