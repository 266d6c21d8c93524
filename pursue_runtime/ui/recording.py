"""What is recorded of a mission, and in which file. Without ROS."""

from __future__ import annotations

import os
from typing import Callable, Collection, List, Mapping, Sequence

from pursue_runtime.model import Model
from pursue_runtime.words import EVENTS, PLAN, STATE, SYSTEM_STATE

OF_A_ROBOT = (
    "move_base_simple/goal",
    "pursue/actions",
    "move_base/goal",
    "move_base/cancel",
    "move_base/result",
    "amcl_pose",
)
"""Topics of each robot; those that nobody publishes cost nothing."""

GAME = "pursue/game"
"""Only in the recording: the scenario and the rules of the game, so that nothing else is needed to check it."""


def topics(model: Model, simulated_time: bool) -> List[str]:
    """The names of the topics, so that the first message on each is not missed."""
    robots = [robot.name for robot in model.of_kind("robot")]
    names = [EVENTS, STATE, SYSTEM_STATE, PLAN, *(f"{robot}/{topic}" for robot in robots for topic in OF_A_ROBOT)]
    return [*names, "/diagnostics", *(["/clock"] if simulated_time else [])]


def reserve_file(wanted: str, folder: str) -> str:
    """The path of a new bag: the wanted one, `mission.bag` in the folder for none, or where that is taken
    the next with a number. What is being written stands in `<path>.active`, which is made here: no two recorders get
    the same. Raises OSError.
    """
    path = os.path.abspath(os.path.expanduser(wanted)) if wanted else os.path.join(folder, "mission.bag")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    stem, ending = os.path.splitext(path)
    number = 1
    while True:
        free = path if number == 1 else f"{stem}-{number}{ending}"
        number += 1
        if os.path.lexists(free):
            continue
        try:
            os.close(os.open(free + ".active", os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        except FileExistsError:
            continue
        return free


def missing_connections(
    nodes: Sequence[str],
    publishers: Mapping[str, Collection[str]],
    connected: Mapping[str, int],
    is_gone: Callable[[str], bool],
) -> str:
    """Why the recording would not be complete yet, "" where it would.

    `nodes` are those of the mission; `publishers` are the nodes on each of our topics, as the master knows them,
    `connected` how many of them we are connected to. The master also knows nodes that were killed: `is_gone` says
    which of them do not live any more.
    """
    present = {node.strip("/") for names in publishers.values() for node in names}
    absent = [node for node in nodes if node.strip("/") not in present]
    if absent:
        return f"nothing from {', '.join(absent)} yet"
    for topic, names in publishers.items():
        number = connected.get(topic, 0)
        if number < len(names) and number < sum(not is_gone(name) for name in names):
            return f"not connected to everybody on {topic} yet"
    return ""
