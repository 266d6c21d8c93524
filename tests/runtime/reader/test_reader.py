"""Which orders count on a robot, once, and that a mission is never exchanged under another one that runs."""

from __future__ import annotations

import base64
import json
import shutil
import threading
from pathlib import Path
from typing import Any, Set

import pytest

from pursue_gen.workspace.generate import mission_of
from pursue_runtime import bundle as pursue_guard
from pursue_runtime.bundle import KeyFolder, read_keys
from pursue_runtime.manifest import make_manifest, mission_id
from tests import waiting
from tests.runtime.reader_stage import (
    DESK,
    OWN,
    PATIENCE,
    POSES,
    STRANGER,
    STRATEGY,
    Robot,
    desk_bundle,
    message,
    mission,
)
from tests.workspace.worlds import files as workspace_files

FIRST, SECOND, THIRD = mission("first"), mission("second"), mission("third")
LIVE, IDLE = ["running", "holding"], ["waiting", "won", "lost", "stopped"]


@pytest.fixture
def robot(tmp_path: Path) -> Robot:
    made = Robot(tmp_path)
    made.state("waiting")
    return made


def files(robot: Robot) -> Set[str]:
    return {path.as_posix() for path in (robot.folder / "missions").rglob("*")}


# Orders that count ----------------------------------------------------------------------------------------------------


def test_a_mission_is_prepared_and_then_counts(robot: Robot) -> None:
    prepared = robot.order("prepare", FIRST.digest, FIRST.bundle)
    assert (prepared.ok, prepared.code) == (True, "prepared")
    assert robot.current == OWN and robot.reader.status()["prepared"] == FIRST.digest
    committed = robot.order("commit", FIRST.digest)
    assert (committed.ok, committed.code) == (True, "committed")
    status = robot.reader.status()
    assert (status["current"], status["next"], status["prepared"]) == (FIRST.digest, None, None)
    assert status["scenario"] == "first" and status["kept"] == [FIRST.digest] and status["history"] == [OWN]


def test_the_status_says_what_the_desk_has_to_know(robot: Robot) -> None:
    status = robot.reader.status()
    assert status == {
        "format": 1, "robot": "bot1", "ticket": robot.reader.ticket, "current": OWN, "next": None, "prepared": None,
        "kept": [], "history": [], "scenario": "own_scenario", "packages": ["controller_bot1"], "mission_runs": False,
        "limit": 10**6, "answer": None,
    }  # fmt: skip
    answer = robot.order("commit", FIRST.digest)
    told = robot.reader.status()
    said = {"ticket": status["ticket"], "ok": False, "code": "not_prepared", "message": answer.message}
    assert told["answer"] == said
    assert json.loads(json.dumps(told)) == told and told["ticket"] != status["ticket"]


def test_an_earlier_mission_is_called_back_without_its_bundle(robot: Robot) -> None:
    robot.send(FIRST)
    robot.send(SECOND)
    for digest in (FIRST.digest, OWN, SECOND.digest):
        assert robot.order("prepare", digest).ok and robot.order("commit", digest).ok
        assert robot.current == digest
    assert robot.store.state.history == (FIRST.digest, OWN)


def test_what_is_so_already_is_fine(robot: Robot) -> None:
    robot.send(FIRST)
    for _ in range(2):
        assert robot.order("commit", FIRST.digest).ok
        assert robot.order("prepare", FIRST.digest).ok
        assert robot.order("prepare", SECOND.digest, SECOND.bundle).ok
    assert robot.order("abort", SECOND.digest).ok and robot.order("abort", SECOND.digest).ok
    assert robot.order("commit", SECOND.digest).code == "not_prepared"
    assert robot.current == FIRST.digest and robot.store.state.history == (OWN,)


def test_only_what_was_prepared_counts(robot: Robot) -> None:
    robot.send(FIRST)
    robot.send(SECOND)
    assert robot.order("commit", FIRST.digest).code == "not_prepared"
    assert robot.order("prepare", THIRD.digest).code == "unknown_mission"
    assert robot.current == SECOND.digest


def test_a_bundle_of_the_largest_size_is_taken_and_no_larger_one(robot: Robot) -> None:
    robot.reader.robot = robot.reader.robot._replace(limit=len(FIRST.bundle))
    assert robot.order("prepare", FIRST.digest, FIRST.bundle).ok
    robot.reader.robot = robot.reader.robot._replace(limit=len(SECOND.bundle) - 1)
    assert robot.order("prepare", SECOND.digest, SECOND.bundle).code == "too_large"


# Orders that do not ---------------------------------------------------------------------------------------------------


def test_an_order_counts_once(robot: Robot) -> None:
    text = message("prepare", FIRST.digest, robot.reader.ticket, FIRST.bundle)
    assert robot.reader.on_message(text, robot.now).ok
    done = robot.reader.answer
    robot.order("abort", FIRST.digest)
    again = robot.reader.on_message(text, robot.now)
    assert (again.ok, again.code) == (False, "old_ticket")
    assert robot.reader.status()["prepared"] is None and done.ok
    robot.restart()
    assert robot.reader.on_message(text, robot.now).code == "old_ticket"


def test_an_order_that_is_refused_has_used_its_ticket_too(robot: Robot) -> None:
    text = message("commit", FIRST.digest, robot.reader.ticket)
    assert robot.reader.on_message(text, robot.now).code == "not_prepared"
    robot.order("prepare", FIRST.digest, FIRST.bundle)
    assert robot.reader.on_message(text, robot.now).code == "old_ticket"
    assert robot.current == OWN


def refused(robot: Robot, text: str, code: str) -> None:
    """It is refused with this word, and nothing is changed, not even what the status says."""
    before, there = robot.reader.status(), files(robot)
    answer = robot.reader.on_message(text, robot.now)
    assert (answer.ok, answer.code) == (False, code), answer
    assert (robot.reader.status(), files(robot)) == (before, there)
    assert answer.message


def test_orders_of_strangers_and_for_others_are_refused(robot: Robot) -> None:
    ticket = robot.reader.ticket
    refused(robot, message("prepare", FIRST.digest, ticket, FIRST.bundle, signer=STRANGER), "unknown_key")
    refused(robot, message("prepare", FIRST.digest, ticket, FIRST.bundle, robot="bot2"), "wrong_robot")
    refused(robot, message("prepare", FIRST.digest, "0" * 32, FIRST.bundle), "old_ticket")
    order = json.loads(message("prepare", FIRST.digest, ticket))["order"]
    _, who, seal = order.split(".")
    other = json.loads(message("commit", FIRST.digest, ticket))["order"].split(".")[0]
    refused(robot, json.dumps({"order": f"{other}.{who}.{seal}"}), "bad_signature")


@pytest.mark.parametrize("text", [
    "", "{}", "null", "7", '"order"', "[]", '{"order": 7}', '{"order": "a.b.c"}', '{"order": null, "bundle": ""}',
    "[" * 100_000, '{"a":' * 1000, '{"order": ' + "[0," * 10_000, "\x00\xff", '{"order": "' + "x" * 10_000 + '"}',
    "import os; os.system('reboot')  # controller",
])  # fmt: skip
def test_junk_is_refused(robot: Robot, text: str) -> None:
    refused(robot, text, "bad_order")


def test_what_is_too_long_is_refused_before_it_is_read(robot: Robot) -> None:
    refused(robot, '{"order": "' + "x" * 1_400_000 + '"}', "too_large")


def test_a_bundle_that_is_not_the_one_of_the_order_is_refused(robot: Robot) -> None:
    def with_bundle(digest: str, announced: bytes, sent: object) -> Any:
        text = json.loads(message("prepare", digest, robot.reader.ticket, announced))
        return robot.reader.on_message(json.dumps({**text, "bundle": sent}), robot.now)

    there = files(robot)
    good = base64.b64encode(FIRST.bundle).decode()
    other = base64.b64encode(SECOND.bundle[:-1] + b"!").decode()
    for sent in (other, good[:-4], good + "AAAA", "!" + good[1:], None, 7, "", good.replace("A", "\u00e4")):
        assert with_bundle(FIRST.digest, FIRST.bundle, sent).code == "bad_bundle", sent
    assert with_bundle(SECOND.digest, FIRST.bundle, good).code == "bad_bundle"
    assert with_bundle(OWN, FIRST.bundle, good).code == "bad_order"
    text = json.loads(message("prepare", FIRST.digest, robot.reader.ticket))
    assert robot.reader.on_message(json.dumps({**text, "bundle": good}), robot.now).code == "bad_bundle"
    assert robot.order("commit", FIRST.digest, FIRST.bundle).code == "bad_order"
    assert files(robot) == there
    assert robot.order("prepare", FIRST.digest, FIRST.bundle).ok


def test_a_mission_that_a_stranger_signed_is_refused_whoever_sends_it(robot: Robot) -> None:
    strange = mission("first", signer=STRANGER)
    assert robot.order("prepare", strange.digest, strange.bundle).code == "unknown_key"
    assert robot.store.kept() == []


@pytest.mark.parametrize("path, content", [
    ("strategy.yaml", b"strategy: ["), ("strategy.yaml", b"[]"), ("strategy.yaml", b"format: 2"),
    ("strategy.yaml", b"\xff\xfe\x00"), ("strategy.yaml", STRATEGY.replace(b"1/10", b"1/0")),
    ("strategy.yaml", STRATEGY.replace(b"strategy: []", b"strategy: [{state: {}, commands: [7]}]")),
    ("poses.yaml", POSES.replace(b"1.0]", b"]")), ("poses.yaml", POSES.replace(b"1.0]", b".nan]")),
    ("poses.yaml", b"format: 1\nposes: 7"), ("poses.yaml", POSES + b"robots: [bot1]\n"),
    ("poses.yaml", POSES.replace(b"format: 1", b"format: 7")), ("more.yaml", b"- 1"),
])  # fmt: skip
def test_data_that_the_nodes_of_this_machine_cannot_read_are_refused(robot: Robot, path: str, content: bytes) -> None:
    bad = mission("bad", {f"controller_bot1/{path}": content})
    answer = robot.order("prepare", bad.digest, bad.bundle)
    assert (answer.ok, answer.code) == (False, "bad_bundle")
    assert f"controller_bot1/{path} cannot be used" in answer.message and str(robot.folder) not in answer.message
    assert robot.places == [] and robot.reader.status()["prepared"] is None


def test_a_mission_without_a_file_that_this_machine_needs_is_refused(robot: Robot) -> None:
    part = {"controller_bot1/strategy.yaml": STRATEGY}
    manifest = make_manifest("part", "0", ("controller_bot1",), part)
    answer = robot.order("prepare", manifest.digest, desk_bundle.pack(manifest, part, DESK))
    assert answer.code == "bad_bundle" and "poses.yaml" in answer.message


@pytest.mark.parametrize("name", ["scenario_1", "catch_the_thief"])
def test_what_a_workspace_holds_is_taken_by_every_machine(tmp_path: Path, name: str) -> None:
    manifest, data = mission_of(name, workspace_files(f"thesis/{name}"))
    bundle = desk_bundle.pack(manifest, data, DESK)
    robot = Robot(tmp_path, packages=tuple(sorted({path.split("/")[0] for path in data})))
    assert {"UI", "observer", "controllerObj"} < set(robot.reader.status()["packages"])
    answer = robot.order("prepare", manifest.digest, bundle)
    assert answer.ok, answer
    observed = [("observer", name) for name in ("model", "cover", "controllers")]
    for package, file in [*observed, ("UI", "ui"), ("UI", "strategies")]:
        bad = {**data, f"{package}/{file}.yaml": b"format: 1\n"} if file != "ui" else {**data, "UI/ui.yaml": b"7"}
        worse = make_manifest(name, "0", manifest.controllers, bad)
        answer = robot.order("prepare", worse.digest, desk_bundle.pack(worse, bad, DESK))
        assert answer.code == "bad_bundle" and f"{package}/{file}.yaml" in answer.message


# Keys -----------------------------------------------------------------------------------------------------------------


def test_without_a_key_everything_is_refused(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    (tmp_path / "keys" / "desk.pub").unlink()
    refused(robot, message("prepare", FIRST.digest, robot.reader.ticket, FIRST.bundle), "no_keys")
    assert "put the desk's public key into" in robot.reader.problem()
    shutil.rmtree(tmp_path / "keys")
    refused(robot, message("prepare", FIRST.digest, robot.reader.ticket, FIRST.bundle), "no_keys")


def test_keys_count_as_soon_as_they_are_there_and_no_longer(robot: Robot) -> None:
    keys = robot.folder / "keys"
    theirs = mission("theirs", signer=STRANGER)
    assert robot.order("prepare", theirs.digest, theirs.bundle, signer=STRANGER).code == "unknown_key"
    (keys / "theirs.pub").write_text(desk_bundle.write_public_key(STRANGER.public_key(), "them"))
    assert robot.order("prepare", theirs.digest, theirs.bundle, signer=STRANGER).ok
    (keys / "theirs.pub").unlink()
    assert robot.order("commit", theirs.digest, signer=STRANGER).code == "unknown_key"
    assert robot.reader.problem() == ""
    (keys / "junk.pub").write_bytes(b"\xff\x00")
    assert robot.order("abort", theirs.digest).ok
    assert "junk.pub" in robot.reader.problem()


def test_whoever_asks_while_keys_are_being_read_gets_them_too(robot: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = KeyFolder(str(robot.folder / "keys"))
    reads, read, go_on = read_keys, threading.Event(), threading.Event()

    def slowly(path: str) -> Any:
        read.set()
        go_on.wait(waiting.PATIENCE)
        return reads(path)

    monkeypatch.setattr(pursue_guard, "read_keys", slowly)
    one = threading.Thread(target=folder.keys)
    one.start()
    assert read.wait(waiting.PATIENCE)
    threading.Timer(0.1, go_on.set).start()
    assert len(folder.keys()) == 1
    one.join()


# A mission that runs --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("live", LIVE)
@pytest.mark.parametrize("end", IDLE)
def test_a_mission_is_exchanged_when_the_one_that_runs_is_over(robot: Robot, live: str, end: str) -> None:
    robot.send(FIRST)
    robot.state(live, 2)
    robot.order("prepare", SECOND.digest, SECOND.bundle)
    answer = robot.order("commit", SECOND.digest)
    assert (answer.ok, answer.code) == (True, "waiting")
    for seq in (3, 4):
        assert not robot.state(live, seq)
        assert robot.current == FIRST.digest and robot.reader.status()["next"] == SECOND.digest
    assert robot.state(end, 5)
    assert robot.current == SECOND.digest and robot.reader.status()["next"] is None
    assert robot.store.state.history == (OWN, FIRST.digest)


def test_what_waits_can_be_called_off(robot: Robot) -> None:
    robot.send(FIRST)
    robot.state("running", 2)
    robot.send(SECOND)
    assert robot.order("prepare", FIRST.digest).ok and robot.order("commit", FIRST.digest).ok
    assert robot.reader.status()["next"] is None
    robot.send(SECOND)
    assert robot.order("abort", SECOND.digest).ok
    robot.state("won", 3)
    assert robot.current == FIRST.digest


def test_what_others_prepared_is_not_called_off_with_it(robot: Robot) -> None:
    robot.state("running", 2)
    robot.send(FIRST)
    robot.order("prepare", SECOND.digest, SECOND.bundle)
    assert robot.order("abort", THIRD.digest).ok and robot.order("abort", SECOND.digest).ok
    assert robot.reader.status()["next"] == FIRST.digest


def test_until_it_is_clear_that_no_mission_runs_none_is_exchanged(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    robot.order("prepare", FIRST.digest, FIRST.bundle)
    assert robot.order("commit", FIRST.digest).code == "waiting"
    assert robot.reader.next_check(robot.now) == pytest.approx(PATIENCE)
    robot.now += PATIENCE - 0.1
    assert not robot.reader.on_time(robot.now) and robot.current == OWN
    robot.now += 0.2
    assert robot.reader.next_check(robot.now) > 0 and robot.reader.on_time(robot.now) and robot.current == FIRST.digest
    assert robot.reader.next_check(robot.now) is None


def test_what_the_observer_said_a_while_ago_does_not_count(robot: Robot) -> None:
    """It may have been started anew meanwhile, play a mission already, and not be connected to us yet."""
    robot.state("waiting")
    robot.now += 1.6
    robot.send(FIRST)
    assert robot.current == OWN and robot.reader.status()["next"] == FIRST.digest
    assert robot.reader.next_check(robot.now) == pytest.approx(PATIENCE - 1.6)
    robot.state("running", 2)
    robot.now += 2 * PATIENCE
    assert not robot.reader.on_time(robot.now) and robot.current == OWN
    robot.state("won", 3)
    assert robot.current == FIRST.digest


def test_where_the_observer_has_gone_no_mission_runs_after_a_while(robot: Robot) -> None:
    robot.state("won", 3)
    robot.now += 1.6
    robot.send(FIRST)
    robot.now += PATIENCE - 1.7
    assert not robot.reader.on_time(robot.now)
    robot.now += 0.2
    assert robot.reader.on_time(robot.now) and robot.current == FIRST.digest


def test_a_reader_that_was_killed_waits_for_the_observers_word(robot: Robot) -> None:
    robot.send(FIRST)
    robot.state("running", 2)
    robot.send(SECOND)
    robot.restart()
    assert not robot.reader.on_time(robot.now)
    robot.now += 1.0
    robot.state("running", 40)
    robot.now += 10 * PATIENCE
    assert not robot.reader.on_time(robot.now) and robot.reader.next_check(robot.now) is None
    assert robot.current == FIRST.digest
    robot.state("stopped", 41)
    assert robot.current == SECOND.digest


def test_an_end_that_comes_late_is_not_the_end_of_the_mission_that_runs(robot: Robot) -> None:
    robot.send(FIRST)
    robot.state("running", 9, stamp=50.0)
    robot.send(SECOND)
    robot.state("won", 8, stamp=40.0)
    assert robot.current == FIRST.digest
    robot.state("won", 10, stamp=51.0)
    assert robot.current == SECOND.digest
    robot.state("running", 9, stamp=50.0)  # late, but to be on the safe side
    assert robot.reader.mission_runs


def test_where_the_clock_was_set_back_missions_end_all_the_same(robot: Robot) -> None:
    robot.state("running", 90, stamp=5000.0)
    robot.send(FIRST)
    robot.state("won", 7, stamp=70.0)
    assert robot.current == OWN
    robot.now += 61.0
    robot.state("won", 7, stamp=71.0)
    assert robot.current == FIRST.digest


def test_a_mission_that_was_damaged_while_it_waited_is_not_used(robot: Robot) -> None:
    robot.send(FIRST)
    robot.state("running", 2)
    robot.send(SECOND)
    (robot.folder / "missions" / SECOND.digest / "observer" / "model.yaml").write_text("")
    assert robot.state("won", 3)
    assert robot.current == FIRST.digest and robot.reader.status()["next"] is None
    assert "damaged" in robot.said


# The log --------------------------------------------------------------------------------------------------------------


def test_ten_thousand_refusals_do_not_fill_the_log(robot: Robot) -> None:
    there = files(robot)
    for number in range(10_000):
        robot.now += 0.01
        assert not robot.reader.on_message(f"junk {number}", robot.now).ok
    assert 1 <= len(robot.log) <= 15
    assert "not a message" in robot.log[0][1] and "999 more" in robot.said
    assert robot.reader.refusals.counts == {"bad_order": 10_000} and files(robot) == there
    robot.send(FIRST)
    assert robot.reader.counts == {"prepare": 1, "commit": 1, "abort": 0, "exchanged": 1}


# Keys that are removed ------------------------------------------------------------------------------------------------


@pytest.fixture
def two_desks(robot: Robot) -> Robot:
    """A robot that has the first mission of the desk, then plays one that another trusted desk has sent."""
    (robot.folder / "keys" / "theirs.pub").write_text(desk_bundle.write_public_key(STRANGER.public_key(), "them"))
    robot.send(FIRST)
    for action, content in (("prepare", THEIRS.bundle), ("commit", b"")):
        assert robot.order(action, THEIRS.digest, content, signer=STRANGER).ok
    return robot


THEIRS, THEIRS_TOO = mission("theirs", signer=STRANGER), mission("theirs_too", signer=STRANGER)


def remove_key(robot: Robot) -> None:
    (robot.folder / "keys" / "theirs.pub").unlink()


@pytest.mark.parametrize("restarted", [False, True])
def test_a_mission_is_gone_with_the_key_that_signed_it(two_desks: Robot, restarted: bool) -> None:
    robot = two_desks
    assert robot.current == THEIRS.digest
    remove_key(robot)
    if restarted:
        robot.restart()
    robot.now += PATIENCE
    assert robot.reader.on_time(robot.now)
    assert robot.current == FIRST.digest
    status = robot.reader.status()
    assert (status["kept"], status["history"], status["next"]) == ([FIRST.digest], [OWN], None)
    assert any(mission_id(THEIRS.digest) in line and "not trusted any more" in line for _, line in robot.log)
    robot.restart()
    assert robot.current == FIRST.digest


def test_without_another_mission_the_workspaces_own_takes_its_place(robot: Robot) -> None:
    robot.send(FIRST)
    (robot.folder / "keys" / "desk.pub").unlink()
    robot.state("waiting")
    assert robot.current == OWN and robot.reader.status()["kept"] == []


def test_one_that_is_played_is_replaced_when_it_is_over(two_desks: Robot) -> None:
    robot = two_desks
    robot.state("running")
    remove_key(robot)
    robot.state("running", 2)
    assert robot.current == THEIRS.digest
    assert "not trusted any more" in robot.reader.problem()
    assert robot.order("abort", FIRST.digest).ok  # nobody can keep it there
    robot.now += 1
    robot.state("won", 3)
    assert robot.current == FIRST.digest and robot.reader.problem() == ""


def test_it_cannot_be_called_back(two_desks: Robot) -> None:
    robot = two_desks
    robot.state("running")
    remove_key(robot)
    for action in ("prepare", "commit"):
        answer = robot.order(action, THEIRS.digest)
        assert (answer.ok, answer.code) == (False, "unknown_key")


def test_one_that_waits_or_is_prepared_is_dropped(two_desks: Robot) -> None:
    robot = two_desks
    robot.send(FIRST)
    robot.state("running")
    assert robot.order("prepare", THEIRS_TOO.digest, THEIRS_TOO.bundle, signer=STRANGER).ok
    assert robot.order("commit", THEIRS_TOO.digest, signer=STRANGER).code == "waiting"
    remove_key(robot)
    robot.state("won", 2)
    status = robot.reader.status()
    assert (status["current"], status["next"], status["prepared"]) == (FIRST.digest, None, None)
    assert status["kept"] == [FIRST.digest]


def test_sent_again_with_a_trusted_key_it_counts(two_desks: Robot) -> None:
    robot = two_desks
    robot.state("running")
    remove_key(robot)
    robot.state("running", 2)
    again = mission("theirs")
    assert again.digest == THEIRS.digest
    assert robot.order("prepare", again.digest, again.bundle).ok
    assert robot.order("commit", again.digest).ok
    robot.state("won", 3)
    assert robot.current == again.digest
    robot.restart()
    robot.now += PATIENCE
    robot.reader.on_time(robot.now)
    assert robot.current == again.digest


def test_keys_are_complete_where_every_file_of_a_key_can_be_read(tmp_path: Path) -> None:
    assert KeyFolder(str(tmp_path / "nowhere")).complete(), "nobody has put a key there"
    (tmp_path / "a.pub").write_text("")
    assert KeyFolder(str(tmp_path)).complete()
    assert not KeyFolder(str(tmp_path / "a.pub")).complete(), "it is no folder"
    (tmp_path / "b.pub").symlink_to(tmp_path / "c.pub")
    assert not KeyFolder(str(tmp_path)).complete()


def test_keys_that_cannot_be_read_are_not_removed_keys(two_desks: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = two_desks
    monkeypatch.setattr(KeyFolder, "complete", lambda self: False)
    remove_key(robot)
    robot.state("waiting", 2)
    assert robot.current == THEIRS.digest
