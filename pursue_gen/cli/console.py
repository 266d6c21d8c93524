"""Output of the commands: data on stdout, everything else on stderr, and never a traceback."""

from __future__ import annotations

import functools
import os
import sys
from typing import Any, Callable, Dict, Iterable, Optional, TextIO

import typer

from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, render
from pursue_gen.outcomes import BROKEN_PIPE, INTERNAL, INTERRUPTED
from pursue_runtime.named_files import read_text

_COLOURS = {Severity.ERROR: "31", Severity.WARNING: "33"}


def info(text: str) -> None:
    """Prints a line on stderr."""
    print(text, file=sys.stderr)


def suggest(*commands: str) -> None:
    """Prints the commands that may come next, on stderr."""
    for number, command in enumerate(commands):
        info(f"{'next:' if number == 0 else '     '} {command}")


def show(diagnostics: Iterable[Diagnostic], stream: Optional[TextIO] = None) -> None:
    """Prints diagnostics with their source lines; on stderr unless another stream is given."""
    out = sys.stderr if stream is None else stream
    sources: Dict[str, Optional[str]] = {}
    for diagnostic in diagnostics:
        source = None
        if diagnostic.span is not None:
            file = diagnostic.span.file
            if file not in sources:
                sources[file] = _source(file)
            source = sources[file]
        print(_painted(diagnostic, render(diagnostic, source), out), file=out)


def ended(problem: PursueError) -> typer.Exit:
    """The end of a command, with the exit status of its outcome; the findings are printed."""
    return typer.Exit(problem.exit_status)


def guarded(command: Callable[..., None]) -> Callable[..., None]:
    """Wraps a command: its exceptions become messages and exit statuses."""

    @functools.wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        try:
            command(*args, **kwargs)
            sys.stdout.flush()
        except (typer.Exit, typer.Abort):
            raise
        except KeyboardInterrupt:
            info("interrupted")
            status = INTERRUPTED
        except PursueError as problem:
            show(problem.diagnostics)
            raise ended(problem) from None
        except BrokenPipeError:
            # What is still buffered would fail once more when the interpreter ends.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            status = BROKEN_PIPE
        except Exception as problem:
            status = _internal(problem)
        else:
            return
        raise typer.Exit(status)

    return run


def _internal(problem: Exception) -> int:
    """Print an internal error in a line and return the exit status; with PURSUE_DEBUG set, raises it."""
    if os.environ.get("PURSUE_DEBUG"):
        raise problem
    info(f"error: internal error of pursue-gen: {type(problem).__name__}: {problem}")
    info("    help: please report it, with the file and with what PURSUE_DEBUG=1 prints")
    return INTERNAL


def _source(file: str) -> Optional[str]:
    """The text of a file; None where it cannot be shown."""
    try:  # a pipe has been read, and would not give its text again
        return read_text(file)
    except (OSError, ValueError):
        return None


def _painted(diagnostic: Diagnostic, text: str, stream: TextIO) -> str:
    """The text with its severity in colour, on a terminal whose owner has not set NO_COLOR."""
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb" or not stream.isatty():
        return text
    word = f"{diagnostic.severity.value} {diagnostic.code}"
    return text.replace(word, f"\033[{_COLOURS[diagnostic.severity]};1m{word}\033[0m", 1)
