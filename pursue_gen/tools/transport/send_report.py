"""What queries and orders to robots came to: a table, JSON, the last message, or the error where it is not the required
one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Tuple

from pursue_gen.columns import columns
from pursue_gen.diagnostics import counted, error
from pursue_gen.files import shell_quoted
from pursue_gen.outcomes import Different, Unchanged, Unfinished
from pursue_gen.tools.transport.client import Status
from pursue_gen.tools.transport.sender import Row, Sent
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


_ONCE_MORE = (
    "see the table; pursue-gen explain TRN034 tells for each reason what to do. Once that is mended, run the same "
    "command again"
)


def all_reached(rows: Sequence[Row], hint: str = _ONCE_MORE) -> List[Status]:
    """The statuses of all robots. Raises Unchanged where one is out of reach."""
    lost = [row.robot.name for row in rows if row.after is None]
    if lost:
        raise Unchanged([error("TRN034", f"cannot reach {', '.join(lost)}", hint=hint)])
    return [row.after for row in rows if row.after is not None]


def check_alike(rows: Sequence[Row]) -> None:
    """Raises Unchanged where robots are out of reach, Different where they differ in their missions."""
    statuses = all_reached(rows, "is it on, and its address right? pursue-gen explain TRN034 tells more")
    if len({status.standing for status in statuses}) > 1:
        hint = "send one mission to all of them, or go back: --back"
        raise Different([error("TRN035", "the robots do not have the same mission", hint=hint)])


def after_waiting(sent: Sent, rows: Sequence[Row]) -> Tuple[Row, ...]:
    """The rows as they are after the wait, with what was there before."""
    found = []
    for old, new in zip(sent.rows, rows):
        after = new.after or old.after
        there = after is not None and after.current == sent.mission and after.next is None
        changed = "changed" if not old.same else old.outcome
        found.append(replace(old, after=after, outcome=changed if there else old.outcome))
    return tuple(found)


def success(sent: Sent, rows: Sequence[Row], waited: Optional[float], to: Path) -> str:
    """The last words on what was sent. `waited`: seconds; `to`: the file of the robots.

    Raises Unchanged or Different where it was not done, Unfinished where it has not taken effect after the wait.
    """
    if not sent.done and sent.unchanged:
        raise Unchanged([error("TRN034", f"nothing has changed. {sent.trouble}", hint=_ONCE_MORE)])
    if not sent.done:
        hint = f"look again: pursue-gen send --status --to {shell_quoted(to)}; then send the mission once more"
        raise Different([error("TRN035", f"the robots differ. {sent.trouble}", hint=hint)])
    name = mission_id(sent.mission)
    late = [row.robot.name for row in rows if row.after is None or row.after.current != sent.mission]
    if late and waited is not None:
        message = f"after {waited:g} s a mission is still under way: {', '.join(late)}"
        hint = f"{name} takes effect when it has ended, or is stopped"
        raise Unfinished([error("TRN036", message, hint=hint)])
    who = f"{counted(len(rows), 'machine')} of {to} {'has' if len(rows) == 1 else 'have'}"
    return f"{who} the mission {name}{'; it takes effect when the one under way has ended' if late else ''}."
