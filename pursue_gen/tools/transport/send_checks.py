"""Checks before robots are ordered anything: whether the mission fits them, and which one is meant."""

from __future__ import annotations

from typing import Collection, List, Sequence, Set

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Unchanged
from pursue_gen.tools.transport.client import Status
from pursue_gen.tools.transport.sender import Check
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
