"""A scenario → its mission, as data that travels; and the file that holds it, signed (a bundle, *.pursue)."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Mapping, Optional, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.files import reason_of
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Invalid
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.transport.keys import Ed25519PrivateKey  # first: it says what to do without cryptography
from pursue_gen.tools.transport.poses_file import with_poses
from pursue_gen.workspace.generate import generate, mission_of
from pursue_gen.workspace.make import Extras, options_for
from pursue_gen.workspace.spots import SPOT_DISTANCE
from pursue_runtime.bundle import LIMIT, Bundle, Keys, Refused, fingerprint, pack, unpack
from pursue_runtime.manifest import Manifest
from pursue_runtime.named_files import read_start

SUFFIX = ".pursue"
_SHOWN = 5  # points that a message names


def is_bundle(file: Path) -> bool:
    """True for a bundle, as its name says."""
    return file.name.endswith(SUFFIX)


def make_mission(
    scenario: Scenario, won: Solution, request: SolveRequest, spot_distance: float = SPOT_DISTANCE
) -> Tuple[Manifest, Dict[str, bytes]]:
    """The mission of a scenario and its proven solution: its manifest, and `package/name.yaml` → content.

    It is the same as that of a workspace for the same request and distance (metres). Raises as `generate`.
    """
    options = options_for(request, won, extras=Extras(spot_distance=spot_distance))
    files = generate(scenario, won.network, won.objective, won.strategy, options)
    return mission_of(scenario.name, files)


def placed(scenario: Scenario, poses: Optional[Path] = None, computed: bool = False) -> Scenario:
    """The scenario with the poses of a poses.yaml, in which no point is without a pose unless these may be `computed`.

    Robots drive to these poses; computed ones are for simulated robots. Raises PursueError (TRN010).
    """
    if poses is not None:
        scenario = with_poses(scenario, poses)
    missing = [poi for poi in scenario.pois if poi.pose is None]
    if missing and not computed:
        names = ", ".join(poi.name for poi in missing[:_SHOWN]) + (", …" if len(missing) > _SHOWN else "")
        message = f"it is not known where these points are on the robots' map: {names}"
        hint = (
            'write poses behind the points: poi "a" //[x, y, z, qx, qy, qz, qw]; or name a file with --poses '
            "(a workspace's config/poses.yaml shows how it looks); for simulated robots use --computed-poses"
        )
        raise Invalid([error("TRN010", message, missing[0].span, hint)])
    return scenario


def sign(manifest: Manifest, files: Mapping[str, bytes], key: Ed25519PrivateKey) -> bytes:
    """The bundle. Raises PursueError (exit status 2) for a mission that robots would not take."""
    content = pack(manifest, files, key)
    try:
        unpack(content, {fingerprint(key.public_key()): key.public_key()})
    except Refused as problem:
        hint = "robots take at most 64 MiB, and names of at most 100 letters"
        raise PursueError([error("TRN013", f"robots would not take this mission: {problem}", hint=hint)]) from None
    return content


def read_bundle(file: Path, keys: Keys) -> Tuple[bytes, Bundle]:
    """The bundle in a file, and what is in it once all of it is checked. Raises PursueError (exit status 2)."""
    try:
        content = read_start(file, LIMIT)
    except (OSError, ValueError) as problem:
        message = f"cannot read {file}: {reason_of(problem)}"
        hint = "name a bundle, such as my_floor.pursue"
        raise PursueError([error("CLI001", message, hint=hint)]) from None
    try:
        return content, unpack(content, keys)
    except Refused as problem:
        hint = "make it again: pursue-gen bundle SCENARIO.pur"
        if problem.code == "unknown_key":
            hint = "if you trust who signed it, get their .pub file and put it into the folder of keys"
        message = f"{file} is not accepted: {problem}"
        raise PursueError([error("TRN014", message, hint=hint)]) from None
