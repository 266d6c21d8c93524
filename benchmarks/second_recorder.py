"""A second record of a mission, and a third: rosbag's own recorder, there before any node, and the observer's journal.

A recorder may miss what a node publishes that is killed at once or has just started. What either recorder has was
published. A word that the observer alone has was published as well, by nobody knows whom: its journal holds what it has
heard, apart from what it does by itself. What nobody has counts as not published.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Callable, Dict, Iterable, List, Sequence, Set, Tuple, TypeVar

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.replay import read_recording
from pursue_gen.tools.replay.journal import Journal
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord, RobotOrder, read_word
from pursue_runtime.state import SystemState

NAME = "record_second"
"""Its node: a name that begins as rosbag's own does, so that no controller takes it for the side of a robot."""

SAME = 1.0
"""Seconds by which two recorders may receive one message apart."""

HEARD = 10.0
"""Seconds by which the observer may have taken a word apart from when it was recorded."""

Received = TypeVar("Received", RecordedWord, RobotOrder)


def topics_of(robots: Iterable[str]) -> List[str]:
    """Return the topics of a mission with these robots: words, states, plans, and orders."""
    orders = [f"/{robot}/{kind}" for robot in robots for kind in ("move_base_simple/goal", "pursue/actions")]
    return ["/pursue/events", "/pursue/system_state", "/pursue/plan", *orders]


def command(file: Path, topics: Sequence[str]) -> List[str]:
    """Return the command that records these topics in the file: rosbag's program in C++, which connects quickly."""
    options = ["--output-name", str(file), "--buffsize", "0", "--tcpnodelay"]
    return ["rosrun", "rosbag", "record", *options, *topics, f"__name:={NAME}"]


def bag_of(path: Path) -> Path:
    """Return the bag, also one that was not closed; the path itself where there is none."""
    active = path.with_name(f"{path.name}.active")
    return active if active.is_file() and not path.is_file() else path


def heard_in(journals: Iterable[Path]) -> List[RecordedWord]:
    """Return the words that the observer has taken, by its journals; a file that is no journal, or in which nothing
    has happened yet, has none."""
    words: List[RecordedWord] = []
    for path in journals:
        try:
            journal = read_recording(path)
        except PursueError:
            continue
        assert isinstance(journal, Journal)
        heard = [entry for entry in journal.entries if entry.call == "hear" and entry.args]
        words += [read_word(entry.at, str(entry.args[0])) for entry in heard]
    return sorted(words, key=lambda word: word.at)


def merged(first: MissionRecord, second: MissionRecord) -> MissionRecord:
    """Return what either recorder has: the first one's recording with what it has missed."""
    words = [*first.words, *_missed(first.words, second.words, lambda word: (word.text, word.node), SAME)]
    orders = [*first.orders, *_missed(first.orders, second.orders, lambda order: replace(order, at=0.0), SAME)]
    known = {_key(state) for state in first.states}
    states = [*first.states, *(state for state in second.states if _key(state) not in known)]
    return replace(
        first,
        states=tuple(sorted(states, key=lambda state: (state.seq, state.stamp))),
        words=tuple(sorted(words, key=lambda word: word.at)),
        orders=tuple(sorted(orders, key=lambda order: order.at)),
        plans={**second.plans, **first.plans},
        problems=(*first.problems, *(f"second recorder: {problem}" for problem in second.problems)),
        whole_from=-math.inf,
        received={
            seq: min(record.received.get(seq, math.inf) for record in (first, second))
            for seq in {**first.received, **second.received}
        },
    )


def with_heard(record: MissionRecord, heard: Sequence[RecordedWord]) -> Tuple[MissionRecord, Tuple[RecordedWord, ...]]:
    """Return the record with the words that the observer has heard and no recorder has, and those words."""
    gaps = tuple(_missed(record.words, heard, lambda word: word.text, HEARD))
    words = sorted([*record.words, *gaps], key=lambda word: word.at)
    return replace(record, words=tuple(words)), gaps


def _key(state: SystemState) -> Tuple[object, ...]:
    return state.seq, state.stamp, state.status, state.reason


def _missed(
    first: Sequence[Received], second: Sequence[Received], content: Callable[[Received], object], apart: float
) -> List[Received]:
    """Return what the second has and the first has not: the nearest with one content, not more than so many seconds
    apart, are one message."""
    known: Dict[object, List[int]] = {}
    for place, each in enumerate(first):
        known.setdefault(content(each), []).append(place)
    pairs = [
        (abs(first[other].at - each.at), place, other)
        for place, each in enumerate(second)
        for other in known.get(content(each), ())
        if abs(first[other].at - each.at) <= apart
    ]
    taken: Set[int] = set()
    found: Set[int] = set()
    for _, place, other in sorted(pairs):
        if place not in found and other not in taken:
            found.add(place)
            taken.add(other)
    return [each for place, each in enumerate(second) if place not in found]
