"""A Python that has loaded ROS's modules already, and becomes each program that tests start.

Half of a short mission's processor time is rospy's import, once for each node. `preloaded(…)` has programs (`PROGRAMS`)
that stand first on PATH of missions. Each (preloaded_client.cpp) hands its arguments, variables, folder and open files
to one process that has imported what they all import; that forks, and its child runs the script. Signals are passed on,
but for SIGSTOP (see `process_of`), and the status comes back. Workspaces' own modules are imported by each node.

Run by itself, with the socket's address, this file is that process. It ends with its standard input.
"""

from __future__ import annotations

import array
import atexit
import contextlib
import gc
import importlib
import os
import random
import runpy
import selectors
import shutil
import signal
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, Iterator, List, NamedTuple, NoReturn, Optional, Sequence

PROGRAMS = (
    "python3", "rosmaster", "roscore", "roslaunch", "rostest", "rosversion", "rostopic", "rosparam", "catkin_find",
)  # fmt: skip
"""Each is a script in Python."""

MODULES = (
    "argparse", "ast", "configparser", "dataclasses", "encodings.idna", "enum", "fractions", "importlib.metadata",
    "json", "netifaces", "queue", "sqlite3", "tempfile", "unicodedata", "unittest", "uuid", "xml.dom.expatbuilder",
    "xml.dom.minidom", "xml.etree.ElementTree", "yaml", "transitions", "rospy", "rospkg.rosversion", "roslaunch",
    "rostopic", "rosparam", "catkin.find_in_workspaces", "rosmaster.main", "rosmaster.master_api",
    "rostest.rostest_main", "rostest.runner", "rosunit", "actionlib_msgs.msg", "diagnostic_msgs.msg",
    "geometry_msgs.msg", "rosgraph_msgs.msg", "std_msgs.msg", "tf2_msgs.msg",
)  # fmt: skip
"""What nodes and ROS's own programs import; what tests hide from nodes is not among it."""

_CLIENT = Path(__file__).with_name("preloaded_client.cpp")
"""What all programs are. Where the network is another one than here, each starts by itself."""


def process_of(started: int) -> int:
    """The process that does the work of one that was started: itself, or the child of the process that forks."""
    name = Path(f"/proc/{started}/comm").read_text().strip()
    return int(name) if name.isdigit() else started


class Program(NamedTuple):
    """What a process of its own is to run: arguments with the script first, folder, variables, and open files."""

    arguments: List[str]
    folder: str
    variables: Dict[str, str]
    files: List[int]


@contextlib.contextmanager
def preloaded(place: Path, path: str, modules: Sequence[str] = MODULES) -> Iterator[Path]:
    """A folder for PATH, whose programs work until the end; `path` is what PATH is without it."""
    address, programs, scripts = str(place / "socket"), place / "bin", place / "scripts"
    found = {name: where for name in PROGRAMS for where in [shutil.which(name, path=path)] if where}
    here = {"FOLDER": programs, "ADDRESS": address, "NAMESPACE": os.readlink("/proc/self/ns/net")}
    known = [f'-D{name}="{value}"' for name, value in here.items()]
    subprocess.run(["g++", "-std=c++17", "-O1", *known, str(_CLIENT), "-o", str(place / "client")], check=True)
    for folder in (programs, scripts):
        folder.mkdir()
    for name, where in found.items():
        os.link(str(place / "client"), str(programs / name))
        (scripts / name).symlink_to(where)
    python = found["python3"]
    command = [python, str(Path(__file__).resolve()), address, *modules]
    environment = {"PATH": path, "LANG": "C.UTF-8", "SETUPTOOLS_USE_DISTUTILS": "stdlib"}
    with open(place / "log", "wb") as log:
        server = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=log, stderr=log, env=environment, start_new_session=True
        )
    assert server.stdin is not None
    try:
        yield programs
    finally:
        server.stdin.close()
        server.wait()


# The process that forks -----------------------------------------------------------------------------------------------


class Server:
    """Forks a child for each program that is asked for, and tells who asked how it ended."""

    def __init__(self, address: str) -> None:
        self._listening = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._listening.bind(address)
        self._listening.listen(64)
        self._children: Dict[int, socket.socket] = {}
        self._woken, self._waking = socket.socketpair()
        self._waking.setblocking(False)
        signal.set_wakeup_fd(self._waking.fileno(), warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda number, frame: None)
        self._selector = selectors.DefaultSelector()
        for here in (sys.stdin, self._listening, self._woken):
            self._selector.register(here, selectors.EVENT_READ)

    def program(self) -> Program:
        """Serves until the standard input ends, and exits; returns in each child, with what that has to run."""
        while True:
            for key, _ in self._selector.select():
                if key.fileobj is sys.stdin:
                    self._end()
                elif key.fileobj is self._woken:
                    self._woken.recv(1024)
                    self._reap()
                elif key.fileobj is self._listening:
                    self._selector.register(self._listening.accept()[0], selectors.EVENT_READ)
                else:
                    program = self._asked(key.fileobj)
                    if program is not None:
                        return program

    def _asked(self, link: Any) -> Optional[Program]:
        """In the child, what it has to run; None where this process goes on. A link that ends takes its child along."""
        files = array.array("i", [0, 0, 0])
        text, more, _, _ = link.recvmsg(1 << 20, socket.CMSG_SPACE(12))
        if not text:
            self._selector.unregister(link)
            for child in [child for child, other in self._children.items() if other is link]:
                del self._children[child]
                os.kill(child, signal.SIGKILL)  # not reaped yet, so that the number is still its own
            link.close()
            return None
        files.frombytes(more[0][2])
        number, *texts = map(os.fsdecode, text.split(b"\0")[:-1])
        arguments, folder, variables = texts[: int(number)], texts[int(number)], texts[int(number) + 1 :]
        named = dict(each.split("=", 1) for each in variables if "=" in each)
        program = Program(arguments, folder, named, list(files)[3:])
        child = os.fork()
        if not child:
            self._forget()
            os.kill(os.getpid(), signal.SIGSTOP)  # until the process that asked is named after it: see `process_of`
            return program
        os.waitpid(child, os.WUNTRACED)
        for file in program.files:
            os.close(file)
        self._children[child] = link
        link.send(str(child).encode())
        return None

    def _reap(self) -> None:
        """Tells the ends of all children that have ended."""
        with contextlib.suppress(ChildProcessError):
            while True:
                child, status = os.waitpid(-1, os.WNOHANG)
                if not child:
                    break
                link = self._children.pop(child, None)
                if link is not None:
                    ended = -os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
                    with contextlib.suppress(OSError):
                        link.send(str(ended).encode())

    def _end(self) -> NoReturn:
        for child in self._children:
            os.kill(child, signal.SIGKILL)
        sys.exit(0)

    def _forget(self) -> None:
        """Closes in a child what is the server's."""
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        self._selector.close()
        for link in (self._listening, self._woken, self._waking, *self._children.values()):
            link.close()
        self._children.clear()


class End:
    """Ends a program without taking its modules apart: that would copy nearly all the memory that processes share."""

    def __init__(self) -> None:
        self.status: Optional[int] = None
        """Known where the program has ended by itself."""
        atexit.register(self._leave)  # called after all that is registered later

    def _leave(self) -> None:
        if self.status is not None:
            for out in (sys.stdout, sys.stderr):
                out.flush()
            os._exit(self.status & 0xFF)


def become(program: Program, end: End) -> None:
    """Runs the script in this process, which is as new."""
    os.setsid()
    for number, file in enumerate(program.files):
        os.dup2(file, number)
        os.close(file)
    os.chdir(program.folder)
    os.environ.clear()
    os.environ.update(program.variables)
    sys.argv[:] = program.arguments  # rosmaster has kept the list
    first = os.path.dirname(os.path.realpath(program.arguments[0]))
    sys.path[:0] = [first, *filter(None, program.variables.get("PYTHONPATH", "").split(":"))]
    if os.environ.get("PYTHONUNBUFFERED"):  # Python looks at it where it starts
        for out in (sys.stdout, sys.stderr):
            out.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    if "COVERAGE_PROCESS_START" in os.environ:
        importlib.import_module("coverage").process_startup()
    random.seed()
    names = sys.modules.get("rospy.names")
    if names is not None:
        names.reload_mappings(sys.argv)  # type: ignore[attr-defined]
    try:
        runpy.run_path(program.arguments[0], run_name="__main__")
        end.status = 0
    except SystemExit as ended:
        end.status = ended.code if isinstance(ended.code, int) else None if ended.code else 0
        raise


def main() -> None:
    """Loads what there is of the modules, and serves."""
    del sys.path[0]
    end = End()
    for module in sys.argv[2:]:
        with contextlib.suppress(ImportError):
            importlib.import_module(module)
    gc.collect()
    gc.freeze()
    become(Server(sys.argv[1]).program(), end)


if __name__ == "__main__":
    main()
