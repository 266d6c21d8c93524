"""Missions from scenarios: a bundle is the workspace's data and no code. The command `bundle`; poses from a file."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Dict, List, Tuple

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("cryptography", reason="cryptography is not installed")

from pursue_gen.cli.options import DEFAULT_DISTANCE
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.language.scenario import Pose
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.request import SolveRequest, solution_of
from pursue_gen.tools.transport.bundles import make_mission, placed, read_bundle, sign
from pursue_gen.tools.transport.keys import load_private, new_key, public_keys
from pursue_gen.tools.transport.poses_file import read_poses, with_poses
from pursue_gen.workspace.spots import SPOT_DISTANCE
from pursue_runtime.bundle import Bundle, fingerprint
from pursue_runtime.manifest import Manifest, make_manifest, mission_file
from tests.tools.authoring.commands import Outcome, pursue

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
FIRST, THIEF = SCENARIOS / "thesis" / "scenario_1.pur", SCENARIOS / "thesis" / "catch_the_thief.pur"
LOST = """poi "a"
poi "b"
connect a and b distance 3
event "catch" collaborative
agent "bot" controllable mobile 3 location a can_do catch
agent "thief" mobile 1 location b reacts_to catch
reach_objective: do catch after 0
"""
POSES = """format: 1
computed: false
poses:
  "a": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
  b: [1, 2.5, 0, 0, 0, 1, 0]
  c: [-3e0, .5, 0.0, 0.0, 0.0, 0.7071067811865476, 0.7071067811865476]
"""


@pytest.fixture(autouse=True)
def keys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of keys with one in it; the tests work in an empty folder."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    folder = tmp_path / "config" / "pursue" / "keys"
    new_key("lab", folder)
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    return folder


def opened(file: Path, keys: Path) -> Bundle:
    return read_bundle(file, {fingerprint(key): key for key in public_keys(keys)[0].values()})[1]


def bundled(*words: object) -> Outcome:
    """Makes the bundle of a scenario that is solved in no time, with these options."""
    return pursue("bundle", FIRST, "--computed-poses", *words)


def workspace_data(folder: Path) -> Dict[str, bytes]:
    """The data of a workspace's nodes, looked for on the disk."""
    found = {}
    for file in (folder / "src").glob("*/config/*.yaml"):
        if not file.parts[-3].endswith("_bringup") and file.name != "mission.yaml":
            found[f"{file.parts[-3]}/{file.name}"] = file.read_bytes()
    return found


# Bundle and workspace -------------------------------------------------------------------------------------------------

SHAPES: List[Tuple[Path, List[str]]] = [
    (THIEF, []),
    (FIRST, ["--controllers", "centralized"]),
    (FIRST, ["--reach-obj", "bot2", "--reaction", "0.05", "--slack", "bot1=1"]),
    (FIRST, ["--controllers", "general", "--reaction", "0"]),
]


@pytest.mark.parametrize(("scenario", "options"), SHAPES)
def test_a_bundle_is_the_data_of_the_workspace(scenario: Path, options: List[str], keys: Path) -> None:
    done = pursue("bundle", scenario, *options, "--computed-poses")
    assert done.status == 0, done.err
    file, digest = done.out.splitlines()
    assert pursue("ws", scenario, *options, "-o", "ws").status == 0
    bundle = opened(Path(file), keys)
    assert dict(bundle.files) == workspace_data(Path("ws"))
    assert bundle.digest == digest and file == f"{scenario.stem}.pursue"
    packages = {path.split("/")[0] for path in bundle.files}
    assert {"observer", "UI", *bundle.manifest.controllers} == packages
    for package in packages:
        said = Path("ws", "src", package, "config", "mission.yaml").read_bytes()
        assert said == mission_file(digest, scenario.stem)
        assert yaml.safe_load(said) == {"format": 1, "mission": digest, "scenario": scenario.stem}
    others = {file.parts[-3] for file in Path("ws/src").glob("*/config/mission.yaml")}
    assert others == packages


def test_the_options_are_part_of_the_mission() -> None:
    scenario = placed(load(FIRST), computed=True)
    requests = [SolveRequest(reaction=reaction) for reaction in (None, "0.1", "0.05")]
    made = [make_mission(scenario, solution_of(*game_of(scenario), one), one) for one in requests]
    assert len({manifest.digest for manifest, _ in made}) == 2


def test_a_bundle_holds_no_code() -> None:
    assert pursue("bundle", THIEF).status == 0
    with zipfile.ZipFile("catch_the_thief.pursue") as archive:
        for entry in archive.infolist():
            content = archive.read(entry)
            assert entry.filename.endswith((".yaml", ".json")) and not content.startswith(b"#!")
            read = yaml.safe_load(content) if entry.filename.endswith(".yaml") else json.loads(content)
            assert isinstance(read, dict), entry.filename  # safe_load makes no objects
            assert not entry.external_attr >> 16 & 0o111


def test_the_same_key_gives_the_same_file() -> None:
    contents = []
    for name in ("one.pursue", "sub/two.pursue"):
        assert bundled("-o", name).status == 0
        contents.append(Path(name).read_bytes())
    assert contents[0] == contents[1]
    assert str(SCENARIOS).encode() not in contents[0]


def test_a_plan_may_come_from_elsewhere(keys: Path) -> None:
    assert pursue("solve", FIRST, "-o", "plan.txt").status == 0
    done = pursue("bundle", FIRST, "--plan", "plan.txt", "--computed-poses")
    assert done.status == 0 and "plan.txt wins" in done.err
    assert pursue("ws", FIRST, "--plan", "plan.txt", "-o", "ws").status == 0
    assert dict(opened(Path("scenario_1.pursue"), keys).files) == workspace_data(Path("ws"))
    Path("plan.txt").write_text("no plan")
    refused = pursue("bundle", FIRST, "--plan", "plan.txt", "--computed-poses", "-o", "x.pursue")
    assert refused.status == 3 and not Path("x.pursue").exists()


def test_a_mission_that_robots_would_not_take_is_not_written(keys: Path) -> None:
    files = {f"{'p' * 101}/model.yaml": b"x"}
    manifest: Manifest = make_manifest("thief", "1", (), files)
    with pytest.raises(PursueError) as caught:
        sign(manifest, files, load_private("lab", keys))
    assert caught.value.diagnostics[0].code == "TRN013"


# The command ----------------------------------------------------------------------------------------------------------


def told(done: Outcome, status: int, *words: str) -> None:
    assert (done.status, done.out) == (status, ""), done.err
    assert all(word in done.err for word in words), done.err
    assert "internal error" not in done.err
    assert not list(Path().glob("*.pursue"))


def test_the_key_is_looked_for_first(keys: Path) -> None:
    new_key("home", keys)
    told(bundled(), 2, "TRN006", "--key home")
    told(bundled("--key", "nobody"), 2, "TRN002", "home, lab")
    assert bundled("--key", "home").status == 0
    assert opened(Path("scenario_1.pursue"), keys).signed_by == fingerprint(load_private("home").public_key())
    Path("scenario_1.pursue").unlink()
    told(bundled("--keys", "empty"), 2, "TRN002", "keys new")
    assert bundled("--key", keys / "lab.key", "--keys", "empty").status == 0


def test_bad_command_lines() -> None:
    told(pursue("bundle"), 2, "a scenario is missing")
    told(pursue("bundle", THIEF, "-o", "x.pur"), 2, ".pursue")
    told(pursue("bundle", "nothing.pur"), 2, "nothing.pur")
    told(pursue("bundle", THIEF, "--check", "x.pursue"), 2, "leave out SCENARIO")
    told(pursue("bundle", THIEF, "--reaction", "soon"), 2, "the reaction is 'soon'")
    told(pursue("bundle", THIEF, "--plan", "p.txt", "--solver", "verifytga"), 2, "not both")


def test_a_scenario_with_errors_and_one_that_is_lost() -> None:
    Path("wrong.pur").write_text('poi "a"\nconnect a and b distance 3\n')
    told(pursue("bundle", "wrong.pur", "--computed-poses"), 3, "wrong.pur:2:")
    Path("lost.pur").write_text(LOST)
    told(pursue("bundle", "lost.pur", "--computed-poses", "--no-explain"), 4, "SYN021")
    told(pursue("bundle", "lost.pur", "--computed-poses"), 4, "SYN021", "Looking for what would change that")


def test_a_place_that_cannot_be_written() -> None:
    Path("folder.pursue").mkdir()
    done = bundled("-o", "folder.pursue")
    assert (done.status, done.out) == (2, "") and "CLI003" in done.err


# Looking at bundles ---------------------------------------------------------------------------------------------------


def test_a_bundle_is_shown_and_checked(keys: Path, tmp_path: Path) -> None:
    _, digest = bundled().out.splitlines()
    shown = pursue("bundle", "--check", "scenario_1.pursue")
    assert shown.status == 0
    signer = f"lab ({fingerprint(load_private('lab').public_key())})"
    controllers = "controller_bot1, controller_bot2, controllerObj"
    for word in ("scenario_1", digest, digest[:12], controllers, signer):
        assert word in shown.out
    listed = [line.split()[0] for line in shown.out.splitlines() if line.endswith(" bytes")]
    assert set(listed) == set(opened(Path("scenario_1.pursue"), keys).files)
    friend = tmp_path / "friend"
    friend.mkdir()
    unknown = pursue("bundle", "--check", "scenario_1.pursue", "--keys", friend)
    assert (unknown.status, unknown.out) == (2, "") and "TRN014" in unknown.err and ".pub" in unknown.err
    (friend / "them.pub").write_bytes((keys / "lab.pub").read_bytes())
    assert "them (" in pursue("bundle", "--check", "scenario_1.pursue", "--keys", friend).out


@pytest.mark.parametrize("content", [b"", b"junk", b"PK\5\6" + bytes(18), b"\xff" * 100])
def test_what_is_no_bundle_is_reported(content: bytes) -> None:
    Path("x.dat").write_bytes(content)
    told(pursue("bundle", "--check", "x.dat"), 2, "TRN014", "x.dat")


def test_a_bundle_that_was_changed_is_reported() -> None:
    bundled()
    with zipfile.ZipFile("scenario_1.pursue") as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, content in {**files, "observer/model.yaml": b"format: 1\n"}.items():
            archive.writestr(name, content)
    Path("scenario_1.pursue").unlink()
    Path("changed.dat").write_bytes(out.getvalue())
    told(pursue("bundle", "--check", "changed.dat"), 2, "observer/model.yaml is not the file that was signed")
    told(pursue("bundle", "--check", "nothing.dat"), 2, "CLI001")
    told(pursue("bundle", "--check", "."), 2, "CLI001")


# Poses ----------------------------------------------------------------------------------------------------------------


def test_robots_do_not_drive_to_places_that_are_guessed() -> None:
    told(pursue("bundle", FIRST), 3, "TRN010", "a, b, c", "scenario_1.pur:4:", "--poses", "--computed-poses")


def test_poses_from_a_file(keys: Path) -> None:
    Path("lab.yaml").write_text(POSES)
    computed = pursue("bundle", FIRST, "--computed-poses", "-o", "computed.pursue").out.split()[1]
    done = pursue("bundle", FIRST, "--poses", "lab.yaml")
    assert done.status == 0, done.err
    bundle = opened(Path("scenario_1.pursue"), keys)
    assert bundle.digest != computed
    assert bundle.manifest.controllers == ("controller_bot1", "controller_bot2", "controllerObj")
    for package, y in zip((*bundle.manifest.controllers, "UI"), (2.5, 1.7, 2.5, 2.5)):
        data = yaml.safe_load(bundle.files[f"{package}/poses.yaml"])
        assert data["computed"] is False
        assert data["poses"]["b"] == [1.0, y, 0.0, 0.0, 0.0, 1.0, 0.0]  # it looks back: its left side is that of -y
    Path("again.yaml").write_bytes(bundle.files["UI/poses.yaml"])
    assert pursue("bundle", FIRST, "--poses", "again.yaml", "-o", "again.pursue").out.split()[1] == bundle.digest


def test_the_files_poses_come_before_the_scenarios_own(tmp_path: Path) -> None:
    scenario = load(THIEF)
    own = {poi.name: poi.pose for poi in scenario.pois}
    Path("lab.yaml").write_text("poses: {a: [9, 8, 7, 0, 0, 0, 1]}\n")
    placed = {poi.name: poi.pose for poi in with_poses(scenario, Path("lab.yaml")).pois}
    assert placed.pop("a") == Pose(9.0, 8.0, 7.0, 0.0, 0.0, 0.0, 1.0)
    assert placed == {name: pose for name, pose in own.items() if name != "a"}


def test_poses_of_single_robots_come_from_the_file_and_replace_the_scenarios(keys: Path) -> None:
    own = "[5, 6, 0, 0, 0, 0, 1]"
    Path("own.pur").write_text(Path(FIRST).read_text().replace('poi "b"', f'poi "b" //{own} bot1 {own}'))
    Path("lab.yaml").write_text(POSES.replace("format: 1", "format: 2") + f"robots: {{bot2: {{b: {own}}}}}\n")
    place = with_poses(load("own.pur"), Path("lab.yaml")).pois[1]
    assert [(spot.robot.name, spot.pose.x, spot.pose.y) for spot in place.spots] == [("bot2", 5.0, 6.0)]
    assert pursue("bundle", "own.pur", "--poses", "lab.yaml", "--controllers", "centralized").status == 0
    files = opened(Path("own.pursue"), keys).files
    data = yaml.safe_load(files["controller/poses.yaml"])
    assert (data["format"], data["poses"]["b"][:2], data["robots"]["bot2"]["b"][:2]) == (2, [1.0, 2.5], [5.0, 6.0])
    assert list(data["robots"]["bot2"]) == ["a", "b", "c"] and list(data["robots"]) == ["bot2"]


def test_the_spot_distance_is_part_of_the_mission(keys: Path) -> None:
    Path("lab.yaml").write_text(POSES)
    for wrong in ("-1", "nan", "inf", "1e-9", "1000"):
        told(pursue("bundle", FIRST, "--spot-distance", wrong), 2, "--spot-distance", "0.01 to 100")
    assert DEFAULT_DISTANCE == SPOT_DISTANCE
    done = pursue("bundle", FIRST, "--poses", "lab.yaml", "--spot-distance", "0")
    assert done.status == 0 and "WSP007" in done.err and "bot1 and bot2" in done.err
    files = opened(Path("scenario_1.pursue"), keys).files
    assert files["controller_bot2/poses.yaml"].splitlines()[2:] == files["UI/poses.yaml"].splitlines()[2:]


def test_what_the_file_leaves_out_is_still_missing() -> None:
    Path("lab.yaml").write_text(POSES.replace("  b:", "  # b:"))
    told(pursue("bundle", FIRST, "--poses", "lab.yaml"), 3, "TRN010", "map: b")
    assert pursue("bundle", FIRST, "--poses", "lab.yaml", "--computed-poses").status == 0


def test_computed_poses_are_not_taken_for_measured_ones() -> None:
    assert pursue("ws", FIRST, "-o", "ws").status == 0
    done = pursue("bundle", FIRST, "--poses", "ws/src/UI/config/poses.yaml")
    told(done, 2, "TRN011", "poses.yaml:5:11", "not measured")


@pytest.mark.parametrize(
    ("before", "after", "place", "word"),
    [
        ("b: [1,", "bb: [1,", "5:3", "no point 'bb'"),
        ("b: [1,", "b: [one,", "5:7", "expected a number"),
        ("b: [1,", "b: ['1',", "5:7", "expected a number"),
        ("b: [1,", "b: [.nan,", "5:7", "expected a number"),
        ("b: [1,", "b: [.inf,", "5:7", "expected a number"),
        ("b: [1,", "b: [1e9,", "5:7", "farther"),
        ("b: [1,", "b: [1e999,", "5:7", "farther"),
        ("b: [1,", "b: [0, 1,", "5:6", "seven numbers, here are 8"),
        ("b: [1, 2.5, 0, 0, 0, 1, 0]", "b: here", "5:6", "seven numbers, here are none"),
        ("b: [1, 2.5, 0, 0, 0, 1, 0]", "b: [1, 2.5, 0, 0, 0, 0, 0]", "5:18", "length 0.00"),
        ("b: [1, 2.5, 0, 0, 0, 1, 0]", "b: [1, 2.5, 0, 0, 0, 1, 1]", "5:18", "length 1.41"),
        ("b: [1,", "b: [1\n  ,,", "6:4", "not YAML"),
        ("b: [1,", "b: &x [*x,", "5:6", "anchors"),
        ("  b: [1,", '  "a": [1,', "5:3", "twice"),
        ("format: 1", "format: 4", "1:9", "format"),
        (POSES, POSES + "robots: {bot3: {b: [1, 2, 0, 0, 0, 0, 1]}}\n", "7:10", "no robot 'bot3'"),
        (POSES, POSES + "robots: {bot2: {x: [1, 2, 0, 0, 0, 0, 1]}}\n", "7:17", "no point 'x'"),
        (POSES, POSES + "robots: {bot2: {b: [1, 2, 0, 0, 0, 0]}}\n", "7:20", "seven numbers, here are 6"),
        (POSES, POSES + "robots: [bot2]\n", "7:9", "a table of poses for each robot"),
        ("format: 1", "[a]: 1", "1:1", "expected a name"),
        ("format: 1", "speed: 1", "1:1", "'speed' is not known"),
        ("computed: false", "computed: yes", "2:11", "not measured"),
        (POSES, "", "1:1", "no poses"),
        (POSES, "- a\n", "1:1", "format: 1 and poses:"),
        (POSES, "poses: [a]\n", "1:8", "a line for each point"),
        (POSES, "{" * 900, "1:17", "more than 16 levels are nested"),
        (POSES, "poses: \x00\n", "1:1", "not YAML"),
    ],
)
def test_a_wrong_file_of_poses_is_reported_with_its_place(before: str, after: str, place: str, word: str) -> None:
    text = POSES.replace(before, after)
    assert text != POSES
    Path("lab.yaml").write_text(text)
    told(pursue("bundle", FIRST, "--poses", "lab.yaml"), 2, "TRN011", f"lab.yaml:{place}: ", word)


def test_a_file_of_poses_that_cannot_be_read() -> None:
    told(pursue("bundle", FIRST, "--poses", "nothing.yaml"), 2, "CLI001", "nothing.yaml")
    Path("lab.yaml").write_bytes(b"\xff\xfe\xff")
    told(pursue("bundle", FIRST, "--poses", "lab.yaml"), 2, "CLI002", "lab.yaml")


NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)


@given(NUMBERS, NUMBERS, NUMBERS)
def test_numbers_of_every_size_are_read_as_they_are_written(x: float, y: float, z: float) -> None:
    Path("lab.yaml").write_text(f"poses:\n  a: [{x!r}, {y!r}, {z!r}, 0, 0, 0, 1]\n")
    assert read_poses(Path("lab.yaml"), ("a",)).places == {"a": Pose(x, y, z, 0.0, 0.0, 0.0, 1.0)}


@given(st.text(max_size=80))
def test_no_text_gives_anything_but_poses_or_places(text: str) -> None:
    Path("lab.yaml").write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        assert set(read_poses(Path("lab.yaml"), ("a",)).places) <= {"a"}
    except PursueError as problem:
        assert problem.exit_status == 2
