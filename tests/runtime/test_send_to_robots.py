"""The mission sender and the robots' own programs, without ROS: a mission arrives, waits, and is taken back."""

from __future__ import annotations

import contextlib
import json
import threading
import time
from pathlib import Path
from typing import Any, Iterator, List, Tuple

import pytest

from pursue_gen.language import load
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.request import SolveRequest, solution_of
from pursue_gen.tools.transport.bundles import make_mission, sign
from pursue_gen.tools.transport.client import Robot
from pursue_gen.tools.transport.send_report import fits, kept_by_all, previous
from pursue_gen.tools.transport.sender import Sent, look, send, wait
from pursue_runtime import bundle as mission_bundle
from pursue_runtime.bundle import KeyFolder
from pursue_runtime.http_server import Background, bind
from pursue_runtime.manager.manager import Manager, RequestLog
from pursue_runtime.manager.server import Limits, Server
from pursue_runtime.manifest import OWN
from pursue_runtime.reader import reader as reader_core
from pursue_runtime.reader.contents import StoreError
from pursue_runtime.reader.reader import Reader
from pursue_runtime.reader.store import Store
from pursue_runtime.state import SystemState
from tests.runtime.reader_stage import DESK
from tests.waiting import PATIENCE

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "thesis" / "scenario_1.pur"
MACHINES = {
    "bot1": ("controller_bot1",),
    "base": ("UI", "controllerObj", "observer"),
    "bot2": ("controller_bot2",),
}
QUICK = (0.0, 0.0)


class Machine:
    """communication_manager and pursue_reader of one robot; in place of topics, calls in other threads."""

    def __init__(self, name: str, folder: Path) -> None:
        keys = folder / "keys"
        keys.mkdir(parents=True)
        (keys / "desk.pub").write_text(mission_bundle.write_public_key(DESK.public_key(), "desk"))
        self.lock = threading.Lock()
        self.silent = False
        self.log: List[str] = []
        self.store = Store(str(folder / "missions"), 5, lambda *line: self.log.append(line[-1]))
        facts = reader_core.Machine(name, "scenario_1", MACHINES[name], 10**6)
        folder_of_keys = KeyFolder(str(keys))
        long_ago = time.monotonic() - 100.0
        self.reader = Reader(facts, self.store, folder_of_keys, long_ago, lambda *line: None, 5.0)
        record = RequestLog(self.log.append, self.log.append)
        manager = Manager(name, KeyFolder(str(keys)), lambda: not self.silent)
        sockets = bind("127.0.0.1", 0, "~port")
        limits = Limits(patience=PATIENCE, header=PATIENCE, window=PATIENCE)
        self.server = Server(manager, sockets, self.publish, record, limits)
        self.background = Background((self.server,), record.count)
        self.background.start()
        self.say()

    def publish(self, text: str) -> None:
        threading.Thread(target=self.hear, args=(text,), daemon=True).start()

    def hear(self, text: str) -> None:
        with self.lock:
            self.reader.on_message(text, time.monotonic())
            self.say()

    def say(self) -> None:
        self.background.call(self.server.on_status, json.dumps(self.reader.status()))

    def state(self, status: str, seq: int) -> None:
        """A system state is heard."""
        with self.lock:
            now = time.monotonic()
            self.reader.on_state(SystemState(seq, now, {}, {}, {}, status=status), now)
            self.say()

    @property
    def current(self) -> str:
        return str(self.store.state.current)


@pytest.fixture
def machines(tmp_path: Path) -> Iterator[Tuple[List[Machine], List[Robot]]]:
    with contextlib.ExitStack() as stack:
        made = []
        for name in MACHINES:
            made.append(Machine(name, tmp_path / name))
            stack.callback(made[-1].store.close)
            stack.callback(made[-1].background.close)
        ports = [machine.server.port for machine in made]
        yield made, [Robot(name, "127.0.0.1", port, timeout=PATIENCE) for name, port in zip(MACHINES, ports)]


@pytest.fixture(scope="module")
def missions() -> List[Tuple[str, bytes, Any]]:
    """Two missions of a scenario: digest, bundle, check."""
    made = []
    for slack in ((), ("1",)):
        scenario, request = load(str(SCENARIO)), SolveRequest(slack=slack)
        manifest, files = make_mission(scenario, solution_of(*game_of(scenario), request), request)
        content = sign(manifest, files, DESK)
        packages = {path.split("/")[0] for path in files}
        made.append((manifest.digest, content, fits(manifest.digest, packages, len(content), True)))
    return made


def sent(places: List[Robot], mission: Tuple[str, bytes, Any]) -> Sent:
    return send(places, mission[0], mission[1], DESK, mission[2], None, QUICK)


def test_a_mission_arrives_is_replaced_and_comes_back(machines: Any, missions: Any) -> None:
    robots, places = machines
    first, second = missions
    assert first[0] != second[0]
    for mission in missions:
        result = sent(places, mission)
        assert result.done, result
        assert [robot.current for robot in robots] == [mission[0]] * 3
        assert [row.outcome for row in result.rows] == ["changed"] * 3
    statuses = [row.after for row in look(places, QUICK) if row.after]
    assert previous(statuses) == first[0]
    back = send(places, first[0], b"", DESK, kept_by_all(first[0]), None, QUICK)
    assert back.done, back
    assert [robot.current for robot in robots] == [first[0]] * 3


def test_a_mission_under_way_is_played_to_its_end(machines: Any, missions: Any) -> None:
    robots, places = machines
    for robot in robots:
        robot.state("running", 1)
    result = sent(places, missions[0])
    assert result.done, result
    assert {row.outcome for row in result.rows} == {"takes effect as soon as no mission is under way"}
    assert [robot.current for robot in robots] == [OWN] * 3
    for robot in robots:
        robot.state("won", 2)
    assert all(row.after.current == missions[0][0] for row in wait(places, missions[0][0], PATIENCE, 0.01))


@pytest.mark.parametrize("runs", [False, True])
def test_one_that_fails_to_commit_takes_all_back(machines: Any, missions: Any, runs: bool) -> None:
    robots, places = machines
    assert sent(places, missions[0]).done
    for robot in robots:
        robot.state("running" if runs else "waiting", 1)
    real = robots[1].store.save

    def full(state: Any) -> None:
        if missions[1][0] in (state.current, state.next):
            raise StoreError("the disk is full")
        real(state)

    robots[1].store.save = full
    result = sent(places, missions[1])
    assert not result.done and result.unchanged, result
    assert "the disk is full" in result.trouble
    for robot in robots:
        state = robot.store.state
        assert (state.current, state.next, state.prepared) == (missions[0][0], None, None)


def test_where_a_reader_is_silent_nothing_changes(machines: Any, missions: Any) -> None:
    robots, places = machines
    robots[2].silent = True
    result = sent(places, missions[0])
    assert not result.done and result.unchanged
    assert result.rows[2].outcome == "not reached: its pursue_reader is silent"
    assert [robot.store.kept() for robot in robots] == [[]] * 3


def test_a_damaged_mission_is_sent_once_more(machines: Any, missions: Any) -> None:
    robots, places = machines
    assert sent(places, missions[0]).done
    assert sent(places, missions[1]).done
    kept = Path(robots[0].store.folder) / missions[0][0]
    file = next(kept.glob("controller_bot1/*.yaml"))
    file.chmod(0o600)
    file.write_text("damaged")
    result = sent(places, missions[0])
    assert result.done, result
    assert [robot.current for robot in robots] == [missions[0][0]] * 3
    assert file.read_text() != "damaged"


def test_missions_for_other_machines_are_refused_before_they_are_sent(machines: Any, missions: Any) -> None:
    from pursue_gen.diagnostics import PursueError

    robots, places = machines
    with pytest.raises(PursueError, match="controller_bot2"):
        sent(places[:2], missions[0])
    assert [robot.store.kept() for robot in robots] == [[]] * 3
