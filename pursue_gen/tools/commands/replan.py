"""The command that the observer of a mission runs where the plan in force does not know what to do."""

from __future__ import annotations

import json
import os
import select
import sys
import threading

from pursue_gen.cli.console import guarded
from pursue_gen.diagnostics import usage_error
from pursue_gen.outcomes import BROKEN_PIPE


@guarded
def replan() -> None:
    """Make a new plan for a mission that is under way: a request in JSON on stdin, its answer on stdout.

    The observer of a workspace runs it; docs/run_time.md says what requests and answers hold. Every plan has been
    proven. The exit status is 0 also where there is none, 2 for a request that cannot be used, and 141 where nobody
    reads the answer any more.
    """
    from pursue_gen import api
    from pursue_runtime.bounded import DATA, BadText, read_json

    threading.Thread(target=_end_with_reader, daemon=True).start()
    try:
        request = read_json(sys.stdin.buffer.read(DATA.size + 1))
    except BadText as problem:
        hint = "see docs/run_time.md, 'game.yaml, and what a planner is asked'"
        raise usage_error(f"the request cannot be read: {problem}", hint) from None
    print(json.dumps(api.replan(request)))


def _end_with_reader() -> None:
    """End the process when the other end of its stdout is closed: an observer that was killed cannot end it."""
    stdout = select.poll()
    stdout.register(1, 0)  # errors and hang-ups alone
    stdout.poll()
    os._exit(BROKEN_PIPE)
