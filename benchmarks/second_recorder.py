"""A second recorder of a mission, which shares nothing with the first one: a process of its own, there before any node.

A recorder may miss what a node publishes that is killed at once or has just started. `python -m
benchmarks.second_recorder FILE TOPIC…` writes what it receives to FILE, a line of JSON for each message. What either
recorder has was published; what neither has counts as not published.
"""

from __future__ import annotations

import base64
import json
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, List, Sequence, Set, Tuple, TypeVar

from pursue_gen.replay.bag import Message
from pursue_gen.replay.read import from_messages
from pursue_gen.replay.record import MissionRecord, RecordedWord, RobotOrder
from pursue_runtime.state import SystemState

SAME = 1.0
"""Seconds by which two recorders may receive one message apart."""

READY = "ready"
"""The first line: it has subscribed to everything."""

Received = TypeVar("Received", RecordedWord, RobotOrder)


def topics_of(robots: Iterable[str]) -> List[str]:
    """Return the topics of a mission with these robots: words, states, plans, and orders."""
    orders = [f"/{robot}/{kind}" for robot in robots for kind in ("move_base_simple/goal", "pursue/actions")]
    return ["/pursue/events", "/pursue/system_state", "/pursue/plan", *orders]


def read_second(path: Path) -> MissionRecord:
    """Return what the second recorder has; its last line may be cut. Raises OSError."""
    messages: List[Message] = []
    for line in path.read_bytes().splitlines(keepends=True)[1:]:
        if line.endswith(b"\n"):
            topic, kind, node, at, data = json.loads(line)
            messages.append(Message(topic, kind, node, at, base64.b64decode(data)))
    return from_messages(messages)


def merged(first: MissionRecord, second: MissionRecord) -> MissionRecord:
    """Return what either recorder has: the first one's recording with what it has missed."""
    words = [*first.words, *_missed(first.words, second.words, lambda word: (word.text, word.node))]
    orders = [*first.orders, *_missed(first.orders, second.orders, lambda order: replace(order, at=0.0))]
    known = {_key(state) for state in first.states}
    states = [*first.states, *(state for state in second.states if _key(state) not in known)]
    return replace(
        first,
        states=tuple(sorted(states, key=lambda state: (state.seq, state.stamp))),
        words=tuple(sorted(words, key=lambda word: word.at)),
        orders=tuple(sorted(orders, key=lambda order: order.at)),
        plans={**second.plans, **first.plans},
    )


def _key(state: SystemState) -> Tuple[object, ...]:
    return state.seq, state.stamp, state.status, state.reason


def _missed(
    first: Sequence[Received], second: Sequence[Received], content: Callable[[Received], object]
) -> List[Received]:
    """Return what the second has and the first has not: the nearest with one content are one message."""
    known: Dict[object, List[int]] = {}
    for place, each in enumerate(first):
        known.setdefault(content(each), []).append(place)
    pairs = [
        (abs(first[other].at - each.at), place, other)
        for place, each in enumerate(second)
        for other in known.get(content(each), ())
        if abs(first[other].at - each.at) <= SAME
    ]
    taken: Set[int] = set()
    found: Set[int] = set()
    for _, place, other in sorted(pairs):
        if place not in found and other not in taken:
            found.add(place)
            taken.add(other)
    return [each for place, each in enumerate(second) if place not in found]


def main() -> int:
    """Record until the process is ended."""
    import rospy

    path, *topics = sys.argv[1:]
    lock = threading.Lock()
    with open(path, "w", encoding="utf-8") as file:

        def write(what: Any) -> None:
            with lock:
                file.write(json.dumps(what) + "\n")
                file.flush()

        def received(message: Any, topic: str) -> None:
            header: Dict[str, str] = message._connection_header
            data = base64.b64encode(message._buff).decode()
            write([topic, header.get("type", ""), header.get("callerid", "").strip("/"), time.time(), data])

        rospy.init_node("second_recorder", disable_signals=True)
        for topic in topics:
            rospy.Subscriber(topic, rospy.AnyMsg, received, topic, tcp_nodelay=True)
        write(READY)
        threading.Event().wait()
    return 0


if __name__ == "__main__":
    sys.exit(main())
