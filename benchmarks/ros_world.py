"""ROS for benchmarks: a master of their own, generated workspaces, processes measured."""

from __future__ import annotations

import contextlib
import http.client
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Set

from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

ROOT = Path(__file__).resolve().parent.parent

PORTS = 4
"""So many ports are tried: roslaunch gives its master ten seconds, and a free port may be another program's by then."""

UP = 60.0
"""Seconds within which a roscore has to be there."""

NO_ANSWER = (OSError, http.client.HTTPException, xmlrpc.client.Error)
"""What a call of a node or a master raises that does not answer."""


class Hasty(xmlrpc.client.Transport):
    """Calls that do not wait for ever: behind the port there may be anybody, by now."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        """The connection, with a timeout."""
        made = super().make_connection(host)
        made.timeout = 5
        return made


class World:
    """A roscore on a free port, and the processes that were started there; `home` holds ROS's files and the logs."""

    def __init__(self, home: Path) -> None:
        if not shutil.which("roscore"):
            raise SystemExit("this benchmark needs ROS 1: roscore is not on PATH")
        self.home = home
        self.variables = {
            "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
            "ROS_HOSTNAME": "localhost",
            "ROS_HOME": str(home),
            "ROS_LOG_DIR": str(home / "log"),
        }
        self.running: Dict[str, "subprocess.Popen[bytes]"] = {}

    def start_master(self) -> None:
        """Starts the roscore; where it does not come up, another one on another port. Raises SystemExit after PORTS."""
        for _ in range(PORTS):
            port = free_port()
            self.variables["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
            core = self.start("roscore", ["roscore", "-p", str(port)])
            deadline = time.monotonic() + UP
            while core.poll() is None and time.monotonic() < deadline:
                if self._is_up(core):
                    return
                time.sleep(0.05)
            self.stop("roscore")
        raise SystemExit(f"no roscore comes up, on {PORTS} ports: {self.log('roscore')[-2000:]}")

    def _is_up(self, core: "subprocess.Popen[bytes]") -> bool:
        """Whether this roscore has its master, not another program at the same port, and its parameters are set."""
        uri = self.variables["ROS_MASTER_URI"]
        with contextlib.suppress(*NO_ANSWER), xmlrpc.client.ServerProxy(uri, transport=Hasty()) as master:
            has: Any = master.hasParam("/world", "/run_id")
            process: Any = master.getPid("/world")
            return bool(has[2]) and _stat(process[2])[1] == str(core.pid)
        return False

    def start(self, name: str, command: List[str], **more: str) -> "subprocess.Popen[bytes]":
        """Starts a process; what it says goes to <home>/<name>.txt."""
        with open(self.home / f"{name}.txt", "wb") as log:
            process = subprocess.Popen(
                command,
                cwd=str(ROOT),
                env={**self._environment(), **more},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self.running[name] = process
        return process

    def run(self, command: List[str]) -> "subprocess.CompletedProcess[str]":
        """Runs a command to its end."""
        return subprocess.run(command, env=self._environment(), capture_output=True, text=True, timeout=60, check=False)

    def node(self, workspace: Path, package: str, script: str = "", *arguments: str) -> None:
        """Starts a node of a workspace that was built."""
        script = script or package
        program = workspace / "src" / package / "scripts" / script
        modules = workspace / "devel" / "lib" / "python3" / "dist-packages"
        path = os.pathsep.join([str(modules), *filter(None, [os.environ.get("PYTHONPATH")])])
        self.start(script, [sys.executable, str(program), *arguments], PYTHONPATH=path)

    def stop(self, *names: str) -> None:
        """Ends these processes, politely at first, and what they have started, in sessions of its own too, as roslaunch
        starts nodes; all of them where none is named."""
        running = dict(self.running)  # another thread may stop some, too
        chosen = [name for name in reversed(list(running)) if not names or name in names]
        for sign, patience in ((signal.SIGINT, 5.0), (signal.SIGKILL, 5.0)):
            alive = [running[name] for name in chosen if running[name].poll() is None]
            below = _started_by({process.pid for process in alive}) if sign == signal.SIGKILL else []
            for process in alive:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, sign)
            for number in below:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(number, sign)
            deadline = time.monotonic() + patience
            for process in alive:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(max(0.1, deadline - time.monotonic()))
        for name in chosen:
            self.running.pop(name, None)

    def _environment(self) -> Dict[str, str]:
        return {**os.environ, **self.variables}

    def log(self, name: str) -> str:
        """What a process has said."""
        return (self.home / f"{name}.txt").read_text(errors="replace")


@contextlib.contextmanager
def world(home: Path) -> Iterator[World]:
    """A world whose processes end with it."""
    there = World(home)
    try:
        there.start_master()
        yield there
    finally:
        there.stop()


def generated(text: str, name: str, folder: Path, rules: Optional[Rules] = None) -> Path:
    """The workspace of a scenario's text, as `pursue-gen ws` writes it, built with catkin_make."""
    scenario = parse(text, f"{name}.pur", name)
    rules = rules or Rules()
    won = solve_scenario(scenario, rules)
    options = Options(reaction=rules.reaction)
    workspace = write_workspace(scenario, won.network, won.objective, won.strategy, options, folder)
    done = subprocess.run(["catkin_make", "-C", str(workspace)], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"catkin_make fails: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return workspace


def free_port() -> int:
    """A port of this machine that is free now, and that no connection gets by chance: lower than those that the system
    gives away, and not the one that another run would draw."""
    while True:
        port = random.SystemRandom().randrange(20000, 32000)
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("", port))
            return port


def _stat(process: int) -> List[str]:
    """What the system tells of a process, from its state on (proc(5), `stat`)."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()


def _started_by(processes: Set[int]) -> List[int]:
    """The processes that these have started, and those that these have started in turn, and so on."""
    parents: Dict[int, int] = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal():
            with contextlib.suppress(OSError, IndexError):
                parents[int(folder.name)] = int(_stat(int(folder.name))[1])
    found: List[int] = []
    while True:
        more = [each for each, parent in parents.items() if parent in processes or parent in found]
        if len(more) == len(found):
            return found
        found = more


def cpu_seconds(process: "subprocess.Popen[bytes]") -> float:
    """The processor time that the process has used so far."""
    fields = _stat(process.pid)
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident_kib(process: "subprocess.Popen[bytes]") -> int:
    """The memory of the process that is in RAM, in KiB."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0])


def idle_load(there: World, seconds: float) -> Mapping[str, float]:
    """The share of a core that each process uses over so many seconds."""
    before = {name: cpu_seconds(process) for name, process in there.running.items()}
    start = time.monotonic()
    time.sleep(seconds)
    passed = time.monotonic() - start
    return {name: (cpu_seconds(there.running[name]) - used) / passed for name, used in before.items()}
