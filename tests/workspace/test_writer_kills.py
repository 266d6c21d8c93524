"""The writer is killed at every system call, with a person's edits before and after: nothing of a person's is lost.

A child process ends itself at the n-th call that changes something, for every n, as `kill -9` would.
"""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Iterator, Mapping, Optional, Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from writer_stage import DONE, KILLED, NEW, OLD, PERSON, REFUSED, STRANGE, child, write_until_killed

from pursue_gen.diagnostics import PursueError
from pursue_gen.workspace import writer


def run_killed(files: Mapping[str, bytes], folder: Path, call: int, force: bool = False) -> int:
    """Writes the files in a process that is killed at this call; a file is half written then."""
    return child(write_until_killed, dict(files), folder, call, force)


def put(folder: Path, files: Mapping[str, bytes]) -> None:
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)


def content(folder: Path, path: str) -> Optional[bytes]:
    return (folder / path).read_bytes() if (folder / path).is_file() else None


def tree(folder: Path) -> Dict[str, bytes]:
    """All files, without the manifest."""
    found = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    found.pop(writer.MANIFEST, None)
    return found


def renewed(tmp_path: Path, edits: Mapping[str, bytes], force: bool = False) -> Iterator[Tuple[int, Path, int]]:
    """For each call: its number, a workspace whose renewal was killed there, and how that ended."""
    for call in range(10_000):
        ws = tmp_path / str(call)
        writer.write_tree(OLD, ws)
        put(ws, STRANGE)
        put(ws, edits)
        status = run_killed(NEW, ws, call, force)
        yield call, ws, status
        if status != KILLED:
            return
    raise AssertionError("it never ends")


def test_a_renewal_that_is_killed_leaves_old_files_and_new_ones(tmp_path: Path) -> None:
    for call, ws, status in renewed(tmp_path, {}):
        for path in {*OLD, *NEW}:
            assert content(ws, path) in (OLD.get(path), NEW.get(path)), (call, path)
        writer.write_tree(NEW, ws)
        assert tree(ws) == {**NEW, **STRANGE}, call
        assert status in (KILLED, DONE)
    assert call > 40


@pytest.mark.parametrize("path", ["README.md", "src/gone/x.yaml", "src/new/deep/y.yaml"])
def test_an_edit_before_stops_it_and_nothing_is_changed(tmp_path: Path, path: str) -> None:
    for call, ws, status in renewed(tmp_path, {path: PERSON}):
        assert tree(ws) == {**OLD, **STRANGE, path: PERSON}, call
        assert status in (KILLED, REFUSED)


@pytest.mark.parametrize("path", ["README.md", "src/gone/x.yaml", "src/new/deep/y.yaml"])
def test_an_edit_after_the_kill_is_kept_and_reported(tmp_path: Path, path: str) -> None:
    for call, ws, _ in renewed(tmp_path, {}):
        before = {**tree(ws), path: PERSON}
        put(ws, {path: PERSON})
        if path in NEW or path in tree(ws):
            try:
                writer.write_tree(NEW, ws)
            except PursueError as problem:
                assert any(str(ws / path) in finding.message for finding in problem.diagnostics)
                assert tree(ws) == before, call
            else:  # by then it was no file of ours, and none that is to be written
                assert path not in NEW
        assert content(ws, path) == PERSON, call
        writer.write_tree(NEW, ws, force=True)
        assert {**tree(ws), path: b""} == {**NEW, **STRANGE, path: b""}, call


@pytest.mark.parametrize("path", ["README.md", "src/gone/x.yaml"])
def test_what_was_forced_once_is_asked_again_after_a_kill(tmp_path: Path, path: str) -> None:
    """A person's file that a forced run would have replaced is still a person's."""
    for call, ws, status in renewed(tmp_path, {path: PERSON}, force=True):
        if status == KILLED and content(ws, path) == PERSON:
            with pytest.raises(PursueError, match=path):
                writer.write_tree(NEW, ws)
            assert content(ws, path) == PERSON, call
        writer.write_tree(NEW, ws, force=True)
        assert tree(ws) == {**NEW, **STRANGE}, call


def test_another_scenario_may_follow_a_kill(tmp_path: Path) -> None:
    third = {"README.md": b"third\n", "src/third": b"3\n"}
    for call, ws, _ in renewed(tmp_path, {}):
        writer.write_tree(third, ws)
        written = {path: file for path, file in tree(ws).items() if not path.startswith(".pursue_gen-")}
        strange = {path: file for path, file in STRANGE.items() if not path.startswith(".pursue_gen-")}
        assert written == {**third, **strange}, call
        left = {path: file for path, file in tree(ws).items() if path.startswith(".pursue_gen-")}
        left.pop(".pursue_gen-0/x")  # a person's
        # At most one file cannot be proven to be ours: the one that was half written.
        assert len(left) <= 1, call


def test_a_first_run_that_is_killed_leaves_no_workspace(tmp_path: Path) -> None:
    for call in range(10_000):
        ws = tmp_path / str(call) / "ws"
        ws.parent.mkdir()
        put(ws.parent, {".ws.pursue_gen-0/README.md": PERSON, ".ws.pursue_gen.new/x": PERSON})
        status = run_killed(NEW, ws, call)
        assert not ws.exists() or tree(ws) == NEW, call
        writer.write_tree(NEW, ws)
        assert tree(ws) == NEW, call
        assert sorted(path.name for path in ws.parent.iterdir()) == [".ws.pursue_gen-0", ".ws.pursue_gen.new", "ws"]
        assert content(ws.parent, ".ws.pursue_gen-0/README.md") == PERSON
        if status == DONE:
            break
    assert call > 15


NAMES = st.sampled_from(["a", "b", "c/a", "c/b", "c/d/a"])
TREES = st.dictionaries(NAMES, st.sampled_from([b"", b"1", b"22", b"#!3"]), max_size=5)
EDITS = st.dictionaries(NAMES, st.just(PERSON), max_size=2)


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(old=TREES, new=TREES, last=TREES, call=st.integers(0, 80), before=EDITS, after=EDITS)
def test_nothing_of_a_persons_is_lost_whatever_happens(
    tmp_path_factory: pytest.TempPathFactory,
    old: Dict[str, bytes],
    new: Dict[str, bytes],
    last: Dict[str, bytes],
    call: int,
    before: Dict[str, bytes],
    after: Dict[str, bytes],
) -> None:
    ws = tmp_path_factory.mktemp("any") / "ws"
    writer.write_tree(old, ws)
    put(ws, before)
    run_killed(new, ws, call)
    assert all(content(ws, path) == PERSON for path in before)
    for path in {*old, *new} - set(before):
        assert content(ws, path) in (old.get(path), new.get(path))
    put(ws, after)
    edits = {**before, **after}
    try:
        writer.write_tree(last, ws)
    except PursueError:
        assert edits
    else:
        assert {path: file for path, file in tree(ws).items() if path in last} == last
    assert all(content(ws, path) == PERSON for path in edits)
