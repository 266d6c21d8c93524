"""What is recorded of a mission, and in which file. Without ROS."""

from __future__ import annotations

import errno
import os
from itertools import count
from types import MappingProxyType
from typing import Callable, Collection, Iterator, List, Mapping, Sequence

from pursue_runtime.event_words import EVENTS, PLAN, STATE, SYSTEM_STATE
from pursue_runtime.model import Model

OF_A_ROBOT = (
    "move_base_simple/goal",
    "pursue/actions",
    "move_base/goal",
    "move_base/cancel",
    "move_base/result",
    "move_base_flex/move_base/goal",
    "move_base_flex/move_base/cancel",
    "move_base_flex/move_base/result",
    "amcl_pose",
)
"""Topics of each robot; those that nobody publishes cost nothing."""

ACTIVE = ".active"
"""What ends the name of a bag that is being written."""

_NO_LINKS = (errno.EPERM, errno.EOPNOTSUPP, errno.ENOTSUP, errno.ENOSYS, errno.EMLINK)
"""What file systems without hard links answer, such as FAT."""

GAME = "pursue/game"
"""Only in the recording: the scenario and the rules of the game, so that nothing else is needed to check it, and the
`namespaces` of robots that have another one than their name."""


def topics(model: Model, simulated_time: bool, namespaces: Mapping[str, str] = MappingProxyType({})) -> List[str]:
    """The names of the topics, so that the first message on each is not missed. `namespaces`: those of robots that have
    another one than their name."""
    robots = [namespaces.get(robot.name, robot.name) for robot in model.of_kind("robot")]
    of_robots = [f"{robot}/{topic}" if robot else topic for robot in robots for topic in OF_A_ROBOT]
    names = [EVENTS, STATE, SYSTEM_STATE, PLAN, *of_robots]
    return [*names, "/diagnostics", *(["/clock"] if simulated_time else [])]


def reserve_file(wanted: str, folder: str) -> str:
    """The path of a new bag: the wanted one, `mission.bag` in the folder for none, or where that is taken
    the next with a number. What is being written stands in `<path>.active`, which is made here: no two recorders get
    the same. Raises OSError.
    """
    path = os.path.abspath(os.path.expanduser(wanted)) if wanted else os.path.join(folder, "mission.bag")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    return next(free for free in _names(path) if not os.path.lexists(free) and _is_made(free + ACTIVE))


def keep_file(path: str) -> str:
    """Give what was written in `<path>.active` its name, and return that: the path, or the next with a number where
    something is there by now, which stays as it is. Raises OSError.
    """
    written = path + ACTIVE
    return next(
        free
        for free in _names(path)
        if (free == path or not os.path.lexists(free + ACTIVE)) and _is_taken(free, written)
    )


def _names(path: str) -> Iterator[str]:
    """The path, then with numbers."""
    stem, ending = os.path.splitext(path)
    yield path
    yield from (f"{stem}-{number}{ending}" for number in count(2))


def _is_made(path: str) -> bool:
    """True where an empty file was made; False where something is there. Raises OSError."""
    try:
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    except FileExistsError:
        return False
    return True


def _is_taken(name: str, written: str) -> bool:
    """True where the written file has this name now; False where something else has it. Raises OSError."""
    try:
        os.link(written, name)  # replaces nothing, as a rename would
    except FileExistsError:
        return False
    except OSError as problem:
        if problem.errno not in _NO_LINKS:
            raise
        if not _is_made(name):
            return False
        os.replace(written, name)  # what it replaces was made here, and is empty
        return True
    os.unlink(written)
    return True


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
