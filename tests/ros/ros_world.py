"""ROS for the tests: a clean environment, workspaces, a master of one's own, processes that end with the test."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import uuid
import xmlrpc.client
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Mapping, Optional, Tuple

from preloaded import process_of

from benchmarks.ros_world import NO_ANSWER, Hasty, free_port
from pursue_gen.language import load
from pursue_gen.solving.solution import IDEAL, Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace
from pursue_gen.workspace.packages import SHARED
from tests.waiting import PATIENCE

SCENARIOS = Path(__file__).resolve().parent.parent.parent / "scenarios"
PUBLISH_EVENT = Path(__file__).resolve().parent / "publish_event.py"
NEEDED = ("catkin_make", "catkin_test_results", "roscore", "roslaunch", "rosrun", "rostest")


_SOURCE = re.compile(r"source (\S+/setup\.bash); ")

Started = Tuple["subprocess.Popen[bytes]", Dict[str, str]]
"""A process, and the variables that lead to its master."""


def _setup() -> str:
    """What a user of ROS sources first; Debian's own packages need nothing."""
    for distribution in ("noetic", "one"):
        if Path(f"/opt/ros/{distribution}/setup.bash").is_file():
            return f"source /opt/ros/{distribution}/setup.bash; "
    return ""


def _has_modules(python: str) -> bool:
    """True if this Python has what nodes import beside ROS."""
    command = [python, "-c", "import cryptography, tornado, transitions, yaml"]
    return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode == 0


def _environment(home: Path) -> Dict[str, str]:
    """Only what a fresh terminal has: other Pythons on PATH break catkin, variables of other masters the rest."""
    path = ["/usr/bin", "/bin", "/usr/local/bin"]
    if sys.base_prefix == "/usr" and sys.prefix != "/usr":
        # Nodes start in half the time with the system's Python; what it lacks, a virtual environment made by it has.
        path.insert(len(path) if _has_modules("/usr/bin/python3") else 0, str(Path(sys.prefix) / "bin"))
    found = {"PATH": ":".join(path), "HOME": str(home), "LANG": "C.UTF-8"}
    if sys.version_info < (3, 12):
        # roslaunch imports distutils, of which setuptools has one that takes long to import.
        found["SETUPTOOLS_USE_DISTUTILS"] = "stdlib"
    measuring = os.environ.get("COVERAGE_PROCESS_START")  # ./run mutants looks what is executed
    if measuring:
        found.update(COVERAGE_PROCESS_START=measuring, PYTHONPATH=os.path.dirname(measuring))
    return {**found, "ROS_LOG_DIR": str(home / "log"), "ROS_IP": "127.0.0.1"}


class Ros:
    """Commands in that environment, and masters."""

    def __init__(self, home: Path, shared: Path) -> None:
        """`home` is for what runs in this process, `shared` for what all processes of the session build but once."""
        self.home, self.shared = home, shared
        self.environment = _environment(home)
        self.preloaded: Optional[Path] = None
        """The folder of what starts the programs of missions in workspaces that are used where they were built (see
        preloaded.py); elsewhere, in the install space too, they start as a user's do."""
        self._sourced: Dict[Path, Dict[str, str]] = {}

    def once(self, name: str, build: Callable[[Path], object]) -> Path:
        """The shared folder of this name: the first that asks for it builds it, others wait until it is done."""
        folder, done = self.shared / name, self.shared / f"{name}.done"
        with open(self.shared / f"{name}.lock", "wb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not done.exists():
                shutil.rmtree(folder, ignore_errors=True)
                build(folder)
                done.touch()
        return folder

    def start(self, command: str, folder: Path, log: Path, **more: str) -> "subprocess.Popen[bytes]":
        """Starts a shell command in a session of its own; what it says goes to the log.

        Where it begins with `source …/setup.bash; `, it gets the variables that this sets; the file runs but once.
        """
        source, before = _SOURCE.match(command), self.environment
        if source is None:
            command = _setup() + command
        else:
            devel = source.group(1) == "devel/setup.bash"
            before = self.for_missions(folder) if devel else self.sourced(folder / source.group(1))
            command = command[source.end():]
        with open(log, "wb") as out:
            return subprocess.Popen(
                ["bash", "-c", command],
                cwd=folder,
                env={**before, **more},
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def _path(self, variables: Mapping[str, str]) -> str:
        """PATH for a mission whose nodes need not start as a user's do."""
        path = variables["PATH"]
        return f"{self.preloaded}:{path}" if self.preloaded else path

    def for_missions(self, workspace: Path) -> Dict[str, str]:
        """The variables for missions of a workspace."""
        found = self.sourced(workspace / "devel/setup.bash")
        return {**found, "PATH": self._path(found)}

    def sourced(self, setup: Path) -> Dict[str, str]:
        """The variables after a workspace's setup file was sourced."""
        if setup not in self._sourced:
            command = f"{_setup()}source {setup} && exec env -0"
            done = subprocess.run(
                ["bash", "-c", command], env=self.environment, stdout=subprocess.PIPE, text=True, check=True
            )
            self._sourced[setup] = dict(line.split("=", 1) for line in done.stdout.split("\0") if line)
        return self._sourced[setup]

    def run(
        self, command: str, folder: Path, timeout: float = 2 * PATIENCE, **more: str
    ) -> "subprocess.CompletedProcess[str]":
        """Runs a shell command to its end; at the timeout it is killed with all its children, and the test fails."""
        with tempfile.TemporaryDirectory() as place:
            log = Path(place) / "log"
            process = self.start(command, folder, log, **more)
            try:
                status = process.wait(timeout)
            except subprocess.TimeoutExpired:
                said = log.read_text(errors="replace")
                raise AssertionError(f"{command}: not done after {timeout} s:\n{said[-8000:]}") from None
            finally:
                end(process)
            return subprocess.CompletedProcess(command, status, log.read_text(errors="replace"))

    @contextlib.contextmanager
    def master(self) -> Iterator[Dict[str, str]]:
        """A master on a free port; the variables that lead to it.

        It is all of a roscore that nodes need: neither roscore nor roslaunch starts rosout, which nobody looks at, or
        finds out ROS's version.
        """
        etc = self.home / "etc"
        etc.mkdir(exist_ok=True)
        (etc / "roscore.xml").write_text("<launch/>\n")
        uri, master = self._master(tries=6)
        try:
            yield {"ROS_MASTER_URI": uri, "ROS_ETC_DIR": str(etc)}
        finally:
            end(master)

    def start_with_master(self, command: str, folder: Path, log: Path, **more: str) -> "Started":
        """Starts a command that brings up a master of its own on $ROS_MASTER_URI, and waits for that master; tries
        again, on another port, where the command ends before: roslaunch gives its master ten seconds."""
        for _ in range(6):
            there = {"ROS_MASTER_URI": f"http://127.0.0.1:{free_port()}"}
            process = self.start(command, folder, log, **there, **more)
            deadline = time.monotonic() + PATIENCE / 2
            while time.monotonic() < deadline and process.poll() is None:
                if _has_run_id(there["ROS_MASTER_URI"]):
                    return process, there
                time.sleep(0.05)
            end(process)
        raise AssertionError(f"{command}: no master:\n{log.read_text(errors='replace')}")

    def _master(self, tries: int) -> "Tuple[str, subprocess.Popen[bytes]]":
        """Its address and its process. It ends by itself where its port is somebody else's by now: then there is
        another one, on another port."""
        port = free_port()
        uri, log = f"http://127.0.0.1:{port}", self.home / f"master-{port}.log"
        command, path = f"exec rosmaster --core -p {port}", self._path(self.environment)
        master = self.start(command, self.home, log, ROS_MASTER_URI=uri, PATH=path)
        deadline = time.monotonic() + PATIENCE / 2
        while time.monotonic() < deadline and master.poll() is None:
            with contextlib.suppress(*NO_ANSWER), xmlrpc.client.ServerProxy(uri, transport=Hasty()) as found:
                if found.getPid("/test")[2] == process_of(master.pid):  # type: ignore[index]
                    found.setParam("/test", "/run_id", str(uuid.uuid1()))
                    return uri, master
            time.sleep(0.02)
        end(master)
        assert tries > 1, f"no master: {log.read_text(errors='replace')}"
        return self._master(tries - 1)


def _has_run_id(uri: str) -> bool:
    """True as soon as the master at this address is one that launched nodes can register with."""
    try:
        code, _, found = xmlrpc.client.ServerProxy(uri, transport=Hasty()).hasParam("/test", "/run_id")
    except NO_ANSWER:
        return False
    return bool(code == 1 and found)


def end(process: "subprocess.Popen[bytes]") -> None:
    """Ends a process and its children: politely, then not. A roslaunch gives each of its nodes 17 s, and where it is
    killed before that they stay behind."""
    for sign, patience in ((signal.SIGINT, 60), (signal.SIGTERM, 20), (signal.SIGKILL, 20)):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, sign)
            os.killpg(process.pid, signal.SIGCONT)  # who stands still hears nothing
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(patience)
            return


def generated(
    name: str, folder: Path, controllers: str = "distributed", slack: Optional[Mapping[str, int]] = None
) -> Path:
    """Writes the workspace of scenarios/<name>.pur; the first strategy found plays it.

    A general controller plays the ideal game, as in the original.
    """
    scenario = load(str(SCENARIOS / f"{name}.pur"))
    rules = IDEAL if controllers == "general" else Rules(slack=slack or {})
    won = solve_scenario(scenario, rules)
    options = Options(controllers=controllers, reaction=rules.reaction, optimize="none")
    return write_workspace(scenario, won.network, won.objective, won.strategy, options, folder)


def make_whole(ros: Ros, workspace: Path, *targets: str) -> Path:
    """Builds it with catkin_make, all of it, as its user does."""
    done = ros.run(f"catkin_make {' '.join(targets)}", workspace, 900)
    assert done.returncode == 0, done.stdout
    return workspace


def make(ros: Ros, workspace: Path) -> Path:
    """Builds it over a workspace of the packages that all have in common: those are built once in a session."""
    common = _common(ros, workspace)
    done = ros.run(f"source {common}/devel/setup.bash; catkin_make", workspace, 900)
    assert done.returncode == 0, done.stdout
    return workspace


def lay_over(ros: Ros, workspace: Path) -> Path:
    """Has its nodes run from their sources over the built packages that all have in common: `source devel/setup.bash`
    does as if it was built. For tests that build the same packages of another scenario elsewhere."""
    (workspace / "devel").mkdir()
    (workspace / "devel" / "setup.bash").write_text(
        f"source {_common(ros, workspace)}/devel/setup.bash\n"
        f"export ROS_PACKAGE_PATH={workspace}/src:$ROS_PACKAGE_PATH\n"
    )
    return workspace


def _common(ros: Ros, workspace: Path) -> Path:
    """The built packages that all workspaces have in common; those of this workspace do not count from now on."""
    found = [workspace / "src" / name for name in SHARED]
    digest = hashlib.sha256()
    for path in sorted(path for package in found for path in package.rglob("*") if path.is_file()):
        digest.update(f"{path.relative_to(workspace)}\n".encode() + hashlib.sha256(path.read_bytes()).digest())

    def build(folder: Path) -> None:
        for package in found:
            shutil.copytree(package, folder / "src" / package.name)
        make_whole(ros, folder)

    common = ros.once(f"common_{digest.hexdigest()[:16]}", build)
    for package in found:
        (package / "CATKIN_IGNORE").touch()
    return common


ALL = slice(None)
BEGIN, END = slice(0, 2), slice(2, 4)
"""Of the launch tests among others: those where they do nothing and something at random; at random and by a trace."""


def judged(ros: Ros, workspace: Path, which: slice = ALL) -> List[str]:
    """Runs the workspace's own launch tests, through catkin_make where it was built, else `which` of them; the results
    that catkin_test_results found, all of them good."""
    results = workspace / "build" / "test_results"
    apart = any((workspace / "src").glob("*/CATKIN_IGNORE"))  # its common packages are in a workspace of their own
    setup = "source devel/setup.bash; " if apart else ""
    if results.parent.is_dir():
        done = ros.run(f"{setup}catkin_make run_tests", workspace, 1800)
    else:
        bringup = next((workspace / "src").glob("*_bringup"))
        tests = re.findall(r"add_rostest\(test/(\S+) ARGS ([^)]*)\)", (bringup / "CMakeLists.txt").read_text())
        played = "; ".join(f"rostest {bringup.name} {file} {arguments}" for file, arguments in tests[which])
        done = ros.run(setup + played, workspace, 1800, ROS_TEST_RESULTS_DIR=str(results))
    verdict = ros.run(f"catkin_test_results --verbose --all {results}", workspace)
    assert verdict.returncode == 0, f"{verdict.stdout}\n{done.stdout[-20000:]}"
    return verdict.stdout.splitlines()


def missions(results: List[str]) -> int:
    """How many missions were played: each answers the five questions of mission_test.py."""
    return sum(re.search(r"rosunit-mission_\w+\.xml: 5 tests$", line) is not None for line in results)
