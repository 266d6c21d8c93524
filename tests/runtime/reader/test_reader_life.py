"""A robot's reader through whatever comes: what is current is always a whole mission, and stays while it runs."""

from __future__ import annotations

import contextlib
import shutil
import tempfile
from pathlib import Path
from typing import Dict, List, Set

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from pursue_runtime import folders
from pursue_runtime.reader import store as mission_store
from pursue_runtime.reader.contents import find_damage
from tests.runtime.reader_stage import OWN, STRANGER, Crash, Disk, Robot, message, mission

LIVE, IDLE = ["running", "holding"], ["waiting", "won", "lost", "stopped"]
MISSIONS = [mission(f"number{number}") for number in range(6)]
NAMES = [made.digest for made in MISSIONS]
CHOICE = st.sampled_from(range(6))
KEEP = 2


class Life(RuleBasedStateMachine):
    """A robot's reader for weeks: orders right and wrong, missions begin and end, deaths at any write, full disks."""

    @initialize()
    def begin(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="reader_life_"))
        self.robot = Robot(self.folder, keep=KEEP)
        self.seq = 0
        self.runs = False
        self.frozen = ""  # the current mission when the one that runs was heard of first
        self.used: Set[str] = set()
        self.sent: List[str] = []
        self.answered: Dict[str, int] = {}

    def teardown(self) -> None:
        if hasattr(self, "robot"):
            self.robot.store.close()
            shutil.rmtree(self.folder)

    def say(self, text: str, at: int = -1, fault: int = 0) -> None:
        """The message is handled; at the change with this number of the disk it dies, or the disk is full."""
        self.sent.append(text)
        ticket = self.robot.reader.ticket
        answer = None
        with pytest.MonkeyPatch.context() as patch, contextlib.suppress(Crash):
            if at >= 0:
                disk = Disk(at, fault or None)
                patch.setattr(mission_store, "os", disk)
                patch.setattr(folders, "os", disk)
                patch.setattr(mission_store, "shutil", disk)
            answer = self.robot.reader.on_message(text, self.robot.now)
        if answer is None:
            self.robot.restart()
        if self.robot.reader.ticket != ticket:
            self.used.add(ticket)
        if answer is not None and answer.ticket:
            assert answer.ticket == ticket
            self.answered[ticket] = self.answered.get(ticket, 0) + 1

    @rule(number=CHOICE, at=st.integers(-1, 40), fault=st.sampled_from([0, 28]))
    def prepare(self, number: int, at: int, fault: int) -> None:
        made = MISSIONS[number]
        self.say(message("prepare", made.digest, self.robot.reader.ticket, made.bundle), at, fault)

    @rule(digest=st.sampled_from([*NAMES, OWN]), at=st.integers(-1, 12), fault=st.sampled_from([0, 28]))
    def call_back(self, digest: str, at: int, fault: int) -> None:
        self.say(message("prepare", digest, self.robot.reader.ticket), at, fault)

    @rule(digest=st.sampled_from([*NAMES, OWN]), at=st.integers(-1, 12), fault=st.sampled_from([0, 28]))
    def commit(self, digest: str, at: int, fault: int) -> None:
        self.say(message("commit", digest, self.robot.reader.ticket), at, fault)

    @precondition(lambda self: self.robot.store.state.prepared is not None)
    @rule(at=st.integers(-1, 20))
    def commit_what_is_prepared(self, at: int) -> None:
        self.say(message("commit", self.robot.store.state.prepared, self.robot.reader.ticket), at)

    @rule(digest=st.sampled_from(NAMES))
    def abort(self, digest: str) -> None:
        self.say(message("abort", digest, self.robot.reader.ticket))

    @precondition(lambda self: self.sent)
    @rule(data=st.data())
    def replay(self, data: st.DataObject) -> None:
        before = self.robot.store.state
        self.robot.reader.on_message(data.draw(st.sampled_from(self.sent)), self.robot.now)
        assert self.robot.store.state == before

    @rule(number=CHOICE, action=st.sampled_from(["prepare", "commit", "abort"]))
    def forge(self, number: int, action: str) -> None:
        before = self.robot.reader.status()
        text = message(action, MISSIONS[number].digest, self.robot.reader.ticket, signer=STRANGER)
        assert not self.robot.reader.on_message(text, self.robot.now).ok
        assert self.robot.reader.status() == before

    @rule(live=st.sampled_from(LIVE))
    def run(self, live: str) -> None:
        self.seq += 1
        self.frozen = self.frozen if self.runs else self.robot.current
        self.runs = True
        self.robot.state(live, self.seq)

    @rule(end=st.sampled_from(IDLE), at=st.integers(-1, 12))
    def over(self, end: str, at: int) -> None:
        self.seq += 1
        self.runs = False
        done = None
        with pytest.MonkeyPatch.context() as patch, contextlib.suppress(Crash):
            if at >= 0:
                disk = Disk(at)
                patch.setattr(mission_store, "os", disk)
                patch.setattr(folders, "os", disk)
            done = self.robot.state(end, self.seq)
        if done is None:
            self.robot.restart()

    @rule(seconds=st.sampled_from([0.5, 4.0, 20.0]))
    def wait(self, seconds: float) -> None:
        if not self.runs:  # its observer would be heard
            self.robot.now += seconds
            self.robot.reader.on_time(self.robot.now)

    @rule()
    def kill(self) -> None:
        self.robot.restart()
        if self.runs:
            self.run("running")  # latched

    @precondition(lambda self: len(self.robot.store.kept()) > 1)
    @rule(data=st.data())
    def damage(self, data: st.DataObject) -> None:
        """Somebody spoils a file of a mission that is not the current one, and the machine is started again."""
        others = [digest for digest in self.robot.store.kept() if digest != self.robot.current]
        if others:
            spoiled = data.draw(st.sampled_from(others))
            (self.robot.folder / "missions" / spoiled / "observer" / "model.yaml").write_bytes(b"spoiled")
            self.kill()
            assert spoiled not in self.robot.store.kept()

    @invariant()
    def what_is_current_is_whole(self) -> None:
        current = self.robot.current
        assert current == self.robot.store.state.current
        assert current == OWN or find_damage(self.robot.store.folder, current) == ""

    @invariant()
    def a_mission_that_runs_is_not_exchanged(self) -> None:
        assert not self.runs or self.robot.current == self.frozen

    @invariant()
    def no_ticket_counts_twice(self) -> None:
        assert self.robot.reader.ticket not in self.used
        assert all(count == 1 for count in self.answered.values())

    @invariant()
    def only_so_many_are_kept_and_each_is_whole(self) -> None:
        store = self.robot.store
        assert len(store.kept()) <= KEEP + 3 and set(store.kept()) == set(store.state.named())
        assert all(find_damage(store.folder, digest) == "" for digest in store.kept())


TestLife = Life.TestCase
TestLife.settings = settings(
    max_examples=40, stateful_step_count=30, deadline=None, suppress_health_check=list(HealthCheck)
)
