"""The command that the observer of a mission runs where the plan in force does not know what to do."""

from __future__ import annotations

import json
import sys

from pursue_gen.cli.console import guarded
from pursue_gen.diagnostics import usage_error


@guarded
def replan() -> None:
    """Make a new plan for a mission that is under way: a request in JSON on stdin, its answer on stdout.

    The observer of a workspace runs it; docs/run_time.md says what requests and answers hold. Every plan has been
    proven. The exit status is 0 also where there is none, 2 for a request that cannot be used.
    """
    from pursue_gen.replanning import replan as answer

    try:
        request = json.loads(sys.stdin.buffer.read().decode("utf-8"))
    except (ValueError, RecursionError) as problem:
        raise usage_error(f"the request is not JSON: {problem}", "see docs/run_time.md, 'Planning again'") from None
    print(json.dumps(answer(request)))
