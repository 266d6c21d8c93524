"""The nodes of the reaction benchmark, each a process: `python -m benchmarks.reaction_nodes ROLE …`.

`relay IN OUT` passes Strings on. `thesis_observer` and `thesis_controller` are the thesis's scheme for the same task,
rebuilt from its text (listings 4.2 and B.9 to B.14): the controller polls the state every 0.1 s, pings, waits
another 0.1 s for the state, checks again, and then publishes to robot and observer. `probe EVENTS THESIS_EVENTS`
measures, and prints a JSON object.
"""

from __future__ import annotations

import json
import random
import sys
import threading
import time
from typing import Any, Callable, Dict, List

import rospy
from std_msgs.msg import String

TIMEUNIT = 0.1
"""The thesis's polling period, in seconds."""

EVENTS, STATE, ACTIONS = "pursue/events", "pursue/system_state", "pursue/actions"
PATIENCE = 3.0


def relay(source: str, target: str) -> None:
    """A callback that publishes, and nothing else."""
    rospy.init_node("relay", anonymous=True)
    out = rospy.Publisher(target, String, queue_size=100, tcp_nodelay=True)
    rospy.Subscriber(source, String, lambda message: out.publish(message.data), queue_size=100, tcp_nodelay=True)
    rospy.spin()


def thesis_observer() -> None:
    """Takes every event, moves its automata, and publishes their locations and clocks."""
    rospy.init_node("observer")
    out = rospy.Publisher(STATE, String, queue_size=1)
    turn, zeros = ["turn_initial_location"], {"bot": time.time(), "guest": time.time()}

    def receive(message: Any) -> None:
        first, second = "turn_initial_location", "turn0"
        moves = {"call": (first, second, "guest"), "answer": (second, first, "bot")}
        source, target, agent = moves.get(message.data, ("", "", ""))
        if turn[0] == source:
            turn[0] = target
            zeros[agent] = time.time()
        clocks = "".join(f"\nC{name}={time.time() - zero}" for name, zero in zeros.items())
        out.publish(f"\nbot=desk\nguest=desk\nturn={turn[0]}\n\n{clocks}")

    rospy.Subscriber(EVENTS, String, receive)
    rospy.spin()


def thesis_controller() -> None:
    """Polls, pings, checks again, acts."""
    rospy.init_node("controller")
    events = rospy.Publisher(EVENTS, String, queue_size=1)
    actions = rospy.Publisher(ACTIONS, String, queue_size=1)
    known: Dict[str, str] = {}

    def update(message: Any) -> None:
        known.update(line.split("=", 1) for line in message.data.splitlines() if "=" in line)

    rospy.Subscriber(STATE, String, update)

    def due() -> bool:
        return known.get("turn") == "turn0"

    while not rospy.is_shutdown():
        time.sleep(TIMEUNIT)
        if not due():
            continue
        # optimal_wait says 0 here: both clocks are past their bounds
        events.publish("_ping_")
        time.sleep(TIMEUNIT)
        if due() and float(known["Cbot"]) > 0:
            actions.publish("answer")
            events.publish("answer")
            time.sleep(TIMEUNIT)


class Probe:
    """Publishes events and records the times of the messages that follow from them."""

    def __init__(self) -> None:
        rospy.init_node("probe")
        self.received = threading.Condition()
        self.times: Dict[str, float] = {}
        self.seq = 0
        self.unit = 1.0
        self.events = self.publisher(EVENTS)
        self.floor = self.publisher("floor/in")
        self.thesis = self.publisher(f"thesis/{EVENTS}")
        self.subscribe("floor/out", lambda text: "floor")
        self.subscribe(EVENTS, lambda text: "command" if "answer@" in text else "")
        self.subscribe(f"bot/{ACTIONS}", self.take_order)
        self.subscribe(f"thesis/{ACTIONS}", lambda text: "thesis")
        # Only until the mission runs: the nodes of the mission are what is measured, not this one.
        self.states = rospy.Subscriber(STATE, String, self.state)

    @staticmethod
    def publisher(topic: str) -> Any:
        """A publisher without delays of its own."""
        return rospy.Publisher(topic, String, queue_size=100, tcp_nodelay=True)

    def subscribe(self, topic: str, name: Callable[[str], str]) -> None:
        """Record the time of each message under the name that `name` returns; "" for none."""

        def receive(message: Any) -> None:
            now = time.perf_counter()
            with self.received:
                what = name(message.data)
                if what:
                    self.times.setdefault(what, now)
                    self.received.notify_all()

        rospy.Subscriber(topic, String, receive, queue_size=1000, tcp_nodelay=True)

    def take_order(self, text: str) -> str:
        """Acknowledge an order, as the robot's side does; the name under which its time is recorded."""
        self.events.publish(f"bot:_order_@{text.partition('@')[2]}")
        return "order"

    def state(self, message: Any) -> None:
        """The state of the mission."""
        facts = dict(part.split("=", 1) for part in message.data.split() if "=" in part)
        with self.received:
            self.seq, self.unit = int(facts.get("seq", 0)), float(facts.get("unit", 1))
            self.received.notify_all()

    def wait(self, done: Callable[[], bool], patience: float = PATIENCE) -> None:
        """Until it is so. Raises SystemExit where it does not come."""
        with self.received:
            if not self.received.wait_for(done, patience):
                raise SystemExit(f"no answer within {patience} s; came: {sorted(self.times)}, state {self.seq}")

    def timed(self, publisher: Any, text: str, *answers: str) -> List[float]:
        """Seconds from the message to each of the answers."""
        with self.received:
            self.times.clear()
        start = time.perf_counter()
        publisher.publish(text)
        self.wait(lambda: all(answer in self.times for answer in answers))
        return [self.times[answer] - start for answer in answers]

    def run(self, events: int, thesis: int) -> Dict[str, List[float]]:
        """Floor and mission in turns, so that both meet the same machine; then the thesis's scheme."""
        found: Dict[str, List[float]] = {"floor": [], "command": [], "order": [], "thesis": []}
        chance = random.Random(1)
        filler = "x" * 250  # about as long as a state
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline and not all(
            publisher.get_num_connections() for publisher in (self.events, self.floor, self.thesis)
        ):
            time.sleep(0.1)
        self.wait(lambda: self.seq > 0, 60.0)
        self.states.unregister()
        time.sleep(1.0)
        for number in range(-20, events):  # the first ones warm everything up
            floor = self.timed(self.floor, filler, "floor")
            # Both clocks have to be past 1; and nothing may be in step with anything.
            time.sleep(1.2 * self.unit + chance.random() * 0.01)
            command, order = self.timed(self.events, "guest:call", "command", "order")
            if number >= 0:
                found["floor"] += floor
                found["command"].append(command)
                found["order"].append(order)
        for _ in range(thesis):
            found["thesis"] += self.timed(self.thesis, "call", "thesis")
            time.sleep(2 * TIMEUNIT + chance.random() * TIMEUNIT)
        return found


def main(arguments: List[str]) -> None:
    """The role that the command line names."""
    role, *rest = arguments
    if role == "relay":
        relay(*rest)
    elif role == "probe":
        probe = Probe()
        print(json.dumps(probe.run(int(rest[0]), int(rest[1]))))
        rospy.signal_shutdown("done")
    else:
        {"thesis_observer": thesis_observer, "thesis_controller": thesis_controller}[role]()


if __name__ == "__main__":
    main(sys.argv[1:])
