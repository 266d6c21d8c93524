"""The command `bundle`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Dict, Optional, Tuple

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import EXPLAIN, KEY, KEYS, MISSION, PLACES, REQUEST, Poses, with_request
from pursue_gen.diagnostics import usage_error
from pursue_gen.files import shell_quoted

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest
    from pursue_runtime.manifest import Manifest


@guarded
@with_request(*MISSION)
def bundle(
    scenario: Optional[Path] = typer.Argument(None, metavar="SCENARIO", help="A scenario in PuRSUE-ML."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Where the bundle goes; <scenario>.pursue by default."
    ),
    key: Optional[str] = KEY,
    keys: Optional[Path] = KEYS,
    check: Optional[Path] = typer.Option(
        None, "--check", metavar="FILE.pursue", help="Show what is in a bundle, and check all of it, instead."
    ),
    request: SolveRequest = REQUEST,
    places: Poses = PLACES,
    explain: bool = EXPLAIN,
) -> None:
    """Write a mission as one signed file, which robots take: data only, no code.

    Its file and its digest are printed on stdout. The same scenario with the same options, signed with the same key,
    gives the same file.
    """
    from pursue_gen.files import write_bytes
    from pursue_gen.tools.transport.bundles import SUFFIX, sign
    from pursue_gen.tools.transport.keys import keys_folder, load_private

    folder = keys or keys_folder()
    if check is not None:
        if scenario is not None or output is not None:
            raise usage_error("--check looks at a bundle that is there", "leave out SCENARIO and -o")
        _print_bundle(check, folder)
        return
    if scenario is None:
        raise usage_error(
            "a scenario is missing", "pursue-gen bundle my_floor.pur, or pursue-gen bundle --check FILE.pursue"
        )
    target = output or Path(f"{scenario.stem}{SUFFIX}")
    if target.suffix != SUFFIX:
        raise usage_error(f"a bundle cannot be called {target}", f"its name ends with {SUFFIX}")
    private = load_private(key, folder)  # before the work: it may be missing
    manifest, files = mission_of_scenario(scenario, request, places, explain)
    write_bytes({target: sign(manifest, files, private)})
    print(target, manifest.digest, sep="\n")
    info(f"The mission of {manifest.scenario} is in {target}: {len(files)} files, signed.")
    suggest(f"pursue-gen send {shell_quoted(target)} --to robots.yaml")


def mission_of_scenario(
    file: Path, request: SolveRequest, poses: Poses, explain: bool
) -> Tuple[Manifest, Dict[str, bytes]]:
    """The mission of a scenario's file, solved and proven; the verdict is printed. Raises PursueError.

    `explain`: where the scenario is not won, why is printed.
    """
    from pursue_gen import api
    from pursue_gen.cli.inputs import settled, solve_and_print
    from pursue_gen.tools.transport.bundles import make_mission, placed
    from pursue_gen.workspace.spots import spots_in_one

    scenario = settled(placed(api.read(file), poses.file, poses.computed), request)
    show(spots_in_one(scenario, poses.spot_distance))
    solved = solve_and_print(scenario, request, explain)
    info(solved.margin_text())
    return make_mission(solved.scenario, solved.solution, request, poses.spot_distance)


def _print_bundle(file: Path, folder: Path) -> None:
    """Prints what is in a bundle as a table, once all of it is checked."""
    from pursue_gen.tools.transport.bundles import read_bundle
    from pursue_gen.tools.transport.keys import public_keys
    from pursue_runtime.bundle import fingerprint
    from pursue_runtime.manifest import mission_id

    known, findings = public_keys(folder)
    show(findings)
    names = {fingerprint(key): name for name, key in reversed(list(known.items()))}
    _, found = read_bundle(file, {fingerprint(key): key for key in known.values()})
    rows = (
        ("scenario", found.manifest.scenario),
        ("mission", f"{mission_id(found.digest)} (in states and logs)"),
        ("digest", found.digest),
        ("generator", f"pursue-gen {found.manifest.generator}"),
        ("controllers", ", ".join(found.manifest.controllers)),
        ("signed by", f"{names[found.signed_by]} ({found.signed_by})"),
        ("files", str(len(found.files))),
    )
    for name, what in rows:
        print(f"{name:12}  {what}")
    for path, content in sorted(found.files.items()):
        print(f"  {path:40}  {len(content)} bytes")
    info(f"{file} has a valid signature, and its files are unchanged.")
