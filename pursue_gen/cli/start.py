"""The program `pursue-gen`: says which packages are missing or too old before anything imports them."""

from __future__ import annotations

import atexit
import gc
import os
import sys
from typing import Any

from pursue_gen.needs import NEEDS
from pursue_gen.outcomes import Unavailable
from pursue_runtime.needs import NeedError, require


def main() -> None:
    """Runs the command line, if all that it needs is here."""
    try:
        require(*NEEDS)
    except NeedError as problem:
        print(f"pursue-gen: {problem}\n    help: {problem.hint}", file=sys.stderr)
        sys.exit(Unavailable.exit_status)
    from pursue_gen.cli.app import main as run

    gc.freeze()  # what is imported stays until the end: nothing of it has to be searched for garbage
    leave = _Leave()
    atexit.register(leave)  # before all others, so it is called after them
    try:
        run()
    except SystemExit as end:
        leave.status = end.code
        raise


class _Leave:
    """Ends the process with a status, once its last output is written: the system takes all memory back at once, where
    Python would free a large strategy value by value. Without a status the process ends as Python has it."""

    def __init__(self) -> None:
        self.status: Any = ""

    def __call__(self) -> None:
        status = 0 if self.status is None else self.status
        if not isinstance(status, int):
            return
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        except (OSError, ValueError, AttributeError):  # Python says what is wrong with them
            return
        os._exit(status & 0xFF)
