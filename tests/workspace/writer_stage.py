"""Trees for tests of the writer, and processes that write them."""

from __future__ import annotations

import os
import traceback
from typing import Callable

from pursue_gen.diagnostics import PursueError

CALLS = ("open", "mkdir", "rename", "unlink", "rmdir", "write")
KILLED, DONE, REFUSED, FAILED = 9, 0, 2, 1

OLD = {"README.md": b"old\n", "src/a/node.py": b"#!old\n", "src/gone/x.yaml": b"goes\n", "src/same": b"same\n"}
NEW = {"README.md": b"new\n", "src/a/node.py": b"#!new\n", "src/new/deep/y.yaml": b"comes\n", "src/same": b"same\n"}
PERSON = b"by hand\n"
STRANGE = {"src/mine/x": b"mine\n", ".pursue_gen-0/x": b"mine too\n", ".pursue_gen.new/README.md": b"mine as well\n"}
"""Files of a person, also in folders whose names look like those of the writer."""


def child(work: Callable[[], None]) -> int:
    """The exit status of a process that does this."""
    process = os.fork()
    if not process:
        status = FAILED
        try:
            work()
            status = DONE
        except PursueError as problem:
            status = REFUSED
            assert all(finding.message for finding in problem.diagnostics)
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)
    return os.WEXITSTATUS(os.waitpid(process, 0)[1])
