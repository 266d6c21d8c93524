"""Where a node's data come from: the workspace's own mission, or one that was received; and whose states count."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from pathlib import Path
from typing import Any, Dict, Optional

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.data import DataError, Package
from pursue_runtime.folders import ros_home
from pursue_runtime.manifest import make_manifest, mission_file, mission_id
from pursue_runtime.missions import Missions, own_source
from pursue_runtime.state import SystemState, format_state, older, parse_state
from pursue_runtime.state_checks import StateFilter

DATA = {"bot": b"format: 1\nwhat: bot of %s\n", "observer": b"format: 1\nwhat: observer of %s\n"}


class Robot:
    """A machine: the package bot of a workspace, and a store of missions."""

    def __init__(self, folder: Path, own: bytes = b"own") -> None:
        self.home, self.store = folder / "home", folder / "home" / "pursue" / "missions"
        self.config = folder / "ws" / "bot" / "config"
        self.script = folder / "ws" / "bot" / "scripts" / "bot"
        self.config.mkdir(parents=True)
        (self.config / "plan.yaml").write_bytes(DATA["bot"] % own)
        manifest = make_manifest(own.decode(), "0", ("bot",), {f"{p}/plan.yaml": d % own for p, d in DATA.items()})
        self.own = manifest.digest
        (self.config / "mission.yaml").write_bytes(mission_file(self.own, own.decode()))

    def receive(self, name: str, *packages: str) -> str:
        """A mission comes, with data for these packages; its digest."""
        files = {f"{package}/plan.yaml": DATA[package] % name.encode() for package in packages or DATA}
        manifest = make_manifest(name, "0", ("bot",), files)
        folder = self.store / manifest.digest
        for path, content in files.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(content)
        (folder / "manifest.json").write_bytes(manifest.text())
        return manifest.digest

    def switch(self, digest: object, **more: object) -> None:
        """Another mission is current."""
        self.store.mkdir(parents=True, exist_ok=True)
        aside = self.store / "aside"
        aside.write_text(json.dumps({"format": 1, "current": digest, **more}))
        os.replace(aside, self.store / "state.json")

    def missions(self, received: bool = True) -> Any:
        own = own_source(Package("bot", "example", str(self.script)), "plan.yaml")
        return Missions(own, "bot", str(self.home) if received else "")


@pytest.fixture
def robot(tmp_path: Path) -> Robot:
    return Robot(tmp_path)


def what(source: Any) -> Any:
    return source.read("plan.yaml")["what"]


def test_the_workspaces_own_mission_is_played_where_nothing_was_received(robot: Robot) -> None:
    for missions in (robot.missions(), robot.missions(received=False)):
        source = missions.current()
        assert (source.mission, what(source), source.empty) == (mission_id(robot.own), "bot of own", False)
        assert missions.find("") == source and missions.find(mission_id(robot.own)) == source
    robot.switch("")
    assert what(robot.missions().current()) == "bot of own"


def test_a_workspace_that_does_not_say_which_mission_it_is_has_one_without_a_name(robot: Robot) -> None:
    (robot.config / "mission.yaml").unlink()
    assert robot.missions().current().mission == ""


@pytest.mark.parametrize("text", ["format: 1\nmission: 12\n", "format: 1\n", "what is this", "format: 2\n"])
def test_a_workspaces_name_of_its_mission_is_a_digest(robot: Robot, text: str) -> None:
    (robot.config / "mission.yaml").write_text(text)
    with pytest.raises(DataError, match="generate"):
        robot.missions()


def test_the_current_mission_is_the_one_received_last(robot: Robot) -> None:
    digest = robot.receive("two")
    assert what(robot.missions().current()) == "bot of own", "it was not committed"
    robot.switch(digest)
    source = robot.missions().current()
    assert (source.mission, what(source)) == (mission_id(digest), "bot of two")
    assert what(robot.missions(received=False).current()) == "bot of own"


def test_every_mission_that_is_here_is_found_by_its_id_and_no_other(robot: Robot) -> None:
    first, second = robot.receive("one"), robot.receive("two")
    robot.switch(first)
    (robot.store / f"{second[:12]}.new").mkdir()
    missions = robot.missions()
    assert what(missions.find(mission_id(second))) == "bot of two"
    assert what(missions.find(mission_id(first))) == "bot of one"
    for unknown in ("0" * 12, "..", "../..", second[:11], second, "." * 12, "/" * 12):
        assert missions.find(unknown) is None
    assert robot.missions(received=False).find(mission_id(second)) is None


SENT, CHANGED = "bot of own", "changed by hand"


@pytest.mark.parametrize(("current", "following", "expected"), [
    ("own", None, SENT), ("own", "other", SENT), ("own", "", SENT),
    ("other", None, SENT), ("other", "own", SENT), ("other", "", CHANGED),
    ("", None, CHANGED), ("", "own", CHANGED), ("", "other", CHANGED),
])
def test_what_was_signed_is_played_but_for_a_workspace_that_is_to_play_its_own(
    robot: Robot, current: str, following: Optional[str], expected: str
) -> None:
    """A person has changed the files of the workspace, whose mission came from the desk as well."""
    digests = {"own": robot.receive("own"), "other": robot.receive("other"), "": "", None: None}
    assert digests["own"] == robot.own
    (robot.config / "plan.yaml").write_text(f"format: 1\nwhat: {CHANGED}\n")
    robot.switch(digests[current], next=digests[following])
    missions, name = robot.missions(), mission_id(robot.own)
    assert what(missions.find(name)) == expected
    assert what(missions.current()) == {"own": SENT, "other": "bot of other", "": CHANGED}[current]
    assert what(missions.find("")) == what(robot.missions(received=False).find(name)) == CHANGED
    own, sent = missions.own, robot.missions()._source(robot.own)
    assert missions.moved(name, own if expected == SENT else sent)
    assert not missions.moved(name, sent if expected == SENT else own)
    assert not missions.moved(mission_id(digests["other"] or ""), own), "another mission is not the same one elsewhere"
    assert not robot.missions(received=False).moved(name, own)


def test_the_own_mission_goes_on_where_its_copy_is_removed(robot: Robot) -> None:
    robot.receive("own")
    robot.switch(robot.receive("other"))
    missions = robot.missions()
    shutil.rmtree(robot.store / robot.own)
    assert missions.find(mission_id(robot.own)) == missions.own


def test_nothing_is_taken_for_moved_while_the_store_cannot_be_read(robot: Robot) -> None:
    robot.receive("own")
    robot.switch("what is this")
    missions = robot.missions()
    assert not missions.moved(mission_id(robot.own), missions.own)


def test_a_package_may_have_no_part_in_a_mission(robot: Robot) -> None:
    robot.switch(robot.receive("two", "observer"))
    source = robot.missions().current()
    assert source.empty and not source.has("plan.yaml")
    with pytest.raises(DataError, match=r"has no plan\.yaml for bot"):
        source.read("plan.yaml")


def damage(robot: Robot, digest: str, what: str) -> None:
    folder = robot.store / digest
    if what == "data":
        (folder / "bot" / "plan.yaml").write_text("format: 1\nwhat: changed by hand\n")
    elif what == "no data":
        (folder / "bot" / "plan.yaml").unlink()
    elif what == "manifest":
        (folder / "manifest.json").write_text((folder / "manifest.json").read_text() + " ")
    elif what == "no manifest":
        (folder / "manifest.json").unlink()
    elif what == "folder":
        shutil.rmtree(str(folder))
    else:
        (robot.store / "state.json").write_text(what)


@pytest.mark.parametrize("kind", ["data", "no data", "manifest", "no manifest", "folder", "{", "[]", "{}",
                                  '{"format": 1, "current": "../x"}', '{"format": 1, "current": 7}'])
def test_what_is_damaged_is_reported_and_never_played(robot: Robot, kind: str) -> None:
    digest = robot.receive("two")
    robot.switch(digest)
    damage(robot, digest, kind)
    with pytest.raises(DataError) as problem:
        robot.missions().current().read("plan.yaml")
    assert str(robot.store) in str(problem.value)
    assert ("expected the digest" in str(problem.value)) == ("current" in kind)


def test_a_manifest_that_lists_no_files_is_said_too(robot: Robot) -> None:
    for text in (b'{"format": 1}', b'{"format": 1, "files": 7}'):
        digest = hashlib.sha256(text).hexdigest()
        (robot.store / digest).mkdir(parents=True)
        (robot.store / digest / "manifest.json").write_bytes(text)
        robot.switch(digest)
        with pytest.raises(DataError, match="does not list"):
            robot.missions().current()


def test_a_node_notices_that_another_mission_is_current(robot: Robot) -> None:
    missions = robot.missions()
    missions.current()
    assert not missions.changed(), "there is no store"
    digest = robot.receive("two")
    assert not missions.changed(), "it is not current yet"
    robot.switch("")
    assert missions.changed() and missions.changed()
    missions.current()
    assert not missions.changed()
    robot.switch(digest)
    assert missions.changed() and missions.current().mission == mission_id(digest)
    assert not robot.missions(received=False).changed()


def test_the_store_is_only_read(robot: Robot) -> None:
    robot.switch(robot.receive("two"))
    before = {path: path.stat().st_mtime_ns for path in robot.home.rglob("*")}
    missions = robot.missions()
    what(missions.current()), missions.find("0" * 12), missions.changed()
    assert {path: path.stat().st_mtime_ns for path in robot.home.rglob("*")} == before


def test_ros_home_is_where_ros_has_it() -> None:
    assert ros_home({"ROS_HOME": "/there"}) == "/there"
    assert ros_home({}).endswith(os.path.join("", ".ros"))


# Whose states count ---------------------------------------------------------------------------------------------------

A, B = "a" * 12, "b" * 12


def state(seq: int, stamp: float, mission: str = A, status: str = "running") -> Any:
    return SystemState(seq, stamp, {}, {}, {}, status=status, mission=mission)


def state_filter(mission: str = A, again: bool = False) -> Any:
    return StateFilter(mission, A, again)


def test_only_states_of_its_mission_are_a_nodes_own() -> None:
    assert state_filter().classify(state(1, 1.0)) == "ours"
    assert state_filter().classify(state(1, 1.0, B)) == "other"
    assert state_filter(B).classify(state(1, 1.0)) == "other"


def test_a_state_that_names_no_mission_is_of_the_workspaces_own() -> None:
    assert state_filter().classify(state(1, 1.0, "")) == "ours"
    assert state_filter(B).classify(state(1, 1.0, "")) == "other"
    assert StateFilter("", "").classify(state(1, 1.0, "")) == "ours"
    assert StateFilter("", "").classify(state(1, 1.0, B)) == "other"


def test_a_delayed_state_of_the_mission_before_does_not_bring_it_back() -> None:
    node = state_filter()
    assert node.classify(state(40, 100.0)) == "ours"
    assert node.classify(state(0, 101.0, B, "waiting")) == "other"
    assert node.classify(state(41, 100.5)) == "old"
    node.mission = B
    assert node.classify(state(1, 102.0, B)) == "ours"
    assert node.classify(state(41, 100.5)) == "old"
    assert node.classify(state(41, 101.9, A, "won")) == "old"


class Real:
    """A real clock, in seconds."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.mark.parametrize(("mission", "seq"), [(B, 0), (B, 7), (A, 0)])
def test_an_observer_whose_clock_was_set_back_is_received_again_after_a_minute(mission: str, seq: int) -> None:
    real = Real()
    node = StateFilter(A, A, False, real)
    assert node.classify(state(40, 5000.0, status="won")) == "ours"
    heard = []
    for second in range(1, 64):
        real.now = float(second)
        heard.append(node.classify(state(seq, 1000.0 + second, mission, "waiting")))
        assert node.clock_set_back == (second == 60)
    assert heard == ["old"] * 59 + ["ours" if mission == A else "other"] * 4


def test_while_the_observer_is_received_no_state_is_too_old_to_be_delayed() -> None:
    """Also where its clock was set back while nothing happens: what it says is known then."""
    real = Real()
    node = StateFilter(B, A, False, real)
    assert node.classify(state(3, 5000.0, B)) == "ours"
    for second in range(1, 200):
        real.now = float(second)
        assert node.classify(state(3, 1000.0 + second, B)) == "old"
        assert node.classify(state(40, 999.0, A)) == "old"
    assert node.classify(state(4, 1200.0, B)) == "ours" and not node.clock_set_back


def test_who_comes_after_the_end_waits_for_the_next_mission() -> None:
    node = state_filter(again=True)
    assert [node.classify(state(40, 100.0 + n, status="won")) for n in range(2)] == ["over", "over"]
    assert node.classify(state(0, 103.0, status="waiting")) == "ours"
    assert node.classify(state(2, 104.0, status="stopped")) == "ours", "this end is its own"


def test_who_waits_for_nothing_more_ends_with_the_mission_whenever_it_comes() -> None:
    assert state_filter().classify(state(40, 100.0, status="won")) == "ours"


@given(st.text("0123456789abcdef", max_size=12), st.integers(0, 99), st.sampled_from(("", "a=b mission=x")))
def test_a_states_mission_comes_back_and_is_left_out_where_there_is_none(name: str, plan: int, reason: str) -> None:
    said = SystemState(3, 1.0, {"bot": "a"}, {}, {}, reason=reason, plan=plan, mission=name)
    text = format_state(said)
    assert parse_state(text) == said
    assert ("mission=" in text.partition(" reason=")[0]) == bool(name)


MOMENTS = st.tuples(st.integers(0, 3), st.floats(0, 10), st.sampled_from(("", A, B)))


@given(MOMENTS, MOMENTS)
def test_no_state_is_older_than_one_that_is_older_than_it(first: Any, second: Any) -> None:
    one, two = (state(*moment) for moment in (first, second))
    assert not (older(one, two) and older(two, one))


def test_data_and_name_of_a_mission_of_a_workspace_agree_with_the_generators(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    said: Dict[str, Any] = yaml.safe_load((robot.config / "mission.yaml").read_text())
    assert robot.missions().own.mission == mission_id(said["mission"])
