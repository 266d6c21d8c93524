"""A workspace is written completely or not at all, and never over what a person wrote."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Dict

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.workspace import writer

FILES = {
    "README.md": b"read me\n",
    "src/a/package.xml": b"<package/>\n",
    "src/a/scripts/node": b"#!/usr/bin/env python3\n",
}


def tree(folder: Path) -> Dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name != writer.MANIFEST
    }


def test_a_new_workspace_holds_the_files_and_nothing_else(tmp_path: Path) -> None:
    writer.write_tree(FILES, tmp_path / "deep" / "ws")
    assert tree(tmp_path / "deep" / "ws") == FILES
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["ws"]


def test_nodes_can_be_executed_and_data_cannot(tmp_path: Path) -> None:
    writer.write_tree(FILES, tmp_path / "ws")
    assert os.access(tmp_path / "ws/src/a/scripts/node", os.X_OK)
    assert not (tmp_path / "ws/README.md").stat().st_mode & 0o111


def test_the_same_again_changes_nothing(tmp_path: Path) -> None:
    writer.write_tree(FILES, tmp_path / "ws")
    manifest = (tmp_path / "ws" / writer.MANIFEST).read_bytes()
    writer.write_tree(FILES, tmp_path / "ws")
    assert tree(tmp_path / "ws") == FILES
    assert (tmp_path / "ws" / writer.MANIFEST).read_bytes() == manifest


def test_generated_files_are_renewed_and_those_no_longer_needed_go(tmp_path: Path) -> None:
    ws = tmp_path / "ws"
    writer.write_tree({**FILES, "src/b/scripts/node.py": b"#!old", "src/b/package.xml": b"b"}, ws)
    (ws / "src/b/scripts/__pycache__").mkdir()
    (ws / "src/b/scripts/__pycache__/node.cpython-38.pyc").write_bytes(b"")
    new = {**FILES, "README.md": b"new\n"}
    writer.write_tree(new, ws)
    assert tree(ws) == new
    assert not (ws / "src/b").exists()


@pytest.mark.parametrize("path", ["README.md", "src/a/scripts/node"])
@pytest.mark.parametrize("still_part", [True, False])
def test_an_edited_file_stops_everything_before_anything_changes(tmp_path: Path, path: str, still_part: bool) -> None:
    ws = tmp_path / "ws"
    writer.write_tree(FILES, ws)
    (ws / path).write_bytes(b"edited by hand")
    before = tree(ws)
    new = dict.fromkeys((name for name in FILES if still_part or name != path), b"new")
    with pytest.raises(PursueError) as caught:
        writer.write_tree(new, ws)
    assert tree(ws) == before
    (finding,) = caught.value.diagnostics
    assert str(ws / path) in finding.message and "--force" in finding.hint
    writer.write_tree(new, ws, force=True)
    assert tree(ws) == new


def test_a_file_that_is_not_ours_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "README.md").write_bytes(b"my notes")
    with pytest.raises(PursueError, match="README.md"):
        writer.write_tree(FILES, tmp_path)
    assert tree(tmp_path) == {"README.md": b"my notes"}


def test_what_is_in_the_way_as_a_folder_or_as_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "README.md").mkdir()
    (tmp_path / "src").write_bytes(b"a file")
    with pytest.raises(PursueError) as caught:
        writer.write_tree(FILES, tmp_path)
    said = "\n".join(d.message for d in caught.value.diagnostics)
    assert "README.md" in said and str(tmp_path / "src") in said
    writer.write_tree(FILES, tmp_path, force=True)
    assert tree(tmp_path) == FILES


@pytest.mark.parametrize("force", [True, False])
def test_build_folders_and_the_users_packages_stay(tmp_path: Path, force: bool) -> None:
    ws = tmp_path / "ws"
    writer.write_tree(FILES, ws)
    foreign = {f"{folder}/x": b"mine" for folder in ("src/mine", "src/a", "build", "devel", "install")}
    for path, content in foreign.items():
        (ws / path).parent.mkdir(parents=True, exist_ok=True)
        (ws / path).write_bytes(content)
    writer.write_tree({"README.md": b"new"}, ws, force)
    assert tree(ws) == {"README.md": b"new", **foreign}


def test_a_failure_leaves_nothing_half(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(handle: int, data: bytes) -> int:
        raise OSError(28, "No space left on device")

    writer.write_tree(FILES, tmp_path / "old")
    monkeypatch.setattr(os, "write", full)
    for folder in (tmp_path / "old", tmp_path / "new"):
        with pytest.raises(PursueError, match=rf"{folder.name}.*/{writer.MANIFEST}: No space left"):
            writer.write_tree(dict.fromkeys(FILES, b"other"), folder)
    monkeypatch.undo()
    assert [p.name for p in tmp_path.iterdir()] == ["old"]
    assert tree(tmp_path / "old") == FILES


def test_a_manifest_from_elsewhere_cannot_make_us_remove_other_files(tmp_path: Path) -> None:
    ws = tmp_path / "ws"
    writer.write_tree(FILES, ws)
    (tmp_path / "precious").write_bytes(b"")
    empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    (ws / writer.MANIFEST).write_text(json.dumps({"files": {"../precious": empty, str(tmp_path / "precious"): empty}}))
    writer.write_tree(FILES, ws)
    assert (tmp_path / "precious").exists()


NAMES = st.text("abc", min_size=1, max_size=2)
TREES = st.dictionaries(st.builds("{}/{}".format, NAMES, NAMES), st.binary(max_size=3), max_size=5)


@given(old=TREES, new=TREES)
def test_one_generated_tree_replaces_another_whatever_they_hold(
    tmp_path_factory: pytest.TempPathFactory, old: Dict[str, bytes], new: Dict[str, bytes]
) -> None:
    ws = tmp_path_factory.mktemp("any") / "ws"
    writer.write_tree(old, ws)
    writer.write_tree(new, ws)
    assert tree(ws) == new
    assert {p.name for p in ws.iterdir()} == {path.split("/")[0] for path in new} | {writer.MANIFEST}
