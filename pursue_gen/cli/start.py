"""The program `pursue-gen`: says which packages are missing or too old before anything imports them."""

from __future__ import annotations

import atexit
import gc
import sys

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

    # What is imported stays until the end, and then all memory goes: nothing of it has to be searched for garbage.
    gc.freeze()
    atexit.register(gc.disable)
    run()
