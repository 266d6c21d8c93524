"""Records a mission in a bag, for `pursue-gen replay` and ROS's own tools: complete from its first message on,
because the UI does not start it before every publisher is connected here, and closed when the mission has ended.

Parameters: ~nodes (whose words must not be missed), ~topics (more to record), ~received, ~again (see membership).
Arguments: --file (a path, relative to ROS_HOME; "" or true: pursue/<scenario>/mission.bag there; no file is ever
overwritten, the name gets a number), --config (another folder of data).
"""

from __future__ import annotations

import io
import json
import os
import threading
from typing import Any, Dict, List, Mapping, Optional

import genpy
import rosbag
import rosgraph
import rospy
from pursue_msgs.msg import SystemState as SystemStateMessage
from std_msgs.msg import String

from pursue_runtime.arguments import BAG, CONFIG
from pursue_runtime.data import Package
from pursue_runtime.event_words import STATE, SYSTEM_STATE
from pursue_runtime.folders import scenario_folder
from pursue_runtime.nodes.links import Diagnostics, is_gone
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import (
    NO_STATE,
    OK,
    REFUSED,
    WARN,
    Ending,
    NodeReport,
    lower_priority,
    restart_process,
    run_node,
    subscribe,
)
from pursue_runtime.nodes.positions import namespaces
from pursue_runtime.nodes.state_message import state_of
from pursue_runtime.parameters import names
from pursue_runtime.state import ENDED, WAITING, WON, SystemState
from pursue_runtime.ui.options import expected
from pursue_runtime.ui.recording import ACTIVE, GAME, keep_file, missing_connections, reserve_file, topics

CHUNK = 64 * 1024  # bytes; what is not yet in a whole chunk is harder to read after a crash


class Bag(rosbag.Bag):
    """A bag that keeps who published what: rosbag's own `write` has one connection for each topic."""

    def __init__(self, path: str) -> None:
        super().__init__(path, "w", chunk_threshold=CHUNK)
        self._known: Dict[Any, Any] = {}

    def note(self, topic: str, message: rospy.AnyMsg, header: Dict[str, str], stamp: rospy.Time) -> None:
        """Writes a message as it came."""
        key = (topic, header.get("callerid", ""))
        self._topic_connections.pop(topic, None)
        if key in self._known:
            self._topic_connections[topic] = self._known[key]
        kind = type("Kind", (), {"_md5sum": header["md5sum"], "_full_text": header["message_definition"]})
        data = message._buff if isinstance(message, rospy.AnyMsg) else serialized(message)
        self.write(topic, (header["type"], data, header["md5sum"], kind), stamp, True, {**header, "topic": topic})
        self._known[key] = self._topic_connections[topic]


class Recorder:
    """The recorder on ROS: one lock, a subscriber for each topic."""

    def __init__(self, package: Package, told: Mapping[str, str]) -> None:
        self.ending = Ending()
        self.membership = Membership(package, self.ending, told["config"])
        model, settings = self.membership.model, self.membership.source.read("ui.yaml")
        given = rospy.get_param("~", {})
        self.nodes = ["UI", *expected(given, settings.get("nodes", ()))]
        file = "" if told["file"].lower() == "true" else told["file"]
        self.path = reserve_file(file, scenario_folder(os.environ, package.scenario))
        self.lock = threading.Lock()
        self.status = ""
        self.count = 0
        self.bag = Bag(self.path + ACTIVE)
        self.open = True
        self.master = rosgraph.Master(rospy.get_name())
        self.states, self.texts = rospy.resolve_name(STATE), rospy.resolve_name(SYSTEM_STATE)
        others = namespaces(robot.name for robot in model.of_kind("robot"))
        self.note_game(others)
        more = names(given, "topics")
        wanted = [*topics(model, not rospy.rostime.is_wallclock(), others), *more]
        self.subscribers: List[rospy.Subscriber] = [
            subscribe(topic, rospy.AnyMsg, self.on_message, self.ending, rospy.resolve_name(topic), tcp_nodelay=True)
            for topic in dict.fromkeys(wanted)
        ]
        pulses = [each for each in self.subscribers if each.resolved_name == "/diagnostics"]
        Diagnostics(self.report, self.ending, *pulses, lost=lambda _: self.ending.end(1))

    def note_game(self, others: Mapping[str, str]) -> None:
        """The bag begins with what is needed to check it."""
        game = {**self.membership.source.read("game.yaml"), **({"namespaces": others} if others else {})}
        self.bag.write(rospy.resolve_name(GAME), String(json.dumps(game)), stamp())

    def on_message(self, message: rospy.AnyMsg, topic: str) -> None:
        """Record a message."""
        state = read_state(message) if topic == self.states else None
        ours = state is not None and self.membership.takes(state)
        with self.lock:
            if not self.open or (topic in (self.states, self.texts) and not ours and not self.status):
                return  # the last messages of a mission before this one
            self.bag.note(topic, message, message._connection_header, stamp())
            self.count += 1
        if state is not None and ours:
            self.status = state.status
            if state.status in ENDED:
                self.ending.end(0 if state.status == WON else 1)

    def report(self) -> NodeReport:
        """For /diagnostics. It is ready when nothing of a mission that starts now would be missed."""
        values = {"mission": self.membership.source.mission, "messages": self.count, "file": self.path}
        if self.membership.trouble:
            return NodeReport(False, WARN, self.membership.trouble, values)
        if self.status not in ("", WAITING):
            return NodeReport(True, OK, "recording", values)
        why = self.missing() if self.status else NO_STATE
        return NodeReport(not why, WARN if why else OK, why or "recording", values)

    def missing(self) -> str:
        """Why a mission should not start yet."""
        try:
            known = dict(self.master.getSystemState()[0])
        except (OSError, rosgraph.MasterException) as problem:
            return f"the master does not answer: {problem}"
        ours = [each.resolved_name for each in self.subscribers]
        publishers = {topic: set(known.get(topic, [])) - {rospy.get_name()} for topic in ours}
        connected = {each.resolved_name: each.get_num_connections() for each in self.subscribers}
        own = "/diagnostics"  # we publish there ourselves, and rospy connects us to us
        connected[own] = connected.get(own, 0) - (rospy.get_name() in known.get(own, []))
        return missing_connections(self.nodes, publishers, connected, is_gone)

    def run(self) -> int:
        """Runs until the mission ends and its last words are in the bag; returns the exit status."""
        rospy.loginfo("recording %s", self.path)
        try:
            status = self.ending.wait(linger=1.5)
        finally:
            with self.lock:
                self.open = False
                self.bag.close()
            if self.status == WAITING or (self.ending.renewed and not self.status):  # nothing has happened yet
                os.remove(self.path + ACTIVE)
                rospy.loginfo("no mission began: nothing is kept of %s", self.path)
            else:
                wanted, self.path = self.path, keep_file(self.path)
                if self.path != wanted:
                    rospy.logwarn("%s has come meanwhile, and stays as it is", wanted)
                rospy.loginfo("recorded %d messages in %s", self.count, self.path)
            if self.ending.renewed:
                restart_process()
        return status


def read_state(message: rospy.AnyMsg) -> Optional[SystemState]:
    """Return the state that a message on `pursue/state` holds; None for one that no observer publishes."""
    try:
        return state_of(SystemStateMessage().deserialize(message._buff))
    except (genpy.DeserializationError, ValueError):
        return None


def serialized(message: genpy.Message) -> bytes:
    """What was sent: rospy decodes /clock for itself, and does not for us then."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def stamp() -> rospy.Time:
    """The time of now; rosbag does not take 0, which is simulated time before the first /clock."""
    return max(rospy.get_rostime(), rospy.Time(0, 1))


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    lower_priority()
    try:
        return run_node("recorder", [CONFIG, BAG], lambda told: Recorder(package, told).run())
    except OSError as problem:
        rospy.logfatal("cannot record: %s", problem)
        return REFUSED
