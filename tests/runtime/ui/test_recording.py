"""What is recorded, in which file, and when a recording would be complete."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Dict, Set

import pytest

from pursue_runtime.model import Model
from pursue_runtime.ui.recording import keep_file, missing_connections, reserve_file, topics
from tests.runtime.models import model_data, mover

MODEL = Model(model_data(mover("bot", "robot", 3), mover("thief", "agent", 3)))


def test_topics_are_named_and_each_stands_once() -> None:
    simulated, real = topics(MODEL, True), topics(MODEL, False)
    assert len(set(simulated)) == len(simulated)
    assert {"pursue/events", "pursue/system_state", "pursue/plan", "/diagnostics"} <= set(real)
    assert set(simulated) - set(real) == {"/clock"}
    assert {"bot/move_base_simple/goal", "bot/pursue/actions"} <= set(real)
    assert not [topic for topic in real if topic.startswith("thief")], "nobody sends it anything"


def test_the_topics_of_a_robot_are_in_its_namespace() -> None:
    other, none = topics(MODEL, False, {"bot": "tb3_0"}), topics(MODEL, False, {"bot": ""})
    assert {"tb3_0/move_base/goal", "tb3_0/pursue/actions"} <= set(other) and "bot/move_base/goal" not in other
    assert {"move_base/goal", "pursue/actions"} <= set(none)


def test_a_bag_goes_where_it_was_asked_for_else_to_the_folder(tmp_path: Path) -> None:
    assert reserve_file("", str(tmp_path / "new")) == str(tmp_path / "new" / "mission.bag")
    asked = str(tmp_path / "other" / "my.bag")
    assert reserve_file(asked, str(tmp_path / "new")) == asked
    mode = stat.S_IMODE(os.stat(asked + ".active").st_mode)
    assert mode & 0o600 == 0o600


def test_nothing_is_ever_overwritten(tmp_path: Path) -> None:
    finished, begun = tmp_path / "mission.bag", tmp_path / "mission-2.bag.active"
    finished.write_text("a mission")
    begun.write_text("another one")
    assert reserve_file("", str(tmp_path)) == str(tmp_path / "mission-3.bag")
    assert reserve_file("", str(tmp_path)) == str(tmp_path / "mission-4.bag")
    assert (finished.read_text(), begun.read_text()) == ("a mission", "another one")


@pytest.fixture(params=["links", "no links"])
def links(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file system with hard links, and one without."""

    def refused(*_: object) -> None:
        raise OSError(errno.EPERM, "Operation not permitted")

    if request.param == "no links":
        monkeypatch.setattr(os, "link", refused)


def begun(folder: Path, content: str) -> str:
    """A bag that was begun."""
    path = reserve_file("", str(folder))
    Path(path + ".active").write_text(content)
    return path


@pytest.mark.usefixtures("links")
def test_what_was_written_gets_the_name_that_was_reserved(tmp_path: Path) -> None:
    path = begun(tmp_path, "a mission")
    assert keep_file(path) == path == str(tmp_path / "mission.bag")
    assert {each.name: each.read_text() for each in tmp_path.iterdir()} == {"mission.bag": "a mission"}


@pytest.mark.usefixtures("links")
@pytest.mark.parametrize("comes", ["file", "link", "folder"])
def test_what_has_come_meanwhile_is_not_replaced(tmp_path: Path, comes: str) -> None:
    path, second = begun(tmp_path, "a mission"), tmp_path / "mission-2.bag"
    meanwhile = Path(path)
    if comes == "file":
        meanwhile.write_text("a person's")
    elif comes == "link":
        meanwhile.symlink_to(tmp_path / "nowhere")
    else:
        meanwhile.mkdir()
    other = begun(tmp_path, "another one's")
    assert other == str(second)
    kept = tmp_path / "mission-3.bag"
    assert keep_file(path) == str(kept) and kept.read_text() == "a mission"
    assert keep_file(other) == other and second.read_text() == "another one's"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["mission-2.bag", "mission-3.bag", "mission.bag"]
    assert meanwhile.is_symlink() if comes == "link" else meanwhile.is_dir() or meanwhile.read_text() == "a person's"


def test_a_bag_that_cannot_be_named_stays_where_it_was_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    path = begun(tmp_path, "a mission")
    monkeypatch.setattr(os, "link", full)
    with pytest.raises(OSError, match="No space"):
        keep_file(path)
    assert [each.read_text() for each in tmp_path.iterdir()] == ["a mission"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(OSError):
        reserve_file("", str(tmp_path))


def test_it_is_complete_when_it_receives_everybody() -> None:
    nodes = ["observer", "bot"]
    publishers: Dict[str, Set[str]] = {"/e": {"/observer", "/bot"}, "/s": {"/observer"}, "/p": set()}

    def missing(connected: Dict[str, int], *more: str, gone: str = "") -> str:
        return missing_connections([*nodes, *more], publishers, connected, lambda name: name == gone)

    assert missing({"/e": 2, "/s": 1}) == ""
    assert missing({"/e": 1, "/s": 1}) == "not connected to everybody on /e yet"
    assert missing({"/e": 2}) == "not connected to everybody on /s yet"
    assert missing({"/e": 2, "/s": 1}, "UI") == "nothing from UI yet"
    publishers["/e"].add("/move_base")
    assert missing({"/e": 2, "/s": 1}) == "not connected to everybody on /e yet"
    assert missing({"/e": 2, "/s": 1}, gone="/move_base") == "", "it was killed, and the master still knows it"
