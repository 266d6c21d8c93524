"""Connections that come back after a cut, and the master: what rospy leaves to its nodes.

A TCP connection that was cut for t seconds may need t more before it delivers again, and rospy gives it up for good
after 150 s. So every node watches topics on which each publisher sends about once a second. A publisher that was silent
for a while gets a second connection, on every topic, as soon as it answers calls again. The old one is kept for a time,
and only listens: the publisher sends there what it had sent before, and nothing else. So no message is lost or comes
twice. One whose first connection is not answered is tried again: rospy waits a minute for a connection that a busy
machine does not take, and for ever for an answer.

When that is done is decided in `pursue_runtime.links`.
"""

from __future__ import annotations

import contextlib
import http.client
import threading
import time
import xmlrpc.client
from functools import partial
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Set, Tuple
from xml.parsers.expat import ExpatError

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rospy.impl.registration import get_topic_manager

from pursue_runtime.links import (
    FOREIGN,
    MASTER_PROBLEMS,
    NOT_REGISTERED,
    REFUSED,
    REGISTERED,
    UNREACHABLE,
    MasterWatch,
    Peers,
    Unanswered,
)
from pursue_runtime.nodes.node import ERROR, STALE, WARN, Ending, NodeReport, start_thread, subscribe, worse

PERIOD = 1.0
"""Seconds between two looks at the connections."""

LATE = 120.0
"""Seconds for which an old connection may still bring what was sent before."""

CALL = 1.0
"""Seconds that another node, or the master, may take to answer a call."""

MASTER_PERIOD = 5.0
"""Seconds between two calls to a master that answers."""

_UNKNOWN = "unknown"  # the name of a publisher that has not answered yet
_OLD = "#old"  # mark of a connection that only listens for what is late
_NO_ANSWER_OF_A_MASTER = (xmlrpc.client.Error, http.client.HTTPException, ExpatError, ValueError, TypeError)
_CALL_ERRORS = (OSError, xmlrpc.client.Error, http.client.HTTPException)


class _Hasty(xmlrpc.client.Transport):
    """Calls that do not wait for ever."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = CALL
        return connection


def _call(uri: str, method: str, *arguments: object) -> Any:
    """The answer of a node, or of the master, to a call of its XML-RPC interface; raises one of _CALL_ERRORS."""
    with xmlrpc.client.ServerProxy(uri, transport=_Hasty()) as proxy:
        code, message, value = getattr(proxy, method)(rospy.get_name(), *arguments)
    if code != 1:
        raise xmlrpc.client.Fault(code, message)
    return value


class Links:
    """Watches the connections of this node and its master, in two threads that mostly sleep.

    `pulses`: subscriptions on which each publisher sends about once a second (/diagnostics, the observer's state).
    `lost(reason)` is called once, in a thread of the watch, when the master is given up.
    """

    def __init__(self, *pulses: rospy.Subscriber, ending: Ending, lost: Callable[[str], object]) -> None:
        self._pulses = pulses
        self._lost = lost
        self._ending = ending
        self._lock = threading.Lock()
        self._peers = Peers()
        self._unanswered = Unanswered()
        self._master = MasterWatch()
        self._busy: Set[str] = set()
        self._late: List[Tuple[float, Any]] = []
        self._renewals = 0
        log_without_master()
        for task in (self._watch_links, self._watch_master):
            start_thread(task.__name__.strip("_"), task, ending)

    def amend(self, report: NodeReport) -> NodeReport:
        """The node's report with what is wrong with the master and the connections."""
        with self._lock:
            silent, trouble = self._peers.silent(time.monotonic()), MASTER_PROBLEMS[self._master.found]
            cut_off = len(silent) == len(self._peers)
        values = {**report.values, "silent": " ".join(silent), "renewed": self._renewals}
        level, message = report.level, report.message
        if silent:
            level = worse(level, STALE if cut_off else WARN)
            message += f"; no messages from {', '.join(silent)}"
        if trouble:
            level = worse(level, WARN if self._master.found == UNREACHABLE else ERROR)
            message += f"; {trouble}"
        return NodeReport(report.ready, level, message, values)

    # Connections ------------------------------------------------------------------------------------------------------

    def _watch_links(self) -> None:
        while not rospy.is_shutdown():
            now = time.monotonic()
            counts: Dict[str, int] = {}
            for pulse in self._pulses:
                for connection in _live(pulse.impl):
                    name = connection.callerid_pub
                    counts[name] = counts.get(name, 0) + connection.stat_num_msg
            with self._lock:
                self._peers.update(counts, now)
                due = [name for name in self._peers.due() if name not in self._busy]
                self._busy.update(due)
                over = [connection for end, connection in self._late if end <= now]
                self._late = [(end, connection) for end, connection in self._late if end > now]
            for connection in over:
                connection.close()
            waiting = {id(connection): (impl, connection) for impl, connection in _waiting()}
            tasks = [partial(self._renew, name) for name in due]
            tasks += [partial(self._try_again, *waiting[each]) for each in self._unanswered.look(waiting)]
            for task in tasks:
                threading.Thread(target=task, name="renew", daemon=True).start()
            time.sleep(PERIOD)

    def _renew(self, name: str) -> None:
        """Makes all connections to this publisher anew, if it answers calls."""
        old = [(impl, connection) for impl in _subscriptions() for connection in _live(impl)
               if connection.callerid_pub == name]
        answered = {uri for uri in {connection.endpoint_id for _, connection in old} if self._answers(uri, old)}
        for impl, connection in old:
            uri = connection.endpoint_id
            if uri in answered:
                self._put_aside(impl, connection)
                with contextlib.suppress(*_CALL_ERRORS):  # what is missing then is found with the master's help
                    connect(impl.resolved_name, uri)
        with self._lock:
            self._busy.discard(name)
            self._renewals += bool(answered)
            if answered or not old:
                self._peers.on_renewed(name, time.monotonic())
        if answered:
            rospy.logwarn("%s was silent for a while: connected to it anew", name)

    def _try_again(self, impl: Any, connection: Any) -> None:
        """Connects anew to a publisher that has not answered yet, if it answers calls: it has sent nothing so far."""
        uri = connection.endpoint_id
        if not self._answers(uri, [(impl, connection)]) or connection.callerid_pub != _UNKNOWN:
            return
        connection.close()
        with contextlib.suppress(*_CALL_ERRORS):  # what is missing then is found with the master's help
            connect(impl.resolved_name, uri)
        rospy.logwarn("%s: %s did not answer: connected to it anew", impl.resolved_name, uri)

    @staticmethod
    def _answers(uri: str, connections: List[Tuple[Any, Any]]) -> bool:
        """True if there is an answer; connections to a process that is no more are closed."""
        try:
            _call(uri, "getPid")
        except ConnectionRefusedError:
            for _, connection in connections:
                if connection.endpoint_id == uri:
                    connection.close()
            return False
        except _CALL_ERRORS:
            return False
        return True

    def _put_aside(self, impl: Any, connection: Any) -> None:
        """Lets it bring what is late, but never connect again; then its name is free for another one."""
        with contextlib.suppress(OSError, ValueError, TypeError):  # rospy's poll would close it before it was read
            impl.connection_poll.remove_fd(connection.fileno())
        connection._reconnect = connection.close
        connection.endpoint_id += _OLD
        if connection.socket is None:  # it was about to connect
            connection.close()
            return
        with self._lock:
            self._late.append((time.monotonic() + LATE, connection))

    # The master -------------------------------------------------------------------------------------------------------

    def _watch_master(self) -> None:
        reported = False
        while not rospy.is_shutdown():
            found, publishers = ask_master()
            if self._ending.called:
                return  # a node that ends is not registered any more
            with self._lock:
                news = self._master.update(found, time.monotonic())
                lost = self._master.lost(time.monotonic())
            if news:
                problem = MASTER_PROBLEMS[found]
                (rospy.logerr if problem else rospy.logwarn)("%s", problem or "the ROS master is back")
            if lost and not reported:
                self._lost(MASTER_PROBLEMS[found])
            reported = reported or lost
            if found == REGISTERED:
                connect_missing(publishers)
            time.sleep(MASTER_PERIOD if found == REGISTERED else PERIOD)


class Diagnostics:
    """Publishes a report on /diagnostics once a second of real time: simulated time may stand still.

    It tells what is wrong with the master and the connections as well, which are watched from here on (see `Links`).
    Without a master the node ends, unless something else is to be done (`lost`).
    """

    def __init__(
        self,
        report: Callable[[], NodeReport],
        ending: Ending,
        *pulses: rospy.Subscriber,
        lost: Optional[Callable[[str], object]] = None,
    ) -> None:
        self._name = rospy.get_name().lstrip("/")
        self._report = report
        self._links = Links(*pulses, ending=ending, lost=lost or ending.without_master)
        self._publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        start_thread("diagnostics", self._run, ending)

    def _run(self) -> None:
        while not rospy.is_shutdown():
            report = self._links.amend(self._report())
            values = {"ready": str(report.ready).lower(), **report.values}
            status = DiagnosticStatus(
                level=report.level,
                name=f"{self._name}: mission",
                message=report.message,
                hardware_id=self._name,
                values=[KeyValue(key, str(value)) for key, value in values.items()],
            )
            array = DiagnosticArray(status=[status])
            array.header.stamp = rospy.Time.now()
            with contextlib.suppress(rospy.ROSException):  # the node is going down
                self._publisher.publish(array)
            time.sleep(1.0)


def pulses_of_all(ending: Ending) -> rospy.Subscriber:
    """What each node publishes once a second, for a node that reads none of it."""
    return subscribe("/diagnostics", rospy.AnyMsg, lambda _: None, ending, queue_size=100)


def ask_master() -> Tuple[str, Dict[str, List[str]]]:
    """Is it there, does it know us? And who publishes what."""
    try:
        publishers, subscribers, _ = _call(rosgraph.get_master_uri(), "getSystemState")
        known = any(rospy.get_name() in names for _, names in (*publishers, *subscribers))
        return (REGISTERED if known else NOT_REGISTERED), dict(publishers)
    except ConnectionRefusedError:
        return REFUSED, {}
    except (*_NO_ANSWER_OF_A_MASTER, ConnectionResetError, BrokenPipeError):
        return FOREIGN, {}
    except OSError:
        return UNREACHABLE, {}


def log_without_master() -> None:
    """rospy requests a parameter of the master at each line that it logs, as long as that is not set: with the master
    cut off, the first log line would stop the node. Set to its default and read once, it is cached."""
    parameter = "/rosout_disable_topics_generation"
    with contextlib.suppress(OSError):  # the master has gone this moment
        if not rospy.has_param(parameter):
            rospy.set_param(parameter, False)
        rospy.get_param_cached(parameter)


def is_gone(node: str) -> bool:
    """Return True if this node does not live any more, though the master may still know it."""
    try:
        _call(_call(rosgraph.get_master_uri(), "lookupNode", node), "getPid")
    except (ConnectionRefusedError, xmlrpc.client.Fault):
        return True
    except _CALL_ERRORS:
        pass  # it may live
    return False


def connect(topic: str, uri: str) -> None:
    """Has rospy connect this topic to the publisher at the address, as if the master had announced it."""
    _call(rospy.get_node_uri(), "publisherUpdate", topic, [uri])


def connect_missing(publishers: Mapping[str, Iterable[str]]) -> None:
    """Connects this node to whom rospy has given up, or has not learned of: the publishers of topics, by topic."""
    for topic, names in publishers.items():
        for impl in _subscriptions():
            if impl.resolved_name == topic:
                for name in sorted(set(names) - {connection.callerid_pub for connection in _live(impl)}):
                    with contextlib.suppress(*_CALL_ERRORS):
                        uri = _call(rosgraph.get_master_uri(), "lookupNode", name)
                        if not impl.has_connection(uri):
                            _call(uri, "getPid")
                            connect(topic, uri)


def traffic(publisher: str, *subscriptions: rospy.Subscriber) -> Tuple[bool, int]:
    """Return whether a connection to this publisher is open on the first of the topics, and the number of messages that
    the present connections to it have brought on all of them."""
    found = [[each for each in list(subscription.impl.connections) if each.callerid_pub == publisher]
             for subscription in subscriptions if subscription.impl is not None]
    is_open = any(connection.socket is not None for connection in found[0]) if found else False
    return is_open, sum(connection.stat_num_msg for connections in found for connection in connections)


def _subscriptions() -> List[Any]:
    """rospy's implementations of the topics to which this node has subscribed."""
    manager = get_topic_manager()
    found = [manager.get_subscriber_impl(topic) for topic, _ in manager.get_subscriptions()]
    return [impl for impl in found if impl is not None]


def _live(impl: Any) -> Iterator[Any]:
    """Its connections that are or were established, but for those that were put aside."""
    for connection in list(impl.connections if impl is not None else ()):
        if connection.callerid_pub != _UNKNOWN and not connection.endpoint_id.endswith(_OLD):
            yield connection


def _waiting() -> Iterator[Tuple[Any, Any]]:
    """Topics and their connections that no publisher has answered yet."""
    for impl in _subscriptions():
        for connection in list(impl.connections):
            if connection.callerid_pub == _UNKNOWN and not connection.done:
                yield impl, connection
