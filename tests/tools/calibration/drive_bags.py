"""Bags of drives for tests, and drives whose times are drawn at random."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from random import Random
from typing import Iterable, List, Mapping, Optional, Sequence, Tuple

from rosbags.rosbag1 import Writer

from pursue_runtime.drives.report import Drive, format_drive

FLOOR = """\
// the floor of the tests
poi "desk"
poi "shelf"
connect desk and shelf distance 4
event "fetch" location shelf duration 3
agent "bot" controllable mobile 1 location desk can_do fetch
travel bot from desk to shelf takes 3 to 5 // paced
reach_objective: do fetch within 20
"""


def write_drives(path: Path, drives: Iterable[Drive], game: Optional[Mapping[str, object]] = None) -> Path:
    """Writes a bag with these drives, with the Python package rosbags."""
    texts = [] if game is None else [("/pursue/game", json.dumps(game))]
    texts += [("/pursue/drives", format_drive(drive)) for drive in drives]
    with Writer(path) as writer:
        topics = {
            topic: writer.add_connection(
                topic, "std_msgs/msg/String", msgdef="string data", md5sum="0" * 32, callerid="/drive_legs", latching=0
            )
            for topic in sorted({topic for topic, _ in texts})
        }
        for number, (topic, text) in enumerate(texts):
            data = text.encode()
            writer.write(topics[topic], (100 + number) * 10**9, struct.pack("<L", len(data)) + data)
    return path


def drives(robot: str, way: Tuple[str, str], seconds: Sequence[float], start: float = 100.0) -> List[Drive]:
    """Drives on one way, one after the other."""
    found: List[Drive] = []
    for took in seconds:
        found.append(Drive(robot, *way, start, start + took))
        start += took + 1
    return found


def noisy(mean: float, count: int, seed: int) -> List[float]:
    """Times of drives: around the mean, and now and then longer."""
    random = Random(seed)
    return [mean * random.lognormvariate(0.0, 0.08) for _ in range(count)]
