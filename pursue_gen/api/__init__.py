"""What programs and notebooks call, and the commands too: read, check, solve, explain, simulate, write a workspace.

`import pursue_gen` has all these names. Functions take and return frozen values, print nothing and never exit; what
goes wrong is a PursueError with its findings (code, message, hint, place), of a type of its own for each outcome
(Invalid, Lost, TooSlow, NotProven, LimitHit …). Scenarios are read, or built of the values in `language.scenario`.
Ctrl-C ends whatever is done. docs/api.md shows all of it at work. What a function needs is imported when it is called.
"""

from pursue_gen.api.scenarios import as_text, as_uppaal, check, game, parse, read, read_game, request, settle
from pursue_gen.api.solutions import (
    Solved,
    SolvedGame,
    Why,
    can_explain,
    explain,
    problem_of,
    promises_of,
    replan,
    simulate,
    solve,
    solve_game,
    verdict_of,
    verify,
    verify_game,
    write_workspace,
)
from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, Span
from pursue_gen.language import scenario
from pursue_gen.language.scenario import *
from pursue_gen.outcomes import Invalid, LimitHit, Lost, NotProven, TooSlow, Unavailable

__all__ = [
    "Diagnostic", "Invalid", "LimitHit", "Lost", "NotProven", "PursueError", "Severity", "Solved", "SolvedGame", "Span",
    "TooSlow", "Unavailable", "Why", "as_text", "as_uppaal", "can_explain", "check", "explain", "game", "parse",
    "problem_of", "promises_of", "read", "read_game", "replan", "request", "settle", "simulate", "solve", "solve_game",
    "verdict_of", "verify", "verify_game", "write_workspace",
]  # fmt: skip
__all__ += scenario.__all__
