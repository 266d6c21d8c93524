"""The process of a node: its priority, and how its program begins anew."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from pathlib import Path
from types import MappingProxyType
from typing import Mapping, NoReturn

from pursue_runtime.nodes.node import Ending

LOWER = 5
"""By how much the nice value of nodes is raised that decide nothing about robots."""

ANEW = "PURSUE_ANEW"
"""In the environment of a node that has begun anew."""


def restart_process(environment: Mapping[str, str] = MappingProxyType({})) -> NoReturn:
    """Starts the node's program again in the same process: for roslaunch, which may end with it, it has never ended.

    `environment` is added to that of the process.
    """
    for sign in (signal.SIGINT, signal.SIGTERM):
        signal.signal(sign, signal.SIG_DFL)
    sys.stdout.flush()
    os.execve(sys.executable, [sys.executable, *sys.argv], {**os.environ, ANEW: "yes", **environment})


def run_to_end(ending: Ending) -> int:
    """Wait until the mission ends; return the exit status. Where another mission is prepared, the node begins anew."""
    status = ending.wait(linger=0.2)
    if ending.renewed:
        restart_process()
    return status


def lower_priority() -> None:
    """Lower the priority of this process, once: nodes that decide about robots come first.

    Where the kernel shares the processor among sessions (autogroup), nice counts within a session only, and roslaunch
    starts each node in its own: then the priority of the session is lowered as well.
    """
    if ANEW not in os.environ:
        os.nice(LOWER)
        if os.getsid(0) == os.getpid():
            with contextlib.suppress(OSError, ValueError):  # there are no such groups
                _lower_session(Path("/proc/self/autogroup"))


def _lower_session(autogroup: Path) -> None:
    """Lower the priority of our session. Raises OSError and ValueError."""
    level = int(autogroup.read_text().rpartition(" ")[2]) + LOWER
    for _ in range(20):
        try:
            autogroup.write_text(str(min(level, 19)))
            return
        except BlockingIOError:  # the kernel lets one process do so in a tenth of a second
            time.sleep(0.1)
