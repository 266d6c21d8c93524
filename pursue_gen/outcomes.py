"""How a command can end other than well: a type of error for each outcome, with the exit status that it gets.

An error of no type here is a PursueError: a command line or a file that cannot be used (status 2). Programs catch these
types; the numbers are for those who start a command (docs/commands.md lists them), and stand nowhere else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Iterable, Sequence, Tuple

from pursue_gen.diagnostics import PursueError

if TYPE_CHECKING:
    from pursue_gen.diagnostics import Diagnostic

INTERNAL, NO, INTERRUPTED, BROKEN_PIPE = 1, 1, 130, 141
"""Exit statuses without findings: an internal error; the answer is no (`fmt --check`: a file would change); it was
interrupted; stdout is closed."""


class Invalid(PursueError):
    """What was given (a scenario, a network, a plan) was read, and has errors."""

    exit_status = 3


class Lost(PursueError):
    """The solver found that the objective cannot be met.

    `parts`: promises that cannot be met even if nothing else is wanted, by the automata that watch them, a finding for
    each part; () where only all together is known to be lost.
    """

    exit_status = 4

    def __init__(self, diagnostics: Iterable[Diagnostic], parts: Sequence[Tuple[str, ...]] = ()) -> None:
        super().__init__(diagnostics)
        self.parts = tuple(parts)


class TooSlow(PursueError):
    """The objective can be met, but its goal not within the time that was asked for."""

    exit_status = 4


class NotProven(PursueError):
    """The checker refuses a strategy, or a plan holds none: whether the objective can be met is not known."""

    exit_status = 4


class LimitHit(PursueError):
    """A limit was reached before it was decided: `which` one of "seconds", "memory", "states" and "work", "" where it
    is none of these."""

    exit_status = 5
    which: str = ""


class Unfinished(PursueError):
    """What was begun did not end: a process or a machine failed, or the wait was over."""

    exit_status = 5


class Unavailable(PursueError):
    """Something that is needed is missing, or does not work."""

    exit_status = 6


class Unchanged(PursueError):
    """A robot could not be reached, or refused, and nothing has changed anywhere."""

    exit_status = 7


class Different(PursueError):
    """The robots differ, or the state of one is not known."""

    exit_status = 8
