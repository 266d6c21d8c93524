"""The writer follows no link, wherever one was planted, and whenever."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Dict

import pytest
from writer_stage import DONE, NEW, OLD, REFUSED, child, write_over_planted_link

from pursue_gen.diagnostics import PursueError
from pursue_gen.workspace import writer

FOREIGN = {**OLD, "x.yaml": b"goes\n", "node.py": b"#!old\n", "notes": b"precious\n", "a/node.py": b"#!old\n",
           "node.cpython-38.pyc": b"compiled\n", "m.json": b'{"files": {}}\n'}  # fmt: skip
"""A person's folder elsewhere: some files in it are like ours."""

PLACES = {
    "the workspace": "ws",
    "a stage beside it": ".ws.pursue_gen-0",
    "an earlier version's stage beside it": ".ws.pursue_gen.new",
    "a stage in it": "ws/.pursue_gen-0",
    "an earlier version's stage in it": "ws/.pursue_gen.new",
    "the manifest": "ws/.pursue_gen.json",
    "a file": "ws/README.md",
    "a folder of files": "ws/src",
    "a folder in it": "ws/src/a",
    "a folder whose files go": "ws/src/gone",
    "a file that goes": "ws/src/gone/x.yaml",
    "a folder that comes": "ws/src/new",
    "compiled Python": "ws/src/a/__pycache__",
}
TARGETS = {"a folder": "", "a file": "README.md", "a manifest": "m.json", "nothing": "missing"}


def snapshot(folder: Path) -> Dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def stage(tmp_path: Path) -> Path:
    """A workspace, and the folder of a person beside it."""
    for path, content in FOREIGN.items():
        (tmp_path / "foreign" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "foreign" / path).write_bytes(content)
    writer.write_tree(OLD, tmp_path / "ws")
    return tmp_path / "foreign"


def plant(place: Path, target: Path) -> None:
    """A link instead of whatever is there."""
    if place.is_dir() and not place.is_symlink():
        shutil.rmtree(place)
    elif os.path.lexists(place):
        place.unlink()
    place.parent.mkdir(parents=True, exist_ok=True)
    place.symlink_to(target)


@pytest.mark.parametrize("force", [False, True])
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("place", PLACES)
def test_no_planted_link_is_followed(tmp_path: Path, place: str, target: str, force: bool) -> None:
    foreign = stage(tmp_path)
    link = tmp_path / PLACES[place]
    plant(link, foreign / TARGETS[target])
    new = {path: content for path, content in NEW.items() if "node.py" not in path} if "Python" in place else NEW
    try:
        writer.write_tree(new, tmp_path / "ws", force)
    except PursueError as problem:
        assert any(str(tmp_path / "ws") in finding.message for finding in problem.diagnostics)
        assert not force or place == "the workspace"
        assert os.path.islink(str(link))
    else:
        assert {path: (tmp_path / "ws" / path).read_bytes() for path in new} == new
        assert not any(path.is_symlink() for path in (tmp_path / "ws" / name for name in (*new, "src", "src/a")))
    assert snapshot(foreign) == FOREIGN


@pytest.mark.parametrize("place", ["a folder of files", "a folder in it", "a folder whose files go", "a file"])
def test_a_link_that_is_planted_while_it_writes_is_not_followed(tmp_path: Path, place: str) -> None:
    for number in range(10_000):
        home = tmp_path / str(number)
        foreign = stage(home)
        status = child(write_over_planted_link, NEW, home / "ws", number, home / PLACES[place], foreign)
        assert snapshot(foreign) == FOREIGN, number
        assert status in (DONE, REFUSED)
        if status == DONE and not os.path.islink(str(home / PLACES[place])):
            return
    raise AssertionError("it never ends")
