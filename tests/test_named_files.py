"""Whatever file a person names: a device, a pipe, or a file without end is refused, soon and in little memory."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import threading
import traceback
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Dict, List, Optional

import pytest

pytest.importorskip("cryptography", reason="cryptography is not installed")

from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing.floor import read_image
from pursue_gen.drawing.floor_picture import read_floor
from pursue_gen.files import read_text
from pursue_gen.language.formatter import layout_of
from pursue_gen.solving.inputs import load_game
from pursue_gen.tools.draw.storage import version
from pursue_gen.tools.replay import read_recording
from pursue_gen.tools.replay.game import from_workspace
from pursue_gen.tools.transport.bundles import read_bundle
from pursue_gen.tools.transport.keys import load_private, load_public
from pursue_gen.tools.transport.poses_file import read_poses
from pursue_gen.tools.transport.robots_file import read_robots
from pursue_gen.workspace.machines import read_machines
from pursue_runtime.bundle import read_keys
from pursue_runtime.data import DataError, read_data
from pursue_runtime.ui.environment import TraceError, make_player
from pursue_runtime.ui.options import Options

ROOT = Path(__file__).resolve().parents[1]
PATIENCE = 300


def certificate(file: Path) -> None:
    robots = file.with_name("robots.yaml")
    robots.write_text(f"format: 1\nrobots:\n  bot1: {{host: bot1, tls: true, ca: {file.name}}}\n", encoding="utf-8")
    read_robots(robots)


def image(file: Path) -> None:
    settings = file.with_name("map.yaml")
    settings.write_text(f"image: {file.name}\nresolution: 1\norigin: [0, 0, 0]\n", encoding="utf-8")
    read_floor(settings)


def trusted(file: Path) -> None:
    os.symlink(file, file.with_name("lab.pub"))
    _, problems = read_keys(str(file.parent))
    if problems:
        raise DataError(problems[0])


def public(file: Path) -> None:
    os.symlink(file, file.with_name("lab.pub"))
    load_public("lab", file.parent)


def player(file: Path) -> None:
    model: Any = SimpleNamespace(automata=())
    make_player(Options("trace", str(file), 0, True, 1.0, (), 1.0, False), model)


def game(file: Path) -> None:
    folder = file.with_name("ws") / "src" / "observer" / "config"
    folder.mkdir(parents=True)
    os.symlink(file, folder / "game.yaml")
    from_workspace(file.with_name("ws"))


READERS: Dict[str, Callable[[Path], object]] = {
    "a text": lambda file: read_text(file, "a plan"),
    "fmt": lambda file: layout_of(str(file)),
    "a version": version,
    "map.yaml": read_floor,
    "a map's image": image,
    "an image": read_image,
    "a recording": read_recording,
    "a workspace's game": game,
    "a network": lambda file: load_game([file, file]),
    "a bundle": lambda file: read_bundle(file, {}),
    "a private key": lambda file: load_private(str(file)),
    "a public key": public,
    "a trusted key": trusted,
    "poses": lambda file: read_poses(file, ("a",)),
    "robots": read_robots,
    "machines": lambda file: read_machines(file, ()),
    "a certificate": certificate,
    "data": lambda file: read_data(str(file)),
    "a trace": lambda file: player(file),
}
REFUSALS = (PursueError, DataError, TraceError)


def give_back(problem: Optional[BaseException]) -> None:
    """Gives back the megabytes of what was read, which frames of an error hold, in a cycle, for many tests to come."""
    if problem is not None:
        traceback.clear_frames(problem.__traceback__)
        give_back(problem.__cause__ or problem.__context__)


def refused(work: Callable[[], object]) -> str:
    """Why it is refused; fails where it does not end."""
    found: List[BaseException] = []

    def run() -> None:
        try:
            work()
        except BaseException as problem:
            found.append(problem)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(PATIENCE)
    assert not thread.is_alive(), "it hangs"
    (problem,) = found
    give_back(problem)
    assert isinstance(problem, REFUSALS), repr(problem)
    if isinstance(problem, PursueError):
        (finding, *_) = problem.diagnostics
        assert finding.hint and problem.exit_status == 2
    return str(problem)


def endless(folder: Path, kind: str) -> Path:
    """Something that cannot be read to its end, or not soon."""
    file = folder / "named.txt"
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "device":
        file.symlink_to("/dev/zero")
    else:
        with open(file, "wb") as stream:
            stream.truncate(8 << 30)
        file.chmod(0o600)
    return file


@pytest.mark.parametrize("kind", ["pipe", "device", "large"])
@pytest.mark.parametrize("reader", READERS)
def test_what_has_no_end_is_refused(tmp_path: Path, reader: str, kind: str) -> None:
    file = endless(tmp_path, kind)
    message = refused(lambda: READERS[reader](file))
    expected = {"pipe": "a pipe", "device": "a device", "large": "large|bytes|not a private key"}
    assert re.search(f"{expected[kind]}|no file|not a file|holds no game", message), message


def test_stdin_is_read_as_far_as_a_scenario_goes() -> None:
    with open("/dev/zero", "rb") as zeros:
        done = subprocess.run(
            [sys.executable, "-m", "pursue_gen", "fmt", "-"], stdin=zeros, capture_output=True, text=True,
            timeout=PATIENCE, cwd=ROOT, check=False,
        )  # fmt: skip
    assert done.returncode == 2 and "PML002" in done.stderr, done.stderr


@pytest.mark.parametrize("words", [["new", "x.pur"], ["play", str(ROOT / "scenarios" / "thesis" / "scenario_1.pur")]])
def test_a_line_without_end_is_no_answer(tmp_path: Path, words: List[str]) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with open("/dev/zero", "rb") as zeros:
        done = subprocess.run(
            [sys.executable, "-m", "pursue_gen", *words], stdin=zeros, capture_output=True, text=True, timeout=PATIENCE,
            cwd=tmp_path, env=environment, check=False,
        )  # fmt: skip
    assert done.returncode == 2 and "its line does not end" in done.stderr, done.stderr
    assert not list(tmp_path.iterdir())


OTHERS = {
    "pursue_gen/cli/explain.py": "pages of the package",
    "pursue_gen/tools/commands/report.py": "the beginning of a page that it replaces",
    "pursue_gen/tools/draw/server.py": "the page's own files",
    "pursue_gen/language/syntax.py": "the grammar",
    "pursue_gen/tools/report/html.py": "the package's styles",
    "pursue_gen/solving/verifytga.py": "what it has let a program write",
    "pursue_gen/synthesis/limits.py": "facts of the system",
    "pursue_gen/workspace/folder.py": "files of a workspace, opened in its folder",
    "pursue_gen/workspace/packages.py": "the package's templates",
    "pursue_runtime/missions.py": "the robot's own store of missions",
    "pursue_runtime/named_files.py": "the reader",
    "pursue_runtime/nodes/mission_test.py": "the workspace's own test",
    "pursue_runtime/nodes/node.py": "facts of the system",
    "pursue_runtime/observer/records.py": "the observer's own journal, and its mark",
    "pursue_runtime/reader/contents.py": "the robot's own store of missions",
    "pursue_runtime/ui/floor.py": "the workspace's own picture",
    "pursue_runtime/ui/verdict.py": "a file of two lines, for another of our programs",
    "pursue_runtime/ui/web.py": "the page's own files",
}
"""Who else reads files, and which."""


def is_reading(node: ast.AST) -> bool:
    """True for a call that opens a file to read it."""
    if not isinstance(node, ast.Call):
        return False
    modes = [argument.value for argument in node.args if isinstance(argument, ast.Constant)]
    if isinstance(node.func, ast.Name):
        return node.func.id == "open" and not {"w", "wb"} & set(modes)
    return isinstance(node.func, ast.Attribute) and node.func.attr in ("read_text", "read_bytes") and not node.args


def test_there_is_one_reader_of_files_that_are_named() -> None:
    found = set()
    for file in (*(ROOT / "pursue_gen").rglob("*.py"), *(ROOT / "pursue_runtime").rglob("*.py")):
        if any(map(is_reading, ast.walk(ast.parse(file.read_text(encoding="utf-8"))))):
            found.add(file.relative_to(ROOT).as_posix())
    assert found == set(OTHERS)
