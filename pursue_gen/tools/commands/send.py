"""The command `send`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Sequence, Tuple

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import EXPLAIN, JSON, KEY, KEYS, MISSION, PLACES, REQUEST, Poses, with_request
from pursue_gen.diagnostics import usage_error
from pursue_gen.files import shell_quoted
from pursue_gen.tools.commands.bundle import mission_of_scenario

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.tools.transport.client import Robot
    from pursue_gen.tools.transport.keys import Ed25519PrivateKey
    from pursue_gen.tools.transport.sender import Row, Sent
    from pursue_runtime.manifest import Manifest

WHAT = typer.Argument(
    None,
    metavar="[SCENARIO|FILE.pursue|DIGEST]",
    help="A scenario, or a bundle; with --back an earlier mission: its first digits, or own.",
)


@guarded
@with_request(*MISSION)
def send(
    mission: Optional[str] = WHAT,
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
    request: SolveRequest = REQUEST,
    places: Poses = PLACES,
    explain: bool = EXPLAIN,
    as_json_: bool = JSON,
) -> None:
    """Send a mission to robots: all of them change to it, or none.

    A table with a line per robot is printed. The exit status is 7 if nothing has changed since a robot could not be
    reached or refused, 8 if the robots differ, 5 if --wait was too short.
    """
    from pursue_gen.tools.transport.bundles import is_bundle, sign
    from pursue_gen.tools.transport.keys import load_private
    from pursue_gen.tools.transport.robots_file import chosen, read_robots
    from pursue_gen.tools.transport.send_report import after_waiting, success
    from pursue_gen.tools.transport.sender import wait as wait_for

    is_default = request.is_default and places == Poses()
    _check_usage(mission, status, back, is_default)
    robots = read_robots(to)
    robots = robots if only is None else chosen(robots, only, to)
    if status:
        _show_status(robots, as_json_)
        return
    private = load_private(key, keys)
    if back:
        sent = _send_back(mission, robots, private, as_json_)
    else:
        file = Path(str(mission))
        if is_bundle(file):
            manifest, content = _signed_bundle(file, private, keys)
        else:
            manifest, files = mission_of_scenario(file, request, places, explain)
            content = sign(manifest, files, private)
        sent = _send(robots, manifest, content, private, only is None, as_json_)
    rows = sent.rows
    if sent.done and wait is not None:
        rows = after_waiting(sent, wait_for(robots, sent.mission, wait))
    _show(rows, as_json_, mission=sent.mission, done=sent.done, unchanged=sent.unchanged, trouble=sent.trouble)
    info(success(sent, rows, wait, to))
    start = "rostopic pub -1 pursue/events std_msgs/String _start_"
    suggest(f"pursue-gen send --status --to {shell_quoted(to)}", start)


def _check_usage(mission: Optional[str], status: bool, back: bool, is_default: bool) -> None:
    """Raises PursueError (exit status 2) where arguments do not go together; `is_default`: no option of the game."""
    from pursue_gen.tools.transport.bundles import is_bundle

    if status and (back or mission is not None):
        raise usage_error("--status sends nothing", "leave out --back and the mission")
    if not (status or back) and mission is None:
        hint = "pursue-gen send my_floor.pur --to robots.yaml, or a bundle (*.pursue)"
        raise usage_error("a mission is missing", hint)
    if not is_default and (status or back or is_bundle(Path(str(mission)))):
        hint = "leave out the options of the game, such as --reaction"
        raise usage_error("there is no scenario to make a plan for", hint)


def _signed_bundle(file: Path, private: Ed25519PrivateKey, keys: Optional[Path]) -> Tuple[Manifest, bytes]:
    """The bundle in a file, signed with this key or with one in the folder of keys; findings are printed."""
    from pursue_gen.tools.transport.bundles import read_bundle
    from pursue_gen.tools.transport.keys import keys_folder, public_keys
    from pursue_runtime.bundle import fingerprint

    known, findings = public_keys(keys or keys_folder())
    show(findings)
    content, found = read_bundle(file, {fingerprint(one): one for one in (*known.values(), private.public_key())})
    return found.manifest, content


def _send(
    robots: Sequence[Robot],
    manifest: Manifest,
    content: bytes,
    private: Ed25519PrivateKey,
    all_robots: bool,
    quiet: bool,
) -> Sent:
    """Sends a mission's bundle to the robots, with a line of progress for each."""
    from pursue_gen.tools.commands.progress import upload_lines
    from pursue_gen.tools.transport.send_report import fits
    from pursue_gen.tools.transport.sender import send as send_to

    packages = {path.split("/")[0] for path in manifest.files}
    check = fits(manifest.digest, packages, len(content), all_robots)
    with upload_lines(quiet) as progress:
        return send_to(robots, manifest.digest, content, private, check, progress, report=info)


def _send_back(mission: Optional[str], robots: Sequence[Robot], private: Ed25519PrivateKey, as_json_: bool) -> Sent:
    """Orders the robots back to an earlier mission; where one is out of reach, prints the table and raises."""
    from pursue_gen.tools.transport.send_report import all_reached, kept_by_all, mission_digest, previous, with_activity
    from pursue_gen.tools.transport.sender import look
    from pursue_gen.tools.transport.sender import send as send_to

    rows = with_activity(look(robots))
    if any(row.after is None for row in rows):
        _show(rows, as_json_, looked=True)
    statuses = all_reached(rows)
    wanted = previous(statuses) if mission is None else mission_digest(mission, statuses)
    return send_to(robots, wanted, b"", private, kept_by_all(wanted), report=info)


def _show_status(robots: Sequence[Robot], as_json_: bool) -> None:
    """Prints what each robot plays, as a table."""
    from pursue_gen.tools.transport.send_report import check_alike, with_activity
    from pursue_gen.tools.transport.sender import look

    rows = with_activity(look(robots))
    _show(rows, as_json_, looked=True)
    check_alike(rows)


def _show(rows: Sequence[Row], as_json_: bool, looked: bool = False, **facts: object) -> None:
    from pursue_gen.tools.transport.send_report import as_json, table

    if as_json_:
        print(json.dumps(as_json(rows, **facts), indent=1))
    else:
        print("\n".join(table(rows, looked)))
