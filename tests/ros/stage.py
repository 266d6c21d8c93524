"""A mission on a roscore of its own, under roslaunch, with a witness who writes down what is said: for tests that break
things while it runs.
"""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import re
import signal
import subprocess
import time
import xmlrpc.client
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from ros_world import Ros, end

from tests.waiting import PATIENCE

WITNESS = Path(__file__).resolve().parent / "witness.py"
EVENTS, STATE, GOAL, ACTION = "pursue/events", "pursue/system_state", "move_base_simple/goal", "pursue/actions"
ENDED = ("won", "lost", "stopped")

LAST_WORDS = 15.0
"""Seconds after the end of a launch in which the witness may still write down what was said before it."""

INTERRUPTED = ("KeyboardInterrupt", "rospy.exceptions.ROSInitException", "rospy.exceptions.ROSInterruptException")
"""What a node dies of that is interrupted while it starts: as those do that were started again at the end."""

Entry = Dict[str, Any]


class State(Dict[str, Any]):
    """A system state: the words of its first line, `places`, `values` and `clocks`."""

    @property
    def seq(self) -> int:
        """Its number."""
        return int(self["seq"])

    @property
    def status(self) -> str:
        """waiting, running, holding, won, lost or stopped."""
        return str(self["status"])


def read_state(text: str) -> State:
    """Reads a text of pursue/system_state, apart from the library that is under test."""
    head, _, rest = text.partition("\n")
    head, _, reason = head.partition(" reason=")
    state = State(word.split("=", 1) for word in head.split())
    discrete, _, clocks = rest.partition("\n\n")
    pairs = [line.split("=", 1) for line in discrete.splitlines()]
    state["reason"] = reason
    state["places"] = {name: value for name, value in pairs if not re.fullmatch(r"-?\d+", value)}
    state["clocks"] = {name: float(value) for name, value in (line.split("=", 1) for line in clocks.splitlines())}
    return state


def ready(said: str, scenario: str) -> bool:
    """True where the UI that was started last is one of this scenario, and has found everybody ready."""
    starts = list(re.finditer(r"^(\w+): waiting for ", said, re.MULTILINE))
    return bool(starts) and starts[-1].group(1) == scenario and "All nodes are ready" in said[starts[-1].end():]


class Node(NamedTuple):
    """A node that was started by hand, and the file of what it says."""

    process: "subprocess.Popen[bytes]"
    log: Path

    def output(self) -> str:
        """What it has said."""
        return self.log.read_text(errors="replace")

    def wait(self) -> int:
        """Its exit status."""
        return self.process.wait(PATIENCE)


class Stage:
    """A mission that runs. What was said is in `entries`, in the order of the witness's hearing."""

    def __init__(self, folder: Path, uri: str, start: Callable[[str, Path], "subprocess.Popen[bytes]"]) -> None:
        """`start` runs a command where the mission is; what it says goes to the file."""
        self.folder = folder
        self._start = start
        self.entries: List[Entry] = []
        self._states: List[State] = []
        self.frozen: List[int] = []
        self._uri = uri
        self._read = 0
        self._over = float("inf")
        self.witness: Optional["subprocess.Popen[bytes]"] = None
        self.launch: Optional["subprocess.Popen[bytes]"] = None

    # What was said ----------------------------------------------------------------------------------------------------

    def look(self) -> List[Entry]:
        """Reads on in the witness's account."""
        with open(self.folder / "witness.jsonl", "rb") as account:
            account.seek(self._read)
            text = account.read()
        whole = text.rfind(b"\n") + 1
        self._read += whole
        for line in text[:whole].splitlines():
            with contextlib.suppress(ValueError):  # what is not an entry is a complaint of rospy's
                entry: Entry = json.loads(line)
                self.entries.append(entry)
                if entry["topic"] == STATE:  # read but once: `until` looks at all of them again and again
                    self._states.append(read_state(entry["data"]))
        return self.entries

    def of(self, topic: str, sender: str = "") -> List[Entry]:
        """What was said on the topic, by this node or by anybody."""
        return [entry for entry in self.look() if entry["topic"] == topic and sender in ("", entry["from"])]

    def states(self) -> List[State]:
        """The states, in order."""
        self.look()
        return list(self._states)

    def now(self) -> State:
        """The last state; before the first one, a state 0."""
        states = self.states()
        return states[-1] if states else State(seq="0", status="", reason="")

    def steps(self) -> List[str]:
        """The events of the mission, in order: what led to each state that is numbered for the first time."""
        events: Dict[int, str] = {}
        for state in self.states():
            if "event" in state:
                known = events.setdefault(state.seq, state["event"])
                assert known == state["event"], f"two events are number {state.seq}: {known}, {state['event']}"
        return [events[seq] for seq in sorted(events)]

    def orders(self) -> List[Tuple[str, str]]:
        """What robots were told, in order: (robot, action or place)."""
        told = (entry for entry in self.look() if entry["topic"] in (GOAL, ACTION))
        return [(entry["robot"], str(entry["data"])) for entry in told]

    def values(self, node: str) -> Dict[str, str]:
        """The values of a node's last diagnostics."""
        reports = [status for entry in self.of("/diagnostics", node) for status in entry["data"]]
        return dict(reports[-1]["values"]) if reports else {}

    def until(self, done: Callable[[], Any], seconds: float = PATIENCE) -> Any:
        """Waits until it is so (what it returns then); the test fails after so many seconds, or if the launch ends."""
        deadline = time.monotonic() + seconds
        while True:
            found = done()
            if found:
                return found
            if self.launch is not None and self.launch.poll() is not None:
                self._over = min(self._over, time.monotonic() + LAST_WORDS)
            if time.monotonic() > min(deadline, self._over):
                when = f"after {seconds} s" if self._over > deadline else "at the end"
                raise AssertionError(f"not so {when}: {self.now()}\n{self.steps()}\n{self.output()[-6000:]}")
            time.sleep(0.05)

    def until_step(self, event: str) -> State:
        """Waits for the state to which the event leads."""
        self.until(lambda: event in self.steps())
        return next(state for state in self.states() if state.get("event") == event)

    def until_over(self, seconds: float = 2 * PATIENCE) -> str:
        """Waits for the end of the mission and of the launch; the last status."""
        assert self.launch is not None
        launch = self.launch
        self.until(lambda: launch.poll() is not None, seconds)
        self.until(lambda: self.now().status in ENDED)
        return self.now().status

    def output(self) -> str:
        """What roslaunch and the nodes have printed."""
        log = self.folder / "launch.log"
        return log.read_text(errors="replace") if log.exists() else ""

    def verdict(self) -> str:
        """What roslaunch says of the UI's end."""
        found = re.search(r"REQUIRED process \[UI-\d+\] has died!\n(.*)", self.output())
        return found.group(1) if found else ""

    def crashes(self) -> List[str]:
        """The exceptions that nodes died of; a node that is interrupted while it starts has not crashed."""
        found = re.findall(r"^Traceback .*\n(?: .*\n)*([\w.]+)", self.output(), re.MULTILINE)
        return [name for name in found if name not in INTERRUPTED]

    # What is done -----------------------------------------------------------------------------------------------------

    def say(self, *texts: str) -> None:
        """The witness publishes words, once the observer hears it."""
        self.until(self.is_heard)
        self.tell({"say": texts})

    def is_heard(self) -> bool:
        """True where the observer is connected to the witness, or there is none: no word waits for who comes later."""
        with contextlib.suppress(OSError, http.client.HTTPException, xmlrpc.client.Error):
            with xmlrpc.client.ServerProxy(self._uri) as master:
                nodes: Any = [master.lookupNode("/stage", f"/{node}") for node in ("observer", "witness")]
            if all(code == 1 for code, _, _ in nodes):
                observer, witness = (uri for _, _, uri in nodes)
                with xmlrpc.client.ServerProxy(observer) as slave:
                    links: Any = slave.getBusInfo("/stage")
                return any((link[1], link[4]) == (witness, f"/{EVENTS}") for link in links[2])
        return True

    def tell(self, order: Mapping[str, Any]) -> None:
        """An order for the witness (see there)."""
        assert self.witness is not None and self.witness.stdin is not None
        self.witness.stdin.write(json.dumps(order).encode() + b"\n")
        self.witness.stdin.flush()

    def pid(self, node: str) -> int:
        """The process of a node, as it says itself; 0 where none answers."""
        with contextlib.suppress(OSError, http.client.HTTPException, xmlrpc.client.Error):
            with xmlrpc.client.ServerProxy(self._uri) as master:
                code, _, uri = master.lookupNode("/stage", f"/{node}")  # type: ignore[misc]
            if code == 1:
                with xmlrpc.client.ServerProxy(str(uri)) as slave:
                    return int(slave.getPid("/stage")[2])  # type: ignore[index]
        return 0

    def kill(self, node: str, sign: signal.Signals = signal.SIGKILL) -> int:
        """Sends a signal to a node; its process."""
        process: int = self.until(lambda: self.pid(node))
        os.kill(process, sign)
        if sign == signal.SIGSTOP:
            self.frozen.append(process)
        return process

    @contextlib.contextmanager
    def node(self, package: str, kind: str, *arguments: str) -> Iterator[Node]:
        """A node that is started by hand."""
        log = self.folder / f"{kind}-{len(list(self.folder.iterdir()))}.log"
        command = f"source devel/setup.bash; exec rosrun {package} {kind} {' '.join(arguments)}"
        process = self._start(command, log)
        try:
            yield Node(process, log)
        finally:
            end(process)

    def until_back(self, node: str, old: int) -> None:
        """Waits until another process has the node's name, and says that it is ready."""
        process = self.until(lambda: self.pid(node) not in (0, old) and self.pid(node))
        heard = len(self.look())
        self.until(lambda: any(
            status["values"]["ready"] == "true"
            for entry in self.look()[heard:]
            if (entry["topic"], entry["from"]) == ("/diagnostics", node)
            for status in entry["data"]
        ) or self.launch is None or self.launch.poll() is not None)
        assert process != old


@contextlib.contextmanager
def staged(
    ros: Ros, workspace: Path, folder: Path, robots: Sequence[str] = ("bot1", "bot2"), **arguments: object
) -> Iterator[Stage]:
    """A mission of the workspace with these launch arguments; whatever was started has ended afterwards."""
    folder.mkdir(parents=True, exist_ok=True)
    bringup = next((workspace / "src").glob("*_bringup")).name
    given = " ".join(f"{name}:={json.dumps(value)}" for name, value in {"wait": PATIENCE, **arguments}.items())
    with ros.master() as there:
        there = {**there, "ROS_HOME": str(folder / "home"), "ROS_LOG_DIR": str(folder / "log")}
        stage = Stage(folder, there["ROS_MASTER_URI"], lambda command, log: ros.start(command, workspace, log, **there))
        try:
            stage.witness = subprocess.Popen(
                ["python3", str(WITNESS), *robots],
                env={**ros.environment, **there},
                stdin=subprocess.PIPE,
                stdout=open(folder / "witness.jsonl", "wb"),  # noqa: SIM115 (the child keeps it)
                stderr=open(folder / "witness.log", "wb"),  # noqa: SIM115
                start_new_session=True,
            )
            stage.until(lambda: stage.of("here"))
            command = f"source devel/setup.bash; exec roslaunch --skip-log-check {bringup} mission.launch {given}"
            stage.launch = ros.start(command, workspace, folder / "launch.log", **there)
            yield stage
        finally:
            for frozen in stage.frozen:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(frozen, signal.SIGCONT)
            if stage.witness is not None and stage.witness.stdin is not None:
                stage.witness.stdin.close()
            for process in (stage.launch, stage.witness):
                if process is not None:
                    end(process)
