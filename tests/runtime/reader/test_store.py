"""The missions on a robot's disk: completely there or not at all, whatever dies, fills up or is damaged."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import stat
from pathlib import Path
from typing import Any, Dict

import pytest

from pursue_runtime import bundle as mission_bundle
from pursue_runtime import folders
from pursue_runtime.bundle import Bundle, unpack
from pursue_runtime.manifest import mission_file
from pursue_runtime.reader import contents
from pursue_runtime.reader import store as mission_store
from pursue_runtime.reader.contents import StoreError, find_damage, table
from pursue_runtime.reader.store import Store
from tests.runtime.reader_stage import OWN, Crash, Disk, Mission, Robot, mission

FIRST, SECOND, THIRD = mission("first"), mission("second"), mission("third")


@pytest.fixture
def robot(tmp_path: Path) -> Robot:
    made = Robot(tmp_path)
    made.state("waiting")
    return made


def tree(folder: Path) -> Dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def whole(robot: Robot, made: Mission) -> bool:
    return bool(find_damage(robot.store.folder, made.digest) == "")


def test_a_mission_lies_there_as_the_nodes_look_for_it(robot: Robot) -> None:
    robot.send(FIRST)
    files = tree(robot.folder / "missions" / FIRST.digest)
    mark = files.pop("controller_bot1/mission.yaml")
    assert mark == files.pop("observer/mission.yaml") == mission_file(FIRST.digest, "first")
    text, seal = files.pop("manifest.json"), files.pop("signature.json")
    assert files == FIRST.files
    assert mission_bundle.hashlib.sha256(text).hexdigest() == FIRST.digest
    assert b'"signature"' in seal and seal in FIRST.bundle


def test_the_state_names_what_counts_and_only_its_owner_may_look(robot: Robot) -> None:
    robot.send(FIRST)
    robot.order("prepare", SECOND.digest, SECOND.bundle)
    folder = robot.folder / "missions"
    state = json.loads((folder / "state.json").read_text())
    assert state == {"format": 1, "current": FIRST.digest, "next": None, "prepared": SECOND.digest, "history": [OWN]}
    for path in (folder, *folder.rglob("*")):
        assert stat.S_IMODE(path.stat().st_mode) & 0o077 == 0, path


def test_the_last_missions_are_kept_and_older_ones_removed(tmp_path: Path) -> None:
    robot = Robot(tmp_path, keep=2)
    robot.state("waiting")
    sent = [mission(f"number{number}") for number in range(5)]
    for made in sent:
        robot.send(made)
    assert robot.current == sent[4].digest
    assert robot.store.state.history == (sent[2].digest, sent[3].digest)
    assert robot.places == sorted([*(made.digest for made in sent[2:]), "state.json"])


def test_what_is_current_next_or_prepared_is_always_kept(tmp_path: Path) -> None:
    robot = Robot(tmp_path, keep=0)  # as 1: nodes may still play the one before
    robot.state("waiting")
    robot.send(mission("before"))
    robot.send(FIRST)
    robot.state("running", 2)
    robot.send(SECOND)
    robot.order("prepare", THIRD.digest, THIRD.bundle)
    assert {FIRST.digest, SECOND.digest, THIRD.digest} < set(robot.places) and len(robot.places) == 5
    robot.state("won", 3)
    assert robot.places == sorted([FIRST.digest, SECOND.digest, THIRD.digest, "state.json"])


def test_the_missions_outlive_the_process(robot: Robot) -> None:
    robot.send(FIRST)
    robot.state("running", 2)
    robot.send(SECOND)
    before, files = robot.store.state, tree(robot.folder)
    robot.restart()
    assert (robot.store.state, tree(robot.folder)) == (before, files)
    assert before.current == FIRST.digest and before.next == SECOND.digest


def test_two_processes_do_not_change_one_store(robot: Robot) -> None:
    with pytest.raises(StoreError, match="another pursue_reader"):
        Store(robot.store.folder, 5, lambda level, text: None)


# Faults ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("fault", [errno.ENOSPC, errno.EROFS, errno.EIO])
def test_a_disk_that_takes_no_more_changes_nothing(robot: Robot, fault: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """At each place where it can fail; then it works again, and so does the reader."""
    robot.send(FIRST)
    for at in range(100):
        before = robot.store.state
        files = tree(robot.folder)
        disk = Disk(at, fault)
        with monkeypatch.context() as patch:
            patch.setattr(mission_store, "os", disk)
            patch.setattr(folders, "os", disk)
            patch.setattr(mission_store, "shutil", disk)
            answer = robot.order("prepare", SECOND.digest, SECOND.bundle)
        if not disk.reached:
            break
        if not answer.ok:
            assert answer.code == "failed" and "cannot" in answer.message and os.strerror(fault) in answer.message
            assert robot.store.state == before
            assert fault != errno.ENOSPC or tree(robot.folder) == files
            robot.restart()  # what could not be removed is removed now
            assert robot.store.state == before and tree(robot.folder) == files
        else:  # only what makes it safe in a power cut has failed
            assert "power cut" in robot.said
            robot.order("abort", SECOND.digest)
        robot.state("waiting")
    assert at > 10 and answer.ok
    assert whole(robot, FIRST) and whole(robot, SECOND)


def test_wherever_it_is_killed_there_is_a_whole_mission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each place where it changes the disk, while a second mission comes, counts, and an old one is removed."""
    for at in range(200):
        robot = Robot(tmp_path / str(at), keep=1)
        robot.state("waiting")
        robot.send(FIRST)
        robot.send(SECOND)
        disk = Disk(at)
        with monkeypatch.context() as patch:
            patch.setattr(mission_store, "os", disk)
            patch.setattr(folders, "os", disk)
            patch.setattr(mission_store, "shutil", disk)
            with contextlib.suppress(Crash):
                robot.send(THIRD)
        assert robot.current in (SECOND.digest, THIRD.digest)
        for digest in robot.store.kept():
            assert find_damage(robot.store.folder, digest) == "", at
        robot.restart()
        assert not [name for name in robot.places if name.startswith(".new-")]
        for digest in robot.store.kept():
            assert find_damage(robot.store.folder, digest) == "", at
        assert set(robot.store.kept()) == set(robot.store.state.named())
        robot.state("waiting")
        robot.send(THIRD)
        if not disk.reached:
            assert at > 30
            return
    raise AssertionError("it never comes to an end")


def test_a_folder_that_cannot_be_made_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(StoreError, match="cannot keep missions in .*file"):
        Store(str(tmp_path / "file" / "missions"), 5, lambda level, text: None)


@pytest.mark.parametrize("path", ["manifest.json", "controller_bot1/strategy.yaml", "observer/mission.yaml"])
@pytest.mark.parametrize("how", ["changed", "gone", "cut"])
def test_a_damaged_mission_is_not_used(robot: Robot, path: str, how: str) -> None:
    robot.send(FIRST)
    robot.send(SECOND)
    file = robot.folder / "missions" / SECOND.digest / path
    content = file.read_bytes()
    file.unlink() if how == "gone" else file.write_bytes(content[:-1] + (b"!" if how == "changed" else b""))
    robot.restart()
    assert robot.current == FIRST.digest and whole(robot, FIRST)
    assert SECOND.digest not in robot.places
    assert "cannot be used any more" in robot.said and path.split("/")[-1] in robot.said
    robot.state("waiting")
    robot.send(SECOND)
    assert robot.current == SECOND.digest and whole(robot, SECOND)


def test_without_an_earlier_one_the_workspaces_own_takes_the_place_of_a_damaged_mission(robot: Robot) -> None:
    robot.send(FIRST)
    (robot.folder / "missions" / FIRST.digest / "manifest.json").write_text("{}")
    robot.restart()
    assert robot.current == OWN
    assert "mission own counts" in robot.said


def test_a_mission_that_was_damaged_meanwhile_is_sent_again(robot: Robot) -> None:
    robot.send(FIRST)
    robot.send(SECOND)
    (robot.folder / "missions" / FIRST.digest / "observer" / "model.yaml").write_text("")
    refused = robot.order("prepare", FIRST.digest)
    assert (refused.ok, refused.code) == (False, "unknown_mission") and "bundle" in refused.message
    robot.send(FIRST)
    assert robot.current == FIRST.digest and whole(robot, FIRST)


@pytest.mark.parametrize("text", [
    "", "{", "[]", "null", "[" * 100_000, '{"format": 2}', '{"format": 1}', '{"format": 1, "current": "../x"}', "\xff",
    '{"format": 1, "current": "", "next": 7, "prepared": null, "history": []}',
    '{"format": 1, "current": "", "next": null, "prepared": null, "history": ["/etc"]}',
])  # fmt: skip
def test_a_damaged_state_is_reported_and_missions_are_kept(robot: Robot, text: str) -> None:
    robot.send(FIRST)
    robot.send(SECOND)
    (robot.folder / "missions" / "state.json").write_bytes(text.encode("latin-1"))
    robot.restart()
    assert robot.current == OWN
    assert "state.json is damaged" in robot.said
    assert set(robot.store.state.history) == {FIRST.digest, SECOND.digest} == set(robot.store.kept())
    robot.state("waiting")
    assert robot.order("prepare", FIRST.digest).ok and robot.order("commit", FIRST.digest).ok
    assert robot.current == FIRST.digest


@pytest.mark.parametrize("text", [
    b"", b"[]", b"not JSON", b'{"format": 2, "parts": {}}', b'{"format": 1}',
    b'{"format": 1, "scenario": "x", "files": []}',
    b'{"format": 1, "scenario": "x", "files": {"": 1}}',
    b'{"format": 2, "scenario": "x", "controllers": [], "generator": "9", "files": {}}', b"[" * 100000,
])  # fmt: skip
def test_a_mission_of_another_version_does_not_stop_the_reader(robot: Robot, text: bytes) -> None:
    """Its name is the digest of what it says it is, and yet it is nothing that this reader knows."""
    robot.send(FIRST)
    digest = hashlib.sha256(text).hexdigest()
    place = robot.folder / "missions" / digest
    place.mkdir()
    (place / "manifest.json").write_bytes(text)
    robot.store.save(robot.store.state._replace(history=(digest,)))
    robot.restart()
    assert robot.current == FIRST.digest
    assert not robot.order("prepare", digest).ok
    assert robot.current == FIRST.digest


@pytest.mark.parametrize("file", ["strategy.yaml", "manifest.json", "state.json"])
def test_what_cannot_be_read_just_now_is_not_thrown_away(
    robot: Robot, file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No file handle is left, or somebody has changed who may read: that says nothing of the missions."""
    robot.send(FIRST)
    robot.store.close()
    for fault in (errno.EMFILE, errno.EACCES):

        def stutters(path: str, mode: str, fault: int = fault) -> Any:
            if path.endswith(file):
                raise OSError(fault, os.strerror(fault), path)
            return open(path, mode)

        with monkeypatch.context() as patch:
            patch.setattr(contents, "open", stutters, raising=False)
            with pytest.raises(StoreError):
                robot.start()
    robot.start()
    assert robot.current == FIRST.digest and robot.store.is_intact(FIRST.digest)


def test_what_others_put_into_the_store_is_not_followed(robot: Robot, tmp_path: Path) -> None:
    robot.send(FIRST)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "precious").write_text("mine")
    store = robot.folder / "missions"
    (store / SECOND.digest).symlink_to(elsewhere)
    (store / ".new-1").symlink_to(elsewhere)
    (store / "notes").write_text("a person's")
    robot.restart()
    robot.state("waiting")
    robot.send(SECOND)
    assert robot.current == SECOND.digest and whole(robot, SECOND)
    assert tree(elsewhere) == {"precious": b"mine"}
    assert (store / "notes").read_text() == "a person's" and not (store / ".new-1").is_symlink()


@pytest.mark.parametrize("path", ["../outside.yaml", "/tmp/outside.yaml", "a/../../outside.yaml"])
def test_no_name_leads_out_of_the_folder_of_a_mission(robot: Robot, path: str) -> None:
    """unpack lets no such name through; the store does not depend on it."""
    bundle = unpack(FIRST.bundle, robot.reader.keys())
    files: Any = {**bundle.files, path: b"format: 1\n"}
    evil = Bundle(bundle.digest, bundle.manifest, files, bundle.signed_by)
    with pytest.raises(StoreError, match="is not in the folder"):
        robot.store.put(evil, FIRST.bundle, lambda folder: None)
    assert robot.places == []


def test_a_person_sees_what_is_kept(robot: Robot) -> None:
    for made in (FIRST, SECOND):
        robot.send(made)
    robot.order("prepare", THIRD.digest, THIRD.bundle)
    rows = {name: (scenario, what) for name, scenario, what in table(robot.store.folder, "mine")}
    assert rows == {
        "own": ("mine", "the workspace's own; earlier"),
        FIRST.digest[:12]: ("first", "earlier"),
        SECOND.digest[:12]: ("second", "current"),
        THIRD.digest[:12]: ("third", "prepared"),
    }
    nothing = table(str(robot.folder / "nowhere"), "mine")
    assert nothing == [("own", "mine", "the workspace's own; current")]
