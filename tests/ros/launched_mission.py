"""A mission on a roscore of its own, under roslaunch, with a node that logs its topics, to inject faults."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import subprocess
import time
import xmlrpc.client
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from ros_world import Ros, end

from benchmarks.ros_world import NO_ANSWER, Hasty
from tests.waiting import PATIENCE

LOGGER = Path(__file__).resolve().parent / "topic_logger.py"
EVENTS, STATE, GOAL, ACTION = "pursue/events", "pursue/system_state", "move_base_simple/goal", "pursue/actions"
ENDED = ("won", "lost", "stopped")

LOGGING_DELAY = 15.0
"""Seconds after the end of a launch in which the logger may still log what was published before it."""

INTERRUPTED = ("KeyboardInterrupt",)
"""What Python dies of that is interrupted before it runs the first line of a node's script."""

PLAYED: Mapping[str, object] = {"simulate": False, "goals": "simple", "ends": "words"}
"""The launch arguments of a mission whose robots are played by the test, which reports their ends."""

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
    state["values"] = {name: int(value) for name, value in pairs if name not in state["places"]}
    state["clocks"] = {name: float(value) for name, value in (line.split("=", 1) for line in clocks.splitlines())}
    return state


def ready(output: str, scenario: str) -> bool:
    """True where the UI that was started last is one of this scenario, and has found everybody ready."""
    starts = list(re.finditer(r"^(\w+): waiting for ", output, re.MULTILINE))
    return bool(starts) and starts[-1].group(1) == scenario and "All nodes are ready" in output[starts[-1].end():]


def _ends(node: str, other: str, end: int) -> Set[str]:
    """The ports of a node's connections with another one on pursue/events: its own (0) or the other's (1)."""
    with xmlrpc.client.ServerProxy(node, transport=Hasty()) as slave:
        links: Any = slave.getBusInfo("/test")
    texts = [str(link[6]) for link in links[2] if (link[1], link[4]) == (other, f"/{EVENTS}")]
    found = (re.search(r"on port (\d+) to \[.*:(\d+) on socket", text) for text in texts)
    return {ports.group(1 + end) for ports in found if ports}


class Node(NamedTuple):
    """A node that was started by hand, and the file of its output."""

    process: "subprocess.Popen[bytes]"
    log: Path

    def output(self) -> str:
        """Its output so far."""
        return self.log.read_text(errors="replace")

    def wait(self) -> int:
        """Its exit status."""
        return self.process.wait(PATIENCE)


class LaunchedMission:
    """A mission that runs. Its messages are in `entries`, in the order in which the logger received them."""

    def __init__(self, folder: Path, uri: str, start: Callable[[str, Path], "subprocess.Popen[bytes]"]) -> None:
        """`start` runs a command where the mission is; its output goes to the file."""
        self.folder = folder
        self._start = start
        self.entries: List[Entry] = []
        self._states: List[State] = []
        self.frozen: List[int] = []
        self._uri = uri
        self._read = 0
        self._over = float("inf")
        self.logger: Optional["subprocess.Popen[bytes]"] = None
        self.launch: Optional["subprocess.Popen[bytes]"] = None

    # What was published -----------------------------------------------------------------------------------------------

    def look(self) -> List[Entry]:
        """Reads what has been logged since the last call; all entries."""
        with open(self.folder / "topics.jsonl", "rb") as log:
            log.seek(self._read)
            text = log.read()
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
        """The messages on the topic, of this node or of all."""
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
        """The orders that robots got, in order: (robot, action or place). One that is sent again is the same order."""
        found: List[Tuple[str, str]] = []
        numbered: Set[Tuple[str, str]] = set()
        for entry in self.look():
            if entry["topic"] in (GOAL, ACTION):
                order = entry["robot"], str(entry["data"])
                found += [] if order in numbered else [(order[0], order[1].partition("@")[0])]
                numbered |= {order} if "@" in order[1] else set()
        return found

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
                self._over = min(self._over, time.monotonic() + LOGGING_DELAY)
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
        """What the UI says of the end."""
        pattern = r"^(?:The goal is|All goals are|The mission (?:is|was)) .*"
        return "".join(re.findall(pattern, self.output(), re.MULTILINE))

    def crashes(self) -> List[str]:
        """The exceptions that nodes died of; a node that is interrupted while it starts has not crashed."""
        found = re.findall(r"^Traceback .*\n(?: .*\n)*([\w.]+)", self.output(), re.MULTILINE)
        return [name for name in found if name not in INTERRUPTED]

    # What the test does -----------------------------------------------------------------------------------------------

    def publish(self, *texts: str) -> None:
        """Publishes events through the logger, once the observer is connected to it."""
        self.until(self.is_connected)
        self.order({"publish": texts})

    def is_connected(self) -> bool:
        """True where the logger sends events to the observer, or one of the two is missing: no event waits for it.

        Both ends are compared: the observer lists a connection before the logger does, and the logger still lists those
        of nodes that were killed.
        """
        with contextlib.suppress(*NO_ANSWER):
            with xmlrpc.client.ServerProxy(self._uri) as master:
                nodes: Any = [master.lookupNode("/test", f"/{node}") for node in ("observer", "topic_logger")]
            if all(code == 1 for code, _, _ in nodes):
                observer, logger = (uri for _, _, uri in nodes)
                here, there = _ends(observer, logger, 0), _ends(logger, "/observer", 1)
                return bool(here & there)
        return True

    def order(self, order: Mapping[str, Any]) -> None:
        """Gives the logger an order (see there)."""
        assert self.logger is not None and self.logger.stdin is not None
        self.logger.stdin.write(json.dumps(order).encode() + b"\n")
        self.logger.stdin.flush()

    def pid(self, node: str) -> int:
        """The process of a node, as it says itself; 0 where none answers."""
        with contextlib.suppress(*NO_ANSWER):
            with xmlrpc.client.ServerProxy(self._uri) as master:
                code, _, uri = master.lookupNode("/test", f"/{node}")  # type: ignore[misc]
            if code == 1:
                with xmlrpc.client.ServerProxy(str(uri), transport=Hasty()) as slave:
                    return int(slave.getPid("/test")[2])  # type: ignore[index]
        return 0

    def set_parameter(self, name: str, value: object) -> None:
        """Set a parameter of the master, as anybody can who reaches it."""
        with xmlrpc.client.ServerProxy(self._uri) as master:
            assert master.setParam("/stranger", name, value)[0] == 1  # type: ignore[arg-type, index]

    def parameters(self) -> object:
        """All parameters, as anybody can read them who reaches the master."""
        with xmlrpc.client.ServerProxy(self._uri) as master:
            return master.getParam("/stranger", "/")[2]  # type: ignore[index]

    def shut_down(self, node: str) -> int:
        """Have a node end, as anybody can who reaches it (rosnode kill); its process."""
        process: int = self.until(lambda: self.pid(node))
        with xmlrpc.client.ServerProxy(self._uri) as master:
            _, _, uri = master.lookupNode("/stranger", f"/{node}")  # type: ignore[misc]
        with xmlrpc.client.ServerProxy(str(uri), transport=Hasty()) as slave:
            slave.shutdown("/stranger", "tests")
        return process

    def delete_parameter(self, name: str) -> None:
        """Deletes a parameter of the master."""
        with xmlrpc.client.ServerProxy(self._uri) as master:
            assert master.deleteParam("/test", name)[0] == 1  # type: ignore[index]

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
        with self.program(f"source devel/setup.bash; exec rosrun {package} {kind} {' '.join(arguments)}", kind) as node:
            yield node

    @contextlib.contextmanager
    def program(self, command: str, name: str) -> Iterator[Node]:
        """A program that runs where the mission is, in the folder of its workspace."""
        log = self.folder / f"{name}-{len(list(self.folder.iterdir()))}.log"
        process = self._start(command, log)
        try:
            yield Node(process, log)
        finally:
            end(process)

    @contextlib.contextmanager
    def script(self, path: Path) -> Iterator[Node]:
        """A Python program with ROS and the workspace's messages."""
        log = self.folder / f"{path.stem}-{len(list(self.folder.iterdir()))}.log"
        process = self._start(f"source devel/setup.bash; exec python3 {path}", log)
        try:
            yield Node(process, log)
        finally:
            end(process)

    def until_back(self, node: str, old: int) -> None:
        """Waits until another process has the node's name, and says that it is ready."""
        process = self.until(lambda: self.pid(node) not in (0, old) and self.pid(node))
        known = len(self.look())
        self.until(lambda: any(
            status["values"]["ready"] == "true"
            for entry in self.look()[known:]
            if (entry["topic"], entry["from"]) == ("/diagnostics", node)
            for status in entry["data"]
        ) or self.launch is None or self.launch.poll() is not None)
        assert process != old


@contextlib.contextmanager
def launched(
    ros: Ros, workspace: Path, folder: Path, robots: Sequence[str] = ("bot1", "bot2"), /, **arguments: object
) -> Iterator[LaunchedMission]:
    """A mission of the workspace with these launch arguments; whatever was started has ended afterwards."""
    folder.mkdir(parents=True, exist_ok=True)
    bringup = next((workspace / "src").glob("*_bringup")).name
    given = " ".join(f"{name}:={json.dumps(value)}" for name, value in {"wait": PATIENCE, **arguments}.items())
    with ros.master() as there:
        there = {**there, "ROS_HOME": str(folder / "home"), "ROS_LOG_DIR": str(folder / "log")}
        run = LaunchedMission(
            folder, there["ROS_MASTER_URI"], lambda command, log: ros.start(command, workspace, log, **there)
        )
        try:
            with open(folder / "topics.jsonl", "wb") as topics, open(folder / "topic_logger.log", "wb") as log:
                run.logger = subprocess.Popen(
                    ["python3", str(LOGGER), *robots],
                    env={**ros.for_missions(workspace), **there},
                    stdin=subprocess.PIPE,
                    stdout=topics,
                    stderr=log,
                    start_new_session=True,
                )
            run.until(lambda: run.of("here"))
            command = f"source devel/setup.bash; exec roslaunch --skip-log-check {bringup} mission.launch {given}"
            run.launch = ros.start(command, workspace, folder / "launch.log", **there)
            yield run
        finally:
            for frozen in run.frozen:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(frozen, signal.SIGCONT)
            if run.logger is not None and run.logger.stdin is not None:
                run.logger.stdin.close()
            for process in (run.launch, run.logger):
                if process is not None:
                    end(process)
