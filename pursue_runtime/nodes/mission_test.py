"""Plays a mission on ROS and judges it from outside: by the messages on its topics, and by their publishers.

What is expected stands in expected.json beside the script of the test. The mission is started from here, when every
node reports that it is ready and the observer is connected, so that no message is missed.
"""

from __future__ import annotations

import os
import sys
import threading
import unittest
from typing import Any, Callable, Dict, List, Mapping, Sequence, Set, Tuple

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from pursue_msgs.msg import SystemState
from std_msgs.msg import String

from pursue_runtime.bounded import read_json
from pursue_runtime.data import Package
from pursue_runtime.event_words import event_in
from pursue_runtime.model import places_of
from pursue_runtime.nodes.node import init_node

CONNECTED = 60.0  # seconds of the wall clock for all nodes to come up
ANSWERED = 120.0  # seconds of the wall clock for what is due to be answered where the mission is finished


class Record:
    """All messages of the mission, in the order of their receipt."""

    def __init__(self, robots: Sequence[str]) -> None:
        self.changed = threading.Condition()
        self.ready: Set[str] = set()  # nodes
        self.events: List[Tuple[str, str]] = []  # (node, word)
        self.commands: List[Tuple[str, str]] = []  # (node, robot)
        self.states: Dict[int, Dict[str, str]] = {}  # seq: {automaton or variable: location or value}
        self.status = "waiting"
        self.readers = [
            rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_diagnostics, queue_size=100),
            rospy.Subscriber("pursue/events", String, self.on_event, queue_size=1000),
            rospy.Subscriber("pursue/state", SystemState, self.on_state, queue_size=1000),
        ]
        for robot in robots:
            for topic, kind in (("move_base_simple/goal", PoseStamped), ("pursue/actions", String)):
                name = f"{robot}/{topic}"
                self.readers.append(rospy.Subscriber(name, kind, self.on_command, callback_args=robot, queue_size=1000))

    def on_diagnostics(self, message: DiagnosticArray) -> None:
        """Handle a report of a node."""
        with self.changed:
            for status in message.status:
                if any(value.key == "ready" and value.value.lower() == "true" for value in status.values):
                    self.ready.add(sender_of(message))
            self.changed.notify_all()

    def on_event(self, message: String) -> None:
        """Handle a word on pursue/events."""
        with self.changed:
            self.events.append((sender_of(message), message.data.strip()))

    def on_command(self, message: Any, robot: str) -> None:
        """Handle a goal or an action for a robot."""
        with self.changed:
            self.commands.append((sender_of(message), robot))

    def on_state(self, message: SystemState) -> None:
        """Handle a state of the mission."""
        with self.changed:
            self.states[message.seq] = values_of(message)
            self.status = message.status
            self.changed.notify_all()

    def wait(self, done: Callable[[], object], seconds: float) -> bool:
        """True as soon as `done()` holds; False after so many seconds of the wall clock."""
        with self.changed:
            return bool(self.changed.wait_for(done, seconds))

    def ended(self) -> bool:
        """True for a mission that is over."""
        return self.status in ("won", "lost", "stopped")


def sender_of(message: Any) -> str:
    """The node that published the message."""
    return str(message._connection_header["callerid"]).strip("/")


def values_of(message: SystemState) -> Dict[str, str]:
    """The locations of automata and the values of variables, as text."""
    values = {automaton.name: automaton.location for automaton in message.automata}
    values.update((variable.name, str(variable.value)) for variable in message.variables)
    return values


def enabled(edge: Mapping[str, Any], before: Mapping[str, str]) -> bool:
    """True where the edge's tests on variables hold (clocks are not looked at)."""
    return all(any(before[name] == str(value) for name, value in clause) for clause in edge["if"])


def takes_part(
    edges: Sequence[Mapping[str, Any]], before: Mapping[str, str], after: Mapping[str, str], name: str, word: object
) -> bool:
    """True where the automaton receives the word as the model says: it moves if it can, else it stays."""
    receiving = [e for e in edges if e["sync"] == "receive" and e["word"] == word and e["from"] == before[name]]
    enabled_ones = [e for e in receiving if enabled(e, before)]
    if not enabled_ones:
        return before[name] == after[name]
    return any(e["to"] == after[name] for e in enabled_ones)


def explained(
    automata: Mapping[str, Sequence[Mapping[str, Any]]], before: Mapping[str, str], after: Mapping[str, str]
) -> bool:
    """True where one joint move of the model leads from one state to the other."""
    for sender, edges in automata.items():
        for edge in edges:
            if edge["sync"] == "receive" or (edge["from"], edge["to"]) != (before[sender], after[sender]):
                continue
            word = edge["word"] if edge["sync"] == "send" else None
            others = (name for name in automata if name != sender)
            if enabled(edge, before) and all(takes_part(automata[n], before, after, n, word) for n in others):
                return True
    return False


class MissionTest(unittest.TestCase):
    """One mission for all tests: it is played once, then judged."""

    folder = ""
    expected: Dict[str, Any]
    record: Record
    events: rospy.Publisher

    @classmethod
    def setUpClass(cls) -> None:
        with open(os.path.join(cls.folder, "expected.json"), "rb") as file:
            cls.expected = read_json(file.read())
        init_node("mission_test")
        cls.record = Record(cls.expected["robots"])
        cls.events = rospy.Publisher("pursue/events", String, queue_size=10)
        nodes = set(cls.expected["nodes"])
        if not cls.record.wait(lambda: nodes <= cls.record.ready, CONNECTED):
            raise AssertionError(f"not ready after {CONNECTED} s: {sorted(nodes - cls.record.ready)}")
        if not cls.record.wait(lambda: cls.record.states, CONNECTED):
            raise AssertionError(f"no state of the observer was received within {CONNECTED} s")
        cls.start()
        if cls.expected["reach"]:
            cls.record.wait(cls.record.ended, rospy.get_param("~patience"))
        else:
            cls.play_on(rospy.get_param("~units") * rospy.get_param("~time_unit"))

    @classmethod
    def start(cls) -> None:
        """Publish `_start_` until a state answers it: what is published before the observer has connected is lost."""
        for _ in range(int(CONNECTED)):
            cls.events.publish("_start_")
            if cls.record.wait(lambda: cls.record.status != "waiting", 1.0):
                break

    @classmethod
    def play_on(cls, seconds: float) -> None:
        """End a mission that has only to stay safe, after so many seconds of ROS time."""
        end = rospy.get_time() + seconds
        while rospy.get_time() < end and not cls.record.ended():
            rospy.sleep(0.5)
        cls.events.publish("Finish!")
        cls.record.wait(cls.record.ended, ANSWERED)

    def test_mission_ends_well(self) -> None:
        """It reaches its goal, and without one it is still safe when it is ended."""
        self.assertEqual(self.record.status, "won", f"states: {len(self.record.states)}, events: {self.record.events}")

    def test_mission_stays_safe(self) -> None:
        for name, location in places_of(self.expected["bad"]):
            self.assertNotIn(location, [state[name] for state in self.record.states.values()])

    def test_every_controller_commands_its_own(self) -> None:
        allowed = self.expected["commands"]
        for node, word in self.record.events:
            if node in allowed and not event_in(word).startswith("_"):
                self.assertIn(event_in(word), allowed[node], f"{node} published {word}")
        for node, robot in self.record.commands:
            self.assertEqual(node, self.expected["robots"][robot], f"{robot} was commanded by {node}")

    def test_no_controller_publishes_an_end(self) -> None:
        ends = set(self.expected["ends"])
        published = [(node, word) for node, word in self.record.events if node in self.expected["commands"]]
        self.assertEqual([(node, word) for node, word in published if event_in(word) in ends], [])

    def test_every_step_is_a_step_of_the_model(self) -> None:
        """So every rule is kept: an event that a rule names comes only in its turn."""
        seqs = sorted(seq for seq in self.record.states if seq > 0)
        self.assertEqual(seqs, list(range(1, len(seqs) + 1)), "states were missed")
        for seq in seqs[:-1]:
            before, after = self.record.states[seq], self.record.states[seq + 1]
            self.assertTrue(explained(self.expected["automata"], before, after), f"{seq}: {before} to {after}")



def main(package: Package) -> int:
    """Plays the mission and judges it; the result goes where rostest looks for it. Returns the exit status."""
    MissionTest.folder = os.path.dirname(os.path.abspath(package.script))
    rostest.rosrun(package.name, "mission", MissionTest, sys.argv)
    return 0
