"""Launches a mission, waits for its end, and exits with the verdict: `rosrun <scenario>_bringup run_mission`.

For systemd, cron and other supervisors: roslaunch itself exits with 0 however the mission ended.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from typing import Dict, List, Optional, Sequence, Tuple

from pursue_runtime.data import Package
from pursue_runtime.state import LOST, STOPPED, WON
from pursue_runtime.ui.verdict import INTERRUPTED, NOT_STARTED, Verdict, read_verdict

FAILED = "launch failed"
STATUSES: Dict[str, int] = {WON: 0, LOST: 1, STOPPED: 2, NOT_STARTED: 3, INTERRUPTED: 4, FAILED: 5}
"""outcome → exit status."""

USAGE = """rosrun {bringup} run_mission [NAME:=VALUE...]

Launches mission.launch with these arguments, waits for the end of the mission, prints in one line how it ended, and
exits with
  0  won: the goal is reached, or the safety objectives were kept to the end
  1  lost: the safety objective is broken
  2  stopped: a safe stop, or _stop_ was published
  3  not started: a node was not ready in time, or its settings are wrong
  4  interrupted: by SIGINT or SIGTERM
  5  launch failed: wrong arguments, or roslaunch ended without a verdict
SIGINT and SIGTERM end the launch with all its nodes. `roslaunch --ros-args {bringup} mission.launch` lists the
arguments."""

_ARGUMENT = re.compile(r"\w+:=.*", re.ASCII | re.DOTALL)
_OURS = {"verdict": "it is set here", "again": "one mission is played", "stay": "the page ends with the mission",
         "required": "the launch ends with the UI"}


def main(package: Package) -> int:
    """Launches the mission of the package with the launch files; returns the exit status."""
    arguments = sys.argv[1:]
    if {"-h", "--help"} & set(arguments):
        print(USAGE.format(bringup=package.name))
        return 0
    problem = refusal(arguments)
    if problem:
        return _concluded(Verdict(FAILED, problem))
    with tempfile.TemporaryDirectory(prefix="mission-") as folder:
        path = os.path.join(folder, "verdict")
        command = ["roslaunch", "--skip-log-check", package.name, "mission.launch", "stay:=false", *arguments]
        command.append(f"verdict:={path}")
        try:
            status, stopped_by = play([*_tied(), *command], path)
        except OSError as failure:
            return _concluded(Verdict(FAILED, f"roslaunch cannot be run: {failure}"))
        return _concluded(conclude(read_verdict(path), status, stopped_by))


def refusal(arguments: Sequence[str]) -> str:
    """Why these arguments cannot be passed to mission.launch; "" where they can."""
    for argument in arguments:
        name, _, value = argument.partition(":=")
        if not _ARGUMENT.fullmatch(argument):
            return f"{argument!r} is not an argument; expected NAME:=VALUE"
        if name in _OURS:
            return f"{name} is not an argument here: {_OURS[name]}"
        if name == "nodes" and not {"all", "UI"} & set(value.replace(",", " ").split()):
            return f"{argument!r} starts no UI, which gives the verdict; expected nodes:=all, or UI among the nodes"
    return ""


def play(command: Sequence[str], verdict: str) -> Tuple[int, str]:
    """Run the command to its end; return its exit status, and the name of the signal that ended it ("" for none).

    A signal to this process interrupts the command, which then ends its nodes. A signal that comes after the verdict
    has been written has ended nothing. Raises OSError.
    """
    received: List[str] = []

    def note(sign: int, _: object) -> None:
        received.append("" if os.path.exists(verdict) else signal.Signals(sign).name)

    # A signal that comes in the moment before a process waits for another one does not end the wait; a byte does.
    woken, waking = socket.socketpair()
    waking.setblocking(False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    for sign in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(sign, note)
    with woken, waking:
        signal.set_wakeup_fd(waking.fileno(), warn_on_full_buffer=False)
        try:
            # In a session of its own: Ctrl-C reaches it once, from here.
            process = subprocess.Popen(command, start_new_session=True)
            interrupted = False
            while process.poll() is None:
                if received and not interrupted:  # roslaunch ends its nodes on the first one
                    process.send_signal(signal.SIGINT)
                    interrupted = True
                woken.recv(4096)
        finally:
            signal.set_wakeup_fd(-1)
    return process.returncode, received[0] if received else ""


def conclude(verdict: Optional[Verdict], status: int, stopped_by: str) -> Verdict:
    """Return the verdict of a launch: what the UI has written, the signal, and the exit status of roslaunch."""
    if stopped_by and (verdict is None or verdict.outcome not in (WON, LOST)):
        return Verdict(INTERRUPTED, f"{stopped_by} was received before the mission ended.")
    return verdict or Verdict(FAILED, f"roslaunch exited with status {status}, and the UI has given no verdict.")


def _concluded(verdict: Verdict) -> int:
    """Prints the verdict; returns its exit status."""
    print(f"{verdict.outcome}: {verdict.sentence}", flush=True)
    return STATUSES[verdict.outcome]


def _tied() -> List[str]:
    """The words that have a command ended when this process is killed."""
    setpriv = shutil.which("setpriv")
    return [setpriv, "--pdeathsig", "TERM"] if setpriv else []
