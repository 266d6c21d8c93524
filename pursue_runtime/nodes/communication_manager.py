"""Takes missions from the desk over HTTP and publishes them for pursue_reader; forwards topics to tools without ROS.

Parameters: ~robot (the name that the desk knows; its namespace, or this machine's name where there is none), ~topicName
(local_mission), ~limit (bytes of the largest bundle), ~patience (seconds for the reader's answer; 10), ~connections (at
a time; 64). Arguments: see ARGUMENTS.
"""

from __future__ import annotations

import os
from typing import Dict, List, Mapping, Optional, Tuple

import rospy
from std_msgs.msg import String

from pursue_runtime.arguments import KEYS, LOOPBACK, Argument, port
from pursue_runtime.bundle import LIMIT, KeyFolder
from pursue_runtime.data import Package
from pursue_runtime.folders import keys_folder
from pursue_runtime.http_server import Background, ServerError, Service, bind
from pursue_runtime.manager.forwarder import Forwarder
from pursue_runtime.manager.manager import LOCAL_MISSION, MISSION_STATUS, Manager, RequestLog, topic_names
from pursue_runtime.manager.server import Limits, Server, tls
from pursue_runtime.nodes.links import Diagnostics, pulses_of_all
from pursue_runtime.nodes.node import (
    ERROR,
    OK,
    WARN,
    Ending,
    NodeReport,
    lower_priority,
    robot_name,
    run_node,
    subscribe,
)
from pursue_runtime.parameters import number, whole
from pursue_runtime.slots import is_loopback

ARGUMENTS = (
    KEYS,
    Argument("host", "ADDRESS", "where to listen (default 127.0.0.1); 0.0.0.0: on all addresses", LOOPBACK),
    Argument("port", "N", "the port for missions (default 13000)", "13000"),
    Argument("certificate", "FILE", "a PEM file: TLS on the port for missions"),
    Argument("private_key", "FILE", "the certificate's key, a PEM file"),
    Argument("pubsubport", "N", "the port of forwarded topics (default 13001)", "13001"),
    Argument("forwardedtopics", "TOPICS", "topics of type std_msgs/String that are forwarded, with commas between"),
)


class CommunicationManager:
    """The node: ROS on one side, a thread with the servers on the other."""

    def __init__(self, told: Mapping[str, str]) -> None:
        host = told["host"] or LOOPBACK
        exposed = not is_loopback(host)
        keys = told["keys"] or keys_folder(os.environ)
        self.record = RequestLog(lambda *text: rospy.logwarn("%s", *text), lambda *text: rospy.loginfo("%s", *text))
        given = rospy.get_param("~", {})
        limit = whole(given, "limit", LIMIT, least=1)
        self.manager = Manager(robot_name(), KeyFolder(keys), self.reader_connected, limit, exposed)
        context = tls(told["certificate"], told["private_key"])
        self.limits = Limits(whole(given, "connections", 64, least=1), number(given, "patience", 10.0, least=1.0))
        self.sockets = bind(host, port(told, "port"), "--port")
        self.server = Server(self.manager, self.sockets, self.publish, self.record, self.limits, context)
        self.forwarder, topics = self.make_forwarder(host, told)
        services: Tuple[Service, ...] = (self.server, *([self.forwarder] if self.forwarder else []))
        self.background = Background(services, self.record.count)
        self.ending = Ending()
        self.orders = rospy.Publisher(str(rospy.get_param("~topicName", LOCAL_MISSION)), String, queue_size=2)
        self.statuses = subscribe(MISSION_STATUS, String, self.on_status, self.ending, queue_size=100, tcp_nodelay=True)
        self.forwarded = [
            subscribe(topic, String, self.on_message, self.ending, topic, queue_size=1000) for topic in topics
        ]
        self.background.start()
        self.log_address(host, exposed, context is not None)
        Diagnostics(self.report, self.ending, pulses_of_all(self.ending))

    def make_forwarder(self, host: str, told: Mapping[str, str]) -> Tuple[Optional[Forwarder], List[str]]:
        """The socket and the topics that go there; none without topics. Raises ServerError and ParameterError."""
        try:
            topics = topic_names(told["forwardedtopics"])
        except ValueError as problem:
            raise ServerError(f"--forwardedtopics: {problem}") from problem
        if not topics:
            return None, []
        sockets = bind(host, port(told, "pubsubport"), "--pubsubport")
        return Forwarder(sockets, self.record), topics

    def log_address(self, host: str, exposed: bool, safe: bool) -> None:
        """Log where missions are taken, and warn where that is not protected."""
        scheme = "https" if safe else "http"
        rospy.loginfo("%s takes missions at %s, port %d (%s)", self.manager.robot, host, self.server.port, scheme)
        if exposed and not safe:
            rospy.logwarn("other machines reach this port without TLS: what is sent is signed, but anyone can read it")
        if self.forwarder is not None:
            names = ", ".join(subscriber.resolved_name for subscriber in self.forwarded)
            rospy.loginfo("%s: forwarded at %s, port %d", names, host, self.forwarder.port)
        if not self.manager.trusts_any_key:
            rospy.logwarn("%s", self.manager.condition()[1])

    def publish(self, text: str) -> None:
        """Publish an order for the reader."""
        self.orders.publish(text)

    def reader_connected(self) -> bool:
        """True while the reader and this node are connected both ways. A connection without a socket is broken."""
        connections = list(self.statuses.impl.connections)
        return self.orders.get_num_connections() > 0 and any(each.socket is not None for each in connections)

    def on_status(self, message: String) -> None:
        """Handle a status of the reader."""
        self.background.call(self.server.on_status, message.data)

    def on_message(self, message: String, topic: str) -> None:
        """Forward a message."""
        latched = message._connection_header.get("latching") == "1"
        if self.forwarder is not None:
            self.background.call(self.forwarder.send, topic, message.data, latched)

    def report(self) -> NodeReport:
        """For /diagnostics. Ready: a mission that came now would be taken."""
        how, sentence = self.manager.condition()
        values: Dict[str, object] = {"robot": self.manager.robot, "port": self.server.port}
        if self.forwarder is not None:
            values["subscribers"] = self.forwarder.subscribers
        values.update(sorted(dict(self.record.counts).items()))
        trusted = self.manager.trusts_any_key and self.manager.reader_connected
        return NodeReport(trusted, {"error": ERROR, "warn": WARN}.get(how, OK), sentence, values)

    def run(self) -> int:
        """Runs until it is ended; returns the exit status."""
        try:
            return self.ending.wait()
        finally:
            self.background.close()


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    lower_priority()
    return run_node("communication_manager", ARGUMENTS, lambda told: CommunicationManager(told).run(), ServerError)
