"""Two desks, three machines, their observer and controllers for a while, whatever gets lost or dies: the sender's, the
readers', and the controllers' own code, step by step in any order.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import shutil
import tempfile
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Set

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.tools.transport import sender
from pursue_gen.tools.transport.client import Answer, Robot, Status, Unreached
from pursue_runtime import bundle as mission_bundle
from pursue_runtime import folders
from pursue_runtime.bundle import KeyFolder
from pursue_runtime.controller.follower import Follower
from pursue_runtime.data import DataError
from pursue_runtime.manifest import make_manifest
from pursue_runtime.missions import Missions, Source
from pursue_runtime.reader import reader as reader_core
from pursue_runtime.reader import store as mission_store
from pursue_runtime.reader.contents import find_damage
from pursue_runtime.reader.reader import Reader
from pursue_runtime.reader.store import Store
from pursue_runtime.state import LIVE, SystemState
from tests.runtime.reader_stage import DESK, OWN, POSES, STRATEGY

PACKAGES = {"base": ("observer",), "bot1": ("controller_bot1",), "bot2": ("controller_bot2",)}
BOTS = ("bot1", "bot2")
KEEP = 2
QUICK = (0.0, 0.0)

LOST_ORDER, LOST_ANSWER, NO_LINE, LATER = "lost order", "lost answer", "no line", "later"
CTRL_C, KILL = "ctrl-c", "kill"
"""What may become of one exchange between desk and robot; LATER: the order comes long after the desk has given up."""


def made(name: str) -> Any:
    """A mission of this name: digest, bundle."""
    files = {"observer/model.yaml": f"# {name}\n".encode()}
    for bot in BOTS:
        files[f"controller_{bot}/strategy.yaml"] = f"# {name}\n".encode() + STRATEGY.replace(b"bot1", bot.encode())
        files[f"controller_{bot}/poses.yaml"] = POSES
    manifest = make_manifest(name, "0", tuple(f"controller_{bot}" for bot in BOTS), files)
    return SimpleNamespace(digest=manifest.digest, bundle=mission_bundle.pack(manifest, files, DESK))


MISSIONS = [made(name) for name in ("first", "second", "third")]


class _QuickDisk:
    """The module `os`; there are no power cuts here."""

    def __getattr__(self, name: str) -> Any:
        return (lambda file: None) if name == "fsync" else getattr(os, name)


class Killed(BaseException):
    """kill -9 of a desk's process."""


class Machine:
    """A reader and what is kept for it; where it has a controller, that too."""

    def __init__(self, name: str, folder: Path, world: World) -> None:
        self.name, self.folder, self.world = name, folder, world
        (folder / "keys").mkdir(parents=True)
        (folder / "keys" / "desk.pub").write_text(mission_bundle.write_public_key(DESK.public_key(), "desk"))
        self.later: List[str] = []
        self.start()
        self.start_controller()

    def start(self) -> None:
        """The reader starts."""
        self.store = Store(str(self.folder / "pursue" / "missions"), KEEP, lambda *_: None)
        facts = reader_core.Machine(self.name, "own", PACKAGES[self.name], 10**6)
        keys = KeyFolder(str(self.folder / "keys"))
        self.reader = Reader(facts, self.store, keys, self.world.now, lambda *_: None, 5.0)
        self.reader._check = lambda folder, files: None  # data is looked at elsewhere

    def start_controller(self) -> None:
        """The controller starts."""
        own = self.folder / "own"
        own.mkdir(exist_ok=True)
        for name, text in (("strategy.yaml", STRATEGY), ("poses.yaml", POSES)):
            (own / name).write_bytes(text)
        missions = Missions(
            Source("0" * 12, str(own)), PACKAGES[self.name][0], str(self.folder)
        )
        clock: Callable[[], float] = lambda: self.world.now
        self.follower = Follower(missions, "c", "controller", lambda *_: None, True, clock)
        self.missions = missions
        if self.name in BOTS:
            with contextlib.suppress(DataError):
                self.follower.load_current()

    def take(self, text: str, bundle: bytes) -> Any:
        """A message on local_mission."""
        message = {"order": text}
        if bundle:
            message["bundle"] = base64.b64encode(bundle).decode()
        return self.world.unswapped(self, lambda: self.reader.on_message(json.dumps(message), self.world.now))

    def status(self) -> Status:
        facts = self.reader.status()
        facts.pop("format"), facts.pop("answer")
        several = {name: tuple(facts[name]) for name in ("kept", "history", "packages")}
        return Status(**{**facts, **several})

    def whole(self, mission: str) -> bool:
        """It has this mission, unharmed."""
        return mission == OWN or not find_damage(self.store.folder, mission)


class Desk(threading.Thread):
    """One `send`: its exchanges happen when the world lets them, with the fault that the world wants."""

    def __init__(self, act: Callable[[], Any]) -> None:
        super().__init__(daemon=True)
        self.act = act
        self.go, self.stopped = threading.Semaphore(0), threading.Semaphore(0)
        self.fault = ""
        self.result: Any = None
        self.killed = self.over = False
        self.has_ordered = False

    def run(self) -> None:
        self.go.acquire()
        try:
            self.result = self.act()
        except Killed:
            self.killed = True
        except BaseException as problem:  # for the thread of the test
            self.result = problem
        self.over = True
        self.stopped.release()

    def wait(self) -> str:
        """The next exchange: waits for its turn; what is to go wrong."""
        self.stopped.release()
        self.go.acquire()
        fault, self.fault = self.fault, ""
        if fault == KILL:
            raise Killed
        if fault == CTRL_C:
            raise KeyboardInterrupt
        return fault

    def step(self, fault: str) -> None:
        """Lets it do one exchange."""
        assert not self.over, self.result
        self.fault = fault
        self.go.release()
        self.stopped.acquire()


class World:
    """All of it. `stamp` and `now` go on by themselves; the observer is a model of what observer.j2 does."""

    def __init__(self, folder: Path) -> None:
        self.now = 100.0
        self.machines = {name: Machine(name, folder / name, self) for name in PACKAGES}
        self.base = self.machines["base"]
        self.desks: List[Desk] = []
        self.playing, self.status, self.seq = OWN, "waiting", 0
        self.journal: Optional[str] = None
        self.cut: Set[str] = set()
        self.say()

    # The network of desks ---------------------------------------------------------------------------------------------

    def health(self, robot: Robot) -> Status:
        if self.desk().wait() in (LOST_ORDER, LOST_ANSWER, NO_LINE, LATER):
            raise Unreached("cut", False)
        return self.machines[robot.name].status()

    def order(self, robot: Robot, text: str, bundle: bytes = b"", listener: Any = None) -> Answer:
        self.desk().has_ordered = True
        fault, machine = self.desk().wait(), self.machines[robot.name]
        if fault == NO_LINE:
            raise Unreached("refused", False)
        if fault == LATER and not bundle:
            machine.later.append(text)
        if fault in (LOST_ORDER, LATER):
            raise Unreached("cut", True)
        answer = machine.take(text, bundle)
        if fault == LOST_ANSWER:
            raise Unreached("cut", True)
        return Answer(200 if answer.ok else 409, answer.ok, answer.code, answer.message, machine.status())

    @staticmethod
    def desk() -> Desk:
        desk = threading.current_thread()
        assert isinstance(desk, Desk)
        return desk

    def send(self, number: int) -> None:
        """A desk begins to send a mission."""
        robots = [Robot(name, name) for name in PACKAGES]
        wanted = MISSIONS[number]
        self.desks.append(
            Desk(lambda: sender.send(robots, wanted.digest, wanted.bundle, DESK, lambda _: None, None, QUICK))
        )
        self.desks[-1].start()
        self.desks[-1].wanted = wanted.digest  # type: ignore[attr-defined]
        self.desks[-1].step("")

    # The observer -----------------------------------------------------------------------------------------------------

    def say(self) -> None:
        """The observer says its state; who is not cut off hears it."""
        self.now += 0.1
        mission = self.playing[:12] or "0" * 12
        state = SystemState(self.seq, self.now, {}, {}, {}, status=self.status, mission=mission)
        for machine in self.machines.values():
            if machine.name not in self.cut:
                self.hear(machine, state)

    def hear(self, machine: Machine, state: Any) -> None:
        self.unswapped(machine, lambda: machine.reader.on_state(state, self.now), state)
        if machine.name in BOTS and machine.follower.on_state(state) == "ours":
            part = machine.follower.part
            assert part is not None and part.mission == state.mission
            assert part.mission == "0" * 12 or any(
                machine.whole(digest) for digest in machine.store.kept() if digest.startswith(part.mission)
            )

    def unswapped(self, machine: Machine, act: Callable[[], Any], state: Any = None) -> Any:
        """Does it; what is current stays while the machine knows that a mission runs."""
        ran, before = machine.reader.mission_runs, machine.store.state.current
        done = act()
        over = state is not None and state.status not in LIVE
        assert not ran or over or machine.store.state.current == before
        return done

    def look(self) -> None:
        """A waiting observer takes the mission that is current on its machine."""
        if self.status == "waiting":
            self.playing, self.seq = self.base.store.state.current, 0
        self.say()

    def begin(self) -> None:
        if self.status == "waiting":
            self.status, self.seq, self.journal = "running", 1, self.playing
        self.say()

    def finish(self) -> None:
        """The mission ends, and the observer begins anew."""
        if self.status == "running":
            self.status, self.seq = "won", self.seq + 1
            self.say()
            self.journal = None
            self.restart_observer()

    def restart_observer(self) -> None:
        if self.journal is None:
            self.playing, self.status, self.seq = self.base.store.state.current, "waiting", 0
        for machine in self.machines.values():
            if machine.name in BOTS and self.journal is None:
                machine.start_controller()
        self.say()

    # What else happens ------------------------------------------------------------------------------------------------

    def happens(self, what: str, name: str) -> None:
        machine = self.machines[name]
        if what == "kill reader":
            machine.store.close()
            machine.start()
            self.say()
        elif what == "kill controller":
            machine.start_controller()
        elif what == "cut":
            self.cut ^= {name}
        elif what == "late order" and machine.later:
            machine.take(machine.later.pop(), b"")
        elif what == "wait":
            self.now += 7.0
            for each in self.machines.values():
                self.unswapped(each, lambda each=each: each.reader.on_time(self.now))  # type: ignore[misc]
        elif what in ("look", "begin", "finish"):
            getattr(self, what)()
        elif what == "kill observer":
            self.restart_observer()

    def calm(self) -> None:
        """Links are fine, no desk is at work, no order under way; the mission that runs ends."""
        for desk in self.desks:
            while not desk.over:
                desk.step("")
        self.cut.clear()
        for machine in self.machines.values():
            while machine.later:
                machine.take(machine.later.pop(), b"")
        self.say()
        self.finish()
        self.happens("wait", "base")
        self.look()


@contextlib.contextmanager
def world() -> Iterator[World]:
    """A world of its own; afterwards nothing is left of it."""

    def one_by_one(act: Callable[[Any], None], talks: Sequence[Any]) -> Dict[Any, str]:
        troubles = {}
        for talk in talks:
            try:
                act(talk)
            except sender.Trouble as trouble:
                troubles[talk] = str(trouble)
        return troubles

    folder = Path(tempfile.mkdtemp(prefix="fleet_life_"))
    with pytest.MonkeyPatch.context() as patch:
        made = World(folder)
        patch.setattr(sender, "health", made.health)
        patch.setattr(sender, "send_order", made.order)
        patch.setattr(sender, "_side_by_side", one_by_one)
        patch.setattr(mission_store, "os", _QuickDisk())
        patch.setattr(folders, "os", _QuickDisk())
        try:
            yield made
        finally:
            for desk in made.desks:
                while not desk.over:
                    desk.step(KILL)  # one that is being taken back goes on until it is killed
            for machine in made.machines.values():
                machine.store.close()
            shutil.rmtree(folder)


EVENTS = ("kill reader", "kill controller", "cut", "late order", "wait", "look", "begin", "finish", "kill observer")
FAULTS = (LOST_ORDER, LOST_ANSWER, NO_LINE, LATER, CTRL_C, KILL)
_RIGHT = st.tuples(st.just("desk"), st.integers(0, 1), st.just(""))
_WRONG = st.tuples(st.just("desk"), st.integers(0, 1), st.sampled_from(FAULTS))
_EVENT = st.tuples(st.just("event"), st.sampled_from(EVENTS), st.sampled_from(list(PACKAGES)))
STEPS = st.lists(st.one_of(*[_RIGHT] * 8, _WRONG, _EVENT, _EVENT), min_size=20, max_size=60)


def live(lab: World, first: int, second: Optional[int], steps: Sequence[Any]) -> None:
    """The desks send, one or two, and the steps happen."""
    for number in (first, second):
        if number is not None:
            lab.send(number)
    for kind, one, other in steps:
        if kind == "event":
            lab.happens(one, other)
        elif one < len(lab.desks) and not lab.desks[one].over:
            lab.desks[one].step(other)


def told(lab: World, before: str = OWN) -> None:
    """When all is quiet the machines agree, or a desk has said that they do not, or a desk was killed."""
    lab.calm()
    now = {machine.store.state.current for machine in lab.machines.values()}
    there = [desk for desk in lab.desks if desk.has_ordered or not isinstance(desk.result, KeyboardInterrupt)]
    results = [desk.result for desk in there if not desk.killed]
    for result in results:
        assert not isinstance(result, BaseException), repr(result)
    if len(now) > 1 and len(results) == len(there):
        assert any(not result.done and not result.unchanged for result in results), results
    if len(lab.desks) == 1 and results and (results[0].done or results[0].unchanged):
        assert now == {results[0].mission if results[0].done else before}


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(before=st.sampled_from((0, 2)), number=st.integers(0, 2), steps=STEPS)
def test_a_desk_brings_all_machines_to_a_mission_or_says_that_they_differ(
    before: int, number: int, steps: List[Any]
) -> None:
    with world() as lab:
        lab.send(before)
        while not lab.desks[0].over:
            lab.desks[0].step("")
        assert lab.desks.pop().result.done
        lab.look()
        live(lab, number, None, steps)
        told(lab, MISSIONS[before].digest)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(first=st.integers(0, 2), second=st.integers(0, 2), steps=STEPS)
def test_of_two_desks_at_once_one_says_so_where_the_machines_differ(first: int, second: int, steps: List[Any]) -> None:
    with world() as lab:
        live(lab, first, second, steps)
        told(lab)


def test_a_desk_takes_back_only_what_it_has_done_itself() -> None:
    """Two desks at once: the second one prepares first, fails, and finds what the first has done meanwhile."""
    with world() as lab:
        lab.send(0)
        lab.send(1)
        first, second = lab.desks
        for desk, exchanges in ((second, 6), (first, 7)):
            for _ in range(exchanges):
                desk.step("")
        assert lab.machines["bot1"].store.state.current == MISSIONS[0].digest
        for desk in (second, first):
            while not desk.over:
                desk.step("")
        assert {machine.store.state.current for machine in lab.machines.values()} == {MISSIONS[0].digest}
        assert first.result.done
        assert not second.result.done and not second.result.unchanged


def test_a_desk_finds_out_that_another_one_was_quicker() -> None:
    with world() as lab:
        lab.send(0)
        first = lab.desks[0]
        while lab.base.store.state.current != MISSIONS[0].digest:
            first.step("")
        lab.send(1)
        second = lab.desks[1]
        while not second.over:
            second.step("")
        assert second.result.done
        while not first.over:
            first.step("")
        assert not first.result.done and not first.result.unchanged
        assert "another desk" in first.result.trouble


def test_what_is_damaged_is_mended_by_sending_it_again() -> None:
    with world() as lab:
        for _ in range(2):
            lab.send(0)
            while not lab.desks[-1].over:
                lab.desks[-1].step("")
            assert lab.desks[-1].result.done
            assert all(machine.whole(MISSIONS[0].digest) for machine in lab.machines.values())
            file = lab.base.folder / "pursue" / "missions" / MISSIONS[0].digest / "observer" / "model.yaml"
            file.write_text("damaged")


def test_a_mission_that_waited_waits_again_where_another_one_is_taken_back() -> None:
    """One is played, another one waits for its end; a third one is sent, and a robot dies on the way."""
    with world() as lab:
        lab.begin()
        lab.send(0)
        while not lab.desks[0].over:
            lab.desks[0].step("")
        assert lab.base.store.state.next == MISSIONS[0].digest
        lab.send(1)
        desk = lab.desks[1]
        while lab.machines["bot2"].store.state.next != MISSIONS[1].digest:
            desk.step("")
        desk.step(CTRL_C)
        while not desk.over:
            desk.step("")
        assert not desk.result.done and desk.result.unchanged, desk.result
        assert {machine.store.state.next for machine in lab.machines.values()} == {MISSIONS[0].digest}
        assert all(machine.whole(MISSIONS[0].digest) for machine in lab.machines.values())
