"""A Python that has loaded ROS's modules already, and becomes each program that tests start.

Half of a short mission's processor time is rospy's import, once for each node. `preloaded(…)` has programs (`PROGRAMS`)
that stand first on PATH of missions. Each hands its arguments, variables, folder and open files to one process that has
imported what they all import; that forks, and its child runs the script. Signals are passed on, but for SIGSTOP (see
`process_of`), and the status comes back. Workspaces' own modules are imported by each node.

Run by itself, with the socket's address, this file is that process. It ends with its standard input.
"""

from __future__ import annotations

import array
import atexit
import contextlib
import gc
import importlib
import marshal
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

_NAMESPACE = "/proc/self/ns/net"
"""Tells which network a process has. Where it is another one than here, programs start by themselves."""

_FORWARDED = (signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGTERM, signal.SIGUSR1, signal.SIGUSR2)

CLIENT = """\
#!{python} -ISE
import array, marshal, os, signal, socket, sys

def otherwise(program, arguments):
    os.environ["PATH"] = ":".join(part for part in os.environ["PATH"].split(":") if part != {folder!r})
    os.execvp(program, [program, *arguments])

name, arguments = os.path.basename(sys.argv[0]), sys.argv[1:]
elsewhere = os.readlink({namespace!r}) != {here!r}
if elsewhere or name == "python3" and not (arguments and os.path.isfile(arguments[0])):
    otherwise(name, arguments)
forwarded = {forwarded}
signal.pthread_sigmask(signal.SIG_BLOCK, forwarded)
link = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
try:
    link.connect({address!r})
except OSError:
    signal.pthread_sigmask(signal.SIG_UNBLOCK, forwarded)
    otherwise(name, arguments)
if name != "python3":
    arguments.insert(0, {programs}[name])
files = array.array("i", [0, 1, 2])
asked = marshal.dumps((arguments, os.getcwd(), dict(os.environ)))
link.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
link.sendmsg([asked], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, files)])
child = int(link.recv(64))
with open("/proc/self/comm", "w") as file:
    file.write(str(child))
os.kill(child, signal.SIGCONT)

def forward(number, frame):
    try:
        os.kill(child, number)
    except ProcessLookupError:
        pass

for number in forwarded:
    signal.signal(number, forward)
signal.pthread_sigmask(signal.SIG_UNBLOCK, forwarded)
status = int(link.recv(64) or b"-9")
if status < 0:
    signal.signal(-status, signal.SIG_DFL) if -status not in (signal.SIGKILL, signal.SIGSTOP) else None
    os.kill(os.getpid(), -status)
sys.exit(status)
"""


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
    address, programs = str(place / "socket"), place / "bin"
    programs.mkdir()
    found = {name: where for name in PROGRAMS for where in [shutil.which(name, path=path)] if where}
    python = found["python3"]
    text = CLIENT.format(
        python=python, folder=str(programs), forwarded=tuple(map(int, _FORWARDED)), address=address, programs=found,
        namespace=_NAMESPACE, here=os.readlink(_NAMESPACE),
    )  # fmt: skip
    for name in found:
        (programs / name).write_text(text)
        (programs / name).chmod(0o755)
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
        program = Program(*marshal.loads(text), list(files)[3:])
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
