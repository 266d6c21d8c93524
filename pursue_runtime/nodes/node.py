"""What every node needs of ROS: threads and subscriptions whose faults end it, diagnostics, its end, the priority of
its process, and how its program begins anew."""

from __future__ import annotations

import contextlib
import errno
import os
import queue
import signal
import socket
import sys
import threading
import time
import traceback
from pathlib import Path
from types import MappingProxyType
from typing import Any, Callable, Mapping, NamedTuple, NoReturn, Optional, Sequence, Tuple, Type

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph.xmlrpc import ThreadingXMLRPCServer

from pursue_runtime.arguments import Argument, ignored, read_arguments
from pursue_runtime.data import DataError
from pursue_runtime.links import MASTER_PROBLEMS
from pursue_runtime.links import REFUSED as MASTER_REFUSED
from pursue_runtime.parameters import ParameterError

NO_STATE = "no state from the observer yet"

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
STALE = DiagnosticStatus.STALE  # what the node knows is old

LOGS = {"debug": rospy.logdebug, "info": rospy.loginfo, "warn": rospy.logwarn, "err": rospy.logerr}


def log(level: str, text: str) -> None:
    """Logs a sentence; the level is one of LOGS."""
    LOGS[level]("%s", text)


def robot_name() -> str:
    """The name by which the desk knows this robot (~robot): its namespace, or this machine's name, if none is given."""
    given = str(rospy.get_param("~robot", "")) or rospy.get_namespace().strip("/")
    return given or socket.gethostname()


def worse(level: int, other: int) -> int:
    """The worse of two levels."""
    return max(level, other, key=(OK, WARN, STALE, ERROR).index)


class NodeReport(NamedTuple):
    """How a node is: one of the standard levels, a sentence, and values (`ready` is added)."""

    ready: bool
    level: int
    message: str
    values: Mapping[str, object]


def start_thread(name: str, run: Callable[[], object], ending: Ending) -> None:
    """Start a thread that the node cannot do without: an exception in it ends the node, with status 1 and a reason."""

    def guarded() -> None:
        try:
            run()
        except Exception as problem:
            if not rospy.is_shutdown():
                rospy.logfatal("the node ends: its thread %s failed: %r\n%s", name, problem, traceback.format_exc())
                ending.end(FAILED)

    threading.Thread(target=guarded, name=name, daemon=True).start()


def subscribe(
    topic: str, kind: type, callback: Callable[..., object], ending: Ending, *arguments: object, **options: Any
) -> rospy.Subscriber:
    """Subscribe to a topic (`options`: those of rospy.Subscriber): `callback` gets each message, and `arguments`.

    An exception in it ends the node, with status 1 and a reason: rospy would log it and go on, and what the node knows
    would be only a part of what has happened.
    """

    def guarded(message: Any) -> None:
        try:
            callback(message, *arguments)
        except Exception as problem:
            if not rospy.is_shutdown():
                reason = "the node ends: what it received on %s could not be handled: %r\n%s"
                rospy.logfatal(reason, topic, problem, traceback.format_exc())
                ending.end(FAILED)

    return rospy.Subscriber(topic, kind, guarded, **options)


FAILED = 1
"""The exit status of a node that cannot go on."""

REFUSED = 3
"""The exit status of a node that cannot begin: its data or its parameters are wrong."""

INTERRUPTED, RENEWED = -1, -2
"""What takes the place of an exit status where a signal ends the node, and where it begins anew."""


def of_another_master(arguments: Sequence[str], run_id: object) -> bool:
    """True where roslaunch has started this node for another roscore than the one that runs now (its `/run_id`).

    roslaunch keeps the logs of a launch in a folder of that name, and passes that to its nodes: `__log:=…/<run_id>/…`.
    """
    logs = [word for word in arguments if word.startswith("__log:=")]
    return bool(logs and run_id) and not any(str(run_id) in word.split("/") for word in logs)


def check_launch() -> None:
    """Ends the process where a new roscore has taken the place of the one of its launch.

    The new one does not have the launch's parameters: with the defaults instead, a node that waits for missions would
    play the workspace's own at once.
    """
    run_id = None
    with contextlib.suppress(OSError, rospy.ROSException):
        run_id = rospy.get_param("/run_id", None) if any(word.startswith("__log:=") for word in sys.argv) else None
    if of_another_master(sys.argv, run_id):
        rospy.logfatal("another roscore has been started, which does not have our parameters: start roslaunch again")
        sys.exit(1)


class Ending:
    """The end of a node: the main thread waits for it. No node begins with settings that are lost."""

    def __init__(self) -> None:
        check_launch()
        # A simple queue may be filled from a signal handler, an event or a condition may not.
        self._ends: queue.SimpleQueue[int] = queue.SimpleQueue()
        self._over = False
        self.renewed = False
        self.reason = ""  # why the node cannot go on, where a signal has ended it
        rospy.on_shutdown(lambda: self._ends.put(0))
        # rospy ends a node in the handler itself, which may wait for ever for a lock of what it has interrupted.
        for sign in (signal.SIGINT, signal.SIGTERM):
            signal.signal(sign, lambda *_: self._ends.put(INTERRUPTED))

    @property
    def called(self) -> bool:
        """True as soon as the node is to end."""
        return self._over or not self._ends.empty()

    def end(self, status: int) -> None:
        """Ends the node with this exit status; the first call counts."""
        self._ends.put(status)

    def without_master(self, why: str) -> None:
        """Ends the node with status 1, and logs why: without a master no node can start or join, and another master
        would not know this node."""
        rospy.logerr("ends here: %s", why)
        self.end(FAILED)

    def renew(self) -> None:
        """Ends the node, which is to begin anew: `renewed` is then True, and what it does last is `restart_process`."""
        self._ends.put(RENEWED)

    def wait(self, linger: float = 0.0) -> int:
        """The exit status, once there is one; what was published has `linger` seconds more to go out.

        A signal ends the node with status 0, unless the master is gone: roslaunch interrupts its nodes when its own
        master has ended.
        """
        status: Optional[int] = None
        while status is None:
            with contextlib.suppress(queue.Empty):  # a signal that comes in the moment before it waits does not wake it
                status = self._ends.get(timeout=1.0)
        self._over = True
        self.renewed = status == RENEWED
        if status == INTERRUPTED and master_is_gone():
            self.reason = MASTER_PROBLEMS[MASTER_REFUSED]
            rospy.logerr("ends here: %s", self.reason)
        for sign in (signal.SIGINT, signal.SIGTERM):
            signal.signal(sign, signal.SIG_IGN)  # it ends already
        if not rospy.is_shutdown():
            time.sleep(linger if status >= 0 else 0.0)
            why = {INTERRUPTED: "interrupted", RENEWED: "there is another mission"}
            rospy.signal_shutdown(why.get(status, "the mission has ended"))
        return FAILED if self.reason else max(0, status)


def master_is_gone() -> bool:
    """True where connections to the master are refused."""
    try:
        socket.create_connection(rosgraph.network.parse_http_host_and_port(rosgraph.get_master_uri()), 1.0).close()
    except ConnectionRefusedError:
        return True
    except (OSError, ValueError):
        return False
    return False


def init_node(name: str, known: Sequence[Argument] = (), **options: Any) -> None:
    """Connects the process to ROS as the node `name` (`options`: those of rospy.init_node), and warns where one of its
    `known` arguments was set as a parameter.

    Until `Ending` handles signals they end the process at once and in silence: rospy would raise from wherever it is.
    """
    ThreadingXMLRPCServer.service_actions = _end_if_closed
    for sign in (signal.SIGINT, signal.SIGTERM):
        signal.signal(sign, signal.SIG_DFL)
    rospy.init_node(name, disable_signals=True, **options)
    warn_of_ignored(known)


def _end_if_closed(server: Any) -> None:
    """Ends an XML-RPC server whose socket is closed. Raises OSError, which rospy takes for its end.

    rospy only closes the socket when a node shuts down. Without this the server would call accept again and again until
    the process ends: most of a second in which each node of a mission that is over uses a whole processor.
    """
    if server.fileno() < 0:
        raise OSError(errno.EBADF, "the server is closed")


def run_node(
    name: str,
    known: Sequence[Argument],
    run: Callable[[Mapping[str, str]], int],
    *refusals: Type[Exception],
) -> int:
    """Connects the process to ROS as the node `name`, and runs it until it ends; returns its exit status.

    `run` gets the values of the `known` arguments by name. Where an argument is not known, or `run` raises DataError or
    one of `refusals`, the message is logged and the exit status is 3.
    """
    expected: Tuple[Type[Exception], ...] = (DataError, *refusals)
    try:
        told = read_arguments(name, known, rospy.myargv(sys.argv)[1:])
    except ParameterError as problem:
        print(f"{name}: {problem}", file=sys.stderr)
        return REFUSED
    init_node(name, known)
    threading.Thread(target=warn_without_clock, daemon=True).start()
    try:
        return run(told)
    except expected as problem:
        rospy.logfatal("%s", problem)
        return REFUSED


def warn_of_ignored(known: Sequence[Argument]) -> None:
    """Log a warning for each of these arguments that somebody has set as a parameter of the node."""
    if known:
        with contextlib.suppress(OSError, rospy.ROSException):
            sentence = ignored(known, rospy.get_param("~", {}))
            if sentence:
                rospy.logwarn("%s", sentence)


def warn_without_clock(wait: float = 5.0) -> None:
    """Log a warning where time is simulated, and nobody tells it within these seconds of real time."""
    if not rospy.rostime.is_wallclock():
        time.sleep(wait)
        if rospy.get_rostime().is_zero() and not rospy.is_shutdown():
            rospy.logwarn(
                "/use_sim_time is true, but nobody publishes /clock: start the simulator that does, or where there is"
                " none: rosparam set /use_sim_time false, and launch again"
            )


LOWER = 5
"""By how much the nice value of nodes is raised that decide nothing about robots."""

ANEW = "PURSUE_ANEW"
"""In the environment of a node that has begun anew."""


def restart_process(environment: Mapping[str, str] = MappingProxyType({})) -> NoReturn:
    """Starts the node's program again in the same process: for roslaunch, which may end with it, it has never ended.

    `environment` is added to that of the process.
    """
    for sign in (signal.SIGINT, signal.SIGTERM):
        signal.signal(sign, signal.SIG_DFL)
    sys.stdout.flush()
    os.execve(sys.executable, [sys.executable, *sys.argv], {**os.environ, ANEW: "yes", **environment})


def run_to_end(ending: Ending) -> int:
    """Wait until the mission ends; return the exit status. Where another mission is prepared, the node begins anew."""
    status = ending.wait(linger=0.2)
    if ending.renewed:
        restart_process()
    return status


def lower_priority() -> None:
    """Lower the priority of this process, once: nodes that decide about robots come first.

    Where the kernel shares the processor among sessions (autogroup), nice counts within a session only, and roslaunch
    starts each node in its own: then the priority of the session is lowered as well.
    """
    if ANEW not in os.environ:
        os.nice(LOWER)
        if os.getsid(0) == os.getpid():
            with contextlib.suppress(OSError, ValueError):  # there are no such groups
                _lower_session(Path("/proc/self/autogroup"))


def _lower_session(autogroup: Path) -> None:
    """Lower the priority of our session. Raises OSError and ValueError."""
    level = int(autogroup.read_text().rpartition(" ")[2]) + LOWER
    for _ in range(20):
        try:
            autogroup.write_text(str(min(level, 19)))
            return
        except BlockingIOError:  # the kernel lets one process do so in a tenth of a second
            time.sleep(0.1)
