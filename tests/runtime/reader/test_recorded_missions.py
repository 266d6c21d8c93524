"""Somebody has recorded all that ever went to a robot. It is of no use to him."""

from __future__ import annotations

import random
from pathlib import Path
from typing import List

from tests.runtime.reader_stage import Robot, message, mission

EARLIER, LATER = mission("earlier"), mission("later")


def test_who_has_recorded_everything_cannot_bring_an_earlier_mission_back(tmp_path: Path) -> None:
    """Neither in the order in which it was said, nor in any other, nor after the robot was started again."""
    robot = Robot(tmp_path)
    robot.state("waiting")
    recorded: List[str] = []
    for made in (EARLIER, LATER):
        for action, bundle in (("prepare", made.bundle), ("commit", b"")):
            recorded.append(message(action, made.digest, robot.reader.ticket, bundle))
            assert robot.reader.on_message(recorded[-1], robot.now).ok
    assert robot.current == LATER.digest
    mixed = recorded * 10
    random.Random(1).shuffle(mixed)
    for text in recorded + mixed:
        assert robot.reader.on_message(text, robot.now).code == "old_ticket"
    robot.restart()
    for text in recorded + mixed:
        assert robot.reader.on_message(text, robot.now).code == "old_ticket"
    assert (robot.current, robot.reader.status()["prepared"]) == (LATER.digest, None)


def test_what_was_recorded_at_one_robot_is_nothing_to_another(tmp_path: Path) -> None:
    """Not even where the other one were to give out the same ticket."""
    robot = Robot(tmp_path)
    text = message("prepare", EARLIER.digest, robot.reader.ticket, EARLIER.bundle, robot="bot2")
    assert robot.reader.on_message(text, robot.now).code == "wrong_robot"
    assert robot.store.kept() == []
