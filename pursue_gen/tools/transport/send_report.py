"""What `send` checks before robots are ordered anything, and how it says what came of it: a table, JSON, the last
message, or the error where it is not the required one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Collection, Dict, List, Optional, Sequence, Set, Tuple

from pursue_gen.columns import columns
from pursue_gen.diagnostics import counted, error
from pursue_gen.files import shell_quoted
from pursue_gen.outcomes import Different, Unchanged, Unfinished
from pursue_gen.tools.transport.client import Status
from pursue_gen.tools.transport.sender import Check, Row, Sent
from pursue_runtime.manifest import OWN, is_digest, mission_id

OWN_WORD = "own"
_SHORTEST = 4
"""The fewest digits that name a mission."""


def fits(mission: str, packages: Collection[str], size: int, all_robots: bool) -> Check:
    """Refuses a mission with packages that no robot has (where all robots are asked), or too large for a robot.

    `size` is the bundle's, in bytes. What is returned raises Unchanged.
    """

    def check(statuses: Sequence[Status]) -> None:
        there: Set[str] = {package for status in statuses for package in status.packages}
        missing = sorted(set(packages) - there) if all_robots else []
        if missing:
            have = "; ".join(f"{status.robot} has {', '.join(status.packages) or 'none'}" for status in statuses)
            message = f"no robot has what this mission needs: {', '.join(missing)}"
            hint = f"start its node on a machine of robots.yaml (nodes:=); the workspace has to be one for it. {have}"
            raise Unchanged([error("TRN030", message, hint=hint)])
        for status in statuses:
            if size > status.limit and not status.holds(mission):
                message = f"the mission has {size} bytes; {status.robot} takes at most {status.limit}"
                hint = "raise ~limit of its pursue_reader and communication_manager"
                raise Unchanged([error("TRN031", message, hint=hint)])

    return check


def kept_by_all(mission: str) -> Check:
    """Refuses a mission that a robot does not keep: going back sends nothing. Raises Unchanged."""

    def check(statuses: Sequence[Status]) -> None:
        without = [status.robot for status in statuses if not status.holds(mission)]
        if without:
            message = f"the mission {mission_id(mission)} is not kept by {', '.join(without)}"
            hint = f"send its scenario or its bundle instead. {_what_each_has(statuses)}"
            raise Unchanged([error("TRN033", message, hint=hint)])

    return check


def mission_digest(text: str, statuses: Sequence[Status]) -> str:
    """The digest of the mission that is meant by `own`, a digest, or its first digits. Raises PursueError."""
    if text == OWN_WORD:
        return OWN
    known = {mission for status in statuses for mission in _missions(status) if mission != OWN}
    found = sorted(mission for mission in known if mission.startswith(text)) if len(text) >= _SHORTEST else []
    if len(found) == 1 or is_digest(text):
        return found[0] if found else text
    why = "several missions begin like this" if found else "no robot keeps such a mission"
    hint = f"name own, or at least {_SHORTEST} digits of a mission. {_what_each_has(statuses)}"
    raise Unchanged([error("TRN033", f"{text}: {why}", hint=hint)])


def previous(statuses: Sequence[Status]) -> str:
    """The mission that all robots had before: the last of the earlier ones that all of them still keep. Where they
    differ, since a desk died while it committed, it is the last that all have played: some may still stand at it.

    Raises Unchanged where there is none, or where they do not agree on which it is.
    """
    differ = len({status.standing for status in statuses}) > 1
    played = [[*_earlier(status), *([status.standing] if differ else [])] for status in statuses]
    common = set(played[0]).intersection(*played[1:]) if played else set()
    last = {next(mission for mission in reversed(one) if mission in common) for one in played} if common else set()
    if len(last) == 1:
        return last.pop()
    why = "the robots do not agree on an earlier mission" if len(statuses) > 1 else "there is no earlier mission"
    hint = f"name one: pursue-gen send --back DIGEST, or own. {_what_each_has(statuses)}"
    raise Unchanged([error("TRN032", why, hint=hint)])


def _earlier(status: Status) -> List[str]:
    """What a robot played before what it stands at, newest last, where it still has it."""
    history = [*status.history, status.current]
    return [mission for mission in history if mission != status.standing and status.holds(mission)]


def _missions(status: Status) -> List[str]:
    waiting = [mission for mission in (status.next, status.prepared) if mission is not None]
    return [status.current, *waiting, *status.kept, *_earlier(status)]


def _what_each_has(statuses: Sequence[Status]) -> str:
    """What each robot could go back to, newest first."""
    parts = []
    for status in statuses:
        missions = dict.fromkeys([*reversed(_earlier(status)), *status.kept])
        names = [mission_id(mission) for mission in missions if mission != status.standing]
        parts.append(f"{status.robot} plays {mission_id(status.standing)}, has {', '.join(names) or 'no other'}")
    return "; ".join(parts)


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
    return (row.robot.name, row.robot.address, now, _before(row, looked), prepared, row.outcome)


def _before(row: Row, looked: bool) -> str:
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
