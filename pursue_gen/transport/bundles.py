"""A scenario → its mission, as data that travels; and the file that holds it, signed (a bundle, *.pursue)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Mapping, Optional, Tuple

from pursue_gen.cli.console import show
from pursue_gen.diagnostics import PursueError, error
from pursue_gen.language import load
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.request import Asked, told_solution
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.transport.keys import Ed25519PrivateKey, public_keys  # first: it says what to do without cryptography
from pursue_gen.transport.poses_file import with_poses
from pursue_gen.workspace.context import Options
from pursue_gen.workspace.generate import generate, mission_of
from pursue_runtime.bundle import LIMIT, Bundle, Keys, Manifest, Refused, fingerprint, pack, unpack

SUFFIX = ".pursue"
_SHOWN = 5  # points that a message names


@dataclass(frozen=True)
class AskedMission(Asked):
    """What a person asks for; `poses` is a poses.yaml.

    `computed_poses`: points without a pose get a computed one, for simulated robots.
    """

    poses: Optional[Path] = None
    computed_poses: bool = False


def make_mission(
    read: Scenario, asked: AskedMission = AskedMission(), explained: Optional[Path] = None
) -> Tuple[Manifest, Dict[str, bytes]]:
    """The mission of a scenario, solved and proven as for `ws`: its manifest, and `package/name.yaml` → content.

    It is the same as that of a workspace with the same options; `explained` as for `told_solution`. Raises PursueError:
    what `ws` does, and TRN010 for points without a pose.
    """
    read = _placed(read, asked)
    won = told_solution(translate(read), scenario_objective(read), asked, explained)
    options = Options(asked.controllers, asked.reach_obj, won.reaction, won.rules.ends, won.rules.slack)
    return mission_of(read.name, generate(read, won.network, won.objective, won.strategy, options))


def _placed(read: Scenario, asked: AskedMission) -> Scenario:
    """The scenario with all the poses that are given; robots drive to them, so none may be missing unless allowed."""
    if asked.poses is not None:
        read = with_poses(read, asked.poses)
    missing = [poi for poi in read.pois if poi.pose is None]
    if missing and not asked.computed_poses:
        names = ", ".join(poi.name for poi in missing[:_SHOWN]) + (", …" if len(missing) > _SHOWN else "")
        message = f"it is not known where these points are on the robots' map: {names}"
        hint = (
            'write poses behind the points: poi "a" //[x, y, z, qx, qy, qz, qw]; or name a file with --poses '
            "(a workspace's config/poses.yaml shows how it looks); for simulated robots use --computed-poses"
        )
        raise PursueError([error("TRN010", message, missing[0].span, hint)])
    return read


def sign(manifest: Manifest, files: Mapping[str, bytes], key: Ed25519PrivateKey) -> bytes:
    """The bundle. Raises PursueError (exit status 2) for a mission that robots would not take."""
    content = pack(manifest, files, key)
    try:
        unpack(content, {fingerprint(key.public_key()): key.public_key()})
    except Refused as problem:
        hint = "robots take at most 64 MiB, and names of at most 100 letters"
        raise PursueError([error("TRN013", f"robots would not take this mission: {problem}", hint=hint)], 2) from None
    return content


def bundle_of(
    mission: Path, asked: AskedMission, key: Ed25519PrivateKey, keys: Path, explained: bool = False
) -> Tuple[Manifest, bytes]:
    """The manifest and the bundle of a scenario, signed with the key; or of a bundle's file that this key or one in the
    folder `keys` has signed. `explained`: where the scenario cannot be won, it is told why. Raises PursueError."""
    if mission.name.endswith(SUFFIX):
        known, findings = public_keys(keys)
        show(findings)
        content, found = read_bundle(mission, {fingerprint(one): one for one in (*known.values(), key.public_key())})
        return found.manifest, content
    manifest, files = make_mission(load(mission), asked, mission if explained else None)
    return manifest, sign(manifest, files, key)


def read_bundle(file: Path, keys: Keys) -> Tuple[bytes, Bundle]:
    """The bundle in a file, and what is in it once all of it is checked. Raises PursueError (exit status 2)."""
    try:
        with open(file, "rb") as stream:
            content = stream.read(LIMIT + 1)
    except (OSError, ValueError) as problem:
        message = f"cannot read {file}: {getattr(problem, 'strerror', None) or problem}"
        hint = "name a bundle, such as my_floor.pursue"
        raise PursueError([error("CLI001", message, hint=hint)], exit_status=2) from None
    try:
        return content, unpack(content, keys)
    except Refused as problem:
        hint = "make it again: pursue-gen bundle SCENARIO.pur"
        if problem.code == "unknown_key":
            hint = "if you trust who signed it, get their .pub file and put it into the folder of keys"
        message = f"{file} is not accepted: {problem}"
        raise PursueError([error("TRN014", message, hint=hint)], exit_status=2) from None
