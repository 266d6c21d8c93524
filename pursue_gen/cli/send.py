"""The command `send`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional, Sequence

import typer

from pursue_gen.cli.console import guarded, suggest, tell
from pursue_gen.cli.options import (
    COMPUTED_POSES,
    CONTROLLERS,
    ENDS,
    EXPLAIN,
    JSON,
    KEY,
    KEYS,
    LIMIT,
    MEMORY,
    OPTIMIZE,
    PLAN,
    POSES,
    REACH_OBJ,
    REACTION,
    SLACK,
    SOLVER,
    VERIFYTGA,
    Controllers,
    Ends,
    Optimize,
    Solver,
    value,
)
from pursue_gen.diagnostics import usage_error
from pursue_gen.files import shell_quoted

if TYPE_CHECKING:
    from pursue_gen.transport.bundles import AskedMission
    from pursue_gen.transport.client import Robot
    from pursue_gen.transport.keys import Ed25519PrivateKey
    from pursue_gen.transport.sender import Row, Sent

MISSION = typer.Argument(
    None,
    metavar="[SCENARIO|FILE.pursue|DIGEST]",
    help="A scenario, or a bundle; with --back an earlier mission: its first digits, or own.",
)


@guarded
def send(
    mission: Optional[str] = MISSION,
    to: Path = typer.Option(..., "--to", metavar="robots.yaml", help="The file that says where the robots listen."),
    only: Optional[str] = typer.Option(None, metavar="ROBOT,…", help="These robots of the file; the others are left."),
    status: bool = typer.Option(False, "--status", help="Send nothing; show what each robot plays."),
    back: bool = typer.Option(
        False, "--back", help="Send nothing; go back to the mission before this one, or to the one that is named."
    ),
    wait: Optional[float] = typer.Option(
        None, metavar="SECONDS", min=0.0, help="Then wait, at most so long, until all robots play it."
    ),
    key: Optional[str] = KEY,
    keys: Optional[Path] = KEYS,
    controllers: Controllers = CONTROLLERS,
    reach_obj: str = REACH_OBJ,
    ends: Optional[Ends] = ENDS,
    reaction: Optional[str] = REACTION,
    slack: List[str] = SLACK,
    plan: Optional[Path] = PLAN,
    poses: Optional[Path] = POSES,
    computed_poses: bool = COMPUTED_POSES,
    solver: Optional[Solver] = SOLVER,
    verifytga: Optional[Path] = VERIFYTGA,
    optimize: Optional[Optimize] = OPTIMIZE,
    limit: float = LIMIT,
    memory: Optional[int] = MEMORY,
    explain: bool = EXPLAIN,
    as_json_: bool = JSON,
) -> None:
    """Send a mission to robots: all of them change to it, or none.

    A table with a line per robot is printed. The exit status is 7 if nothing has changed since a robot could not be
    reached or refused, 8 if the robots differ, 5 if --wait was too short.
    """
    from pursue_gen.solving.options import asked_limits
    from pursue_gen.transport.bundles import AskedMission
    from pursue_gen.transport.keys import load_private
    from pursue_gen.transport.robots_file import chosen, read_robots
    from pursue_gen.transport.send_ended import after_waiting, success
    from pursue_gen.transport.sender import wait as wait_for

    how = (value(solver), verifytga, value(optimize), asked_limits(limit, memory), poses, computed_poses)
    asked = AskedMission(controllers.value, reach_obj, value(ends), reaction, tuple(slack), plan, *how)
    _check_usage(mission, status, back, asked)
    robots = read_robots(to)
    robots = robots if only is None else chosen(robots, only, to)
    if status:
        _show_status(robots, as_json_)
        return
    private = load_private(key, keys)
    if back:
        sent = _sent_back(mission, robots, private, as_json_)
    else:
        sent = _sent(Path(str(mission)), robots, private, keys, asked, explain, only is None, as_json_)
    rows = sent.rows
    if sent.done and wait is not None:
        rows = after_waiting(sent, wait_for(robots, sent.mission, wait))
    _show(rows, as_json_, mission=sent.mission, done=sent.done, unchanged=sent.unchanged, trouble=sent.trouble)
    tell(success(sent, rows, wait, to))
    suggest(
        f"pursue-gen send --status --to {shell_quoted(to)}", "rostopic pub -1 pursue/events std_msgs/String _start_"
    )


def _check_usage(mission: Optional[str], status: bool, back: bool, asked: AskedMission) -> None:
    """Raises PursueError (exit status 2) where arguments do not go together."""
    from pursue_gen.transport.bundles import SUFFIX, AskedMission

    if status and (back or mission is not None):
        raise usage_error("--status sends nothing", "leave out --back and the mission")
    if not (status or back) and mission is None:
        raise usage_error(
            "a mission is missing", "pursue-gen send my_floor.pur --to robots.yaml, or a bundle (*.pursue)"
        )
    plain = asked == AskedMission(limits=asked.limits)
    if not plain and (status or back or str(mission).endswith(SUFFIX)):
        raise usage_error(
            "there is no scenario to make a plan for", "leave out the options of the game, such as --reaction"
        )


def _sent(
    mission: Path,
    robots: Sequence[Robot],
    private: Ed25519PrivateKey,
    keys: Optional[Path],
    asked: AskedMission,
    explain: bool,
    all_robots: bool,
    quiet: bool,
) -> Sent:
    """A scenario's or a bundle's mission, sent."""
    from pursue_gen.transport.bundles import bundle_of
    from pursue_gen.transport.keys import keys_folder
    from pursue_gen.transport.send_checks import fits
    from pursue_gen.transport.send_table import upload_lines
    from pursue_gen.transport.sender import send as send_to

    manifest, content = bundle_of(mission, asked, private, keys or keys_folder(), explain)
    packages = {path.split("/")[0] for path in manifest.files}
    with upload_lines(quiet) as progress:
        check = fits(manifest.digest, packages, len(content), all_robots)
        return send_to(robots, manifest.digest, content, private, check, progress, say=tell)


def _sent_back(mission: Optional[str], robots: Sequence[Robot], private: Ed25519PrivateKey, as_json_: bool) -> Sent:
    """The robots, told to play an earlier mission; where one is out of reach, they are shown and the command ends."""
    from pursue_gen.transport.send_checks import asked_mission, kept_by_all, previous
    from pursue_gen.transport.send_ended import all_reached
    from pursue_gen.transport.send_table import standing_told
    from pursue_gen.transport.sender import look
    from pursue_gen.transport.sender import send as send_to

    rows = standing_told(look(robots))
    if any(row.after is None for row in rows):
        _show(rows, as_json_, looked=True)
    statuses = all_reached(rows)
    wanted = previous(statuses) if mission is None else asked_mission(mission, statuses)
    return send_to(robots, wanted, b"", private, kept_by_all(wanted), say=tell)


def _show_status(robots: Sequence[Robot], as_json_: bool) -> None:
    """What each robot plays, as a table."""
    from pursue_gen.transport.send_ended import check_alike
    from pursue_gen.transport.send_table import standing_told
    from pursue_gen.transport.sender import look

    rows = standing_told(look(robots))
    _show(rows, as_json_, looked=True)
    check_alike(rows)


def _show(rows: Sequence[Row], as_json_: bool, looked: bool = False, **facts: object) -> None:
    from pursue_gen.transport.send_table import as_json, table

    if as_json_:
        print(json.dumps(as_json(rows, **facts), indent=1))
    else:
        print("\n".join(table(rows, looked)))
