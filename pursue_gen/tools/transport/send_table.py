"""The states of robots as a table, and as JSON."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Dict, List, Optional, Sequence, Tuple

from pursue_gen.columns import columns
from pursue_gen.tools.transport.client import Status
from pursue_gen.tools.transport.sender import Row
from pursue_runtime.manifest import mission_id

_HEAD = ("robot", "address", "now", "before", "prepared", "outcome")


def table(rows: Sequence[Row], looked: bool = False) -> List[str]:
    """One line per robot, below a head; `?` where something is not known, `-` where there is nothing.

    `before` is what it had before it was sent something; where it was only `looked` at, before what it has now.
    """
    return columns([_HEAD, *(_cells(row, looked) for row in rows)], "<")


def _cells(row: Row, looked: bool) -> Tuple[str, ...]:
    after = row.after
    prepared = "?" if after is None else "-" if after.prepared is None else mission_id(after.prepared)
    now = "?" if after is None else _plays(after, f" ({after.scenario})" if after.scenario else "")
    return (row.robot.name, row.robot.address, now, _earlier(row, looked), prepared, row.outcome)


def _earlier(row: Row, looked: bool) -> str:
    if row.before is None:
        return "?"
    if not looked:
        return _plays(row.before)
    return mission_id(row.before.history[-1]) if row.before.history else "-"


def _plays(status: Status, scenario: str = "") -> str:
    follows = "" if status.next is None else f", then {mission_id(status.next)}"
    return f"{mission_id(status.current)}{scenario}{follows}"


def as_json(rows: Sequence[Row], **facts: Any) -> Dict[str, Any]:
    """The rows for programs; missions are digests in full, "" the workspace's own. `facts` come first."""
    robots = [
        {
            "robot": row.robot.name,
            "address": row.robot.address,
            "outcome": row.outcome,
            "same": row.same,
            "before": _facts(row.before),
            "now": _facts(row.after),
        }
        for row in rows
    ]
    return {**facts, "robots": robots}


def _facts(status: Optional[Status]) -> Optional[Dict[str, Any]]:
    if status is None:
        return None
    return {name: value for name, value in vars(status).items() if name not in ("robot", "ticket")}


def with_activity(rows: Sequence[Row]) -> Tuple[Row, ...]:
    """The rows with whether a mission runs on the robot as their outcome, or why it was not reached."""
    activity = {True: "a mission is under way", False: "no mission runs"}
    outcomes = (activity[row.after.mission_runs] if row.after else f"not reached: {row.outcome}" for row in rows)
    return tuple(replace(row, outcome=outcome) for row, outcome in zip(rows, outcomes))
