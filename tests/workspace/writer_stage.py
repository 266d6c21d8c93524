"""Trees for tests of the writer, and processes that write them."""

from __future__ import annotations

import functools
import os
import pickle
import subprocess
import sys
import traceback
from pathlib import Path
from typing import Any, Callable, Mapping, Tuple

from pursue_gen.diagnostics import PursueError
from pursue_gen.workspace import writer

CALLS = ("open", "mkdir", "rename", "unlink", "rmdir", "write")
KILLED, DONE, REFUSED, FAILED = 9, 0, 2, 1

OLD = {"README.md": b"old\n", "src/a/node.py": b"#!old\n", "src/gone/x.yaml": b"goes\n", "src/same": b"same\n"}
NEW = {"README.md": b"new\n", "src/a/node.py": b"#!new\n", "src/new/deep/y.yaml": b"comes\n", "src/same": b"same\n"}
PERSON = b"by hand\n"
STRANGE = {"src/mine/x": b"mine\n", ".pursue_gen-0/x": b"mine too\n", ".pursue_gen.new/README.md": b"mine as well\n"}
"""Files of a person, also in folders whose names look like those of the writer."""


def child(work: Callable[..., None], *arguments: Any) -> int:
    """The exit status of a process that does this; `work` is a function of this module.

    Its parent is a small process: a copy of this one, which has all tests in it, would cost many times as much.
    """
    server = _server()
    assert server.stdin is not None and server.stdout is not None
    pickle.dump((work, arguments), server.stdin)
    server.stdin.flush()
    return int(server.stdout.readline())


@functools.lru_cache(maxsize=None)
def _server() -> "subprocess.Popen[bytes]":
    """The parent of all children; it ends with this process."""
    here = Path(__file__).resolve().parent
    path = os.pathsep.join([str(here), str(here.parent.parent)])
    return subprocess.Popen(
        [sys.executable, "-c", f"import {__name__}; {__name__}.serve()"],
        env={**os.environ, "PYTHONPATH": path},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )


def serve() -> None:
    """Makes a child for each pickled call on standard input, and writes its exit status, until there are no more."""
    while True:
        try:
            work, arguments = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        print(_status(work, arguments), flush=True)


def _status(work: Callable[..., None], arguments: Tuple[Any, ...]) -> int:
    process = os.fork()
    if not process:
        status = FAILED
        try:
            work(*arguments)
            status = DONE
        except PursueError as problem:
            status = REFUSED
            assert all(finding.message for finding in problem.diagnostics)
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)
    return os.WEXITSTATUS(os.waitpid(process, 0)[1])


def write_until_killed(files: Mapping[str, bytes], folder: Path, call: int, force: bool) -> None:
    """Writes the files, and is killed at this call; a file is half written then."""
    left = [call]

    def killing(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
        def run(*args: Any, **named: Any) -> Any:
            left[0] -= 1
            if left[0] < 0:
                if name == "write":
                    real(args[0], args[1][: len(args[1]) // 2])
                os._exit(KILLED)
            return real(*args, **named)

        return run

    for name in CALLS:
        setattr(os, name, killing(name, getattr(os, name)))
    writer.write_tree(files, folder, force)


def write_over_planted_link(files: Mapping[str, bytes], folder: Path, call: int, link: Path, foreign: Path) -> None:
    """Writes the files; before the call of this number that changes something, what is there is moved for a link."""
    left = [call]

    def planting(real: Callable[..., Any]) -> Callable[..., Any]:
        def run(*args: Any, **named: Any) -> Any:
            left[0] -= 1
            if left[0] == -1:
                link.rename(link.with_name(link.name + ".moved"))
                link.symlink_to(foreign / "README.md" if link.suffix else foreign)
            return real(*args, **named)

        return run

    for name in set(CALLS) - {"rename"}:
        setattr(os, name, planting(getattr(os, name)))
    writer.write_tree(files, folder)
