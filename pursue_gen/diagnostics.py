"""Diagnostics of all stages: severity, code, message, position and hint.

This module is independent of terminals and stages; `render` makes the text for people, `as_json` the data for programs.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Dict, Iterable, List, Optional, Tuple

from pursue_runtime.sentences import listed as listed

_WIDEST = 160
"""The most characters of a source line in a message."""


class Severity(enum.Enum):
    """An error stops the stage, a warning does not."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True)
class Span:
    """A range of a text: `file` as the user named it; lines and columns count from 1, the end column is exclusive.

    `member`: of which member a statement speaks that was written for each of a group, as in `r is room2`.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int
    member: str = ""

    @property
    def written(self) -> Span:
        """The statement as it is written, for all members."""
        return replace(self, member="")

    @property
    def in_words(self) -> str:
        """`line 3`, with the member that is meant."""
        return lines_in_words((self,))


NOWHERE = Span("", 1, 1, 1, 1)
"""The place of what stands in no text: of a scenario that is built in Python."""


@dataclass(frozen=True)
class Diagnostic:
    """One finding. `code` is stable (PML001 …), `message` what is wrong and was expected, `hint` what to do."""

    severity: Severity
    code: str
    message: str
    span: Optional[Span] = None
    hint: str = ""

    def at_member(self, member: str) -> Diagnostic:
        """The same about a statement for one member of a group; `member` as in `Span`."""
        return self if self.span is None else replace(self, span=replace(self.span, member=member))


class PursueError(Exception):
    """The exception for all errors that the command line reports, with diagnostics: what was given cannot be used.

    Other outcomes are its subclasses (outcomes.py).
    """

    exit_status = 2

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics: Tuple[Diagnostic, ...] = tuple(diagnostics)
        super().__init__(self.diagnostics)  # what it is made of: so it can be sent from one process to another

    def __str__(self) -> str:
        return "; ".join(finding.message for finding in self.diagnostics)


def error(code: str, message: str, span: Optional[Span] = None, hint: str = "") -> Diagnostic:
    """A diagnostic of severity error."""
    return Diagnostic(Severity.ERROR, code, message, span, hint)


def warning(code: str, message: str, span: Optional[Span] = None, hint: str = "") -> Diagnostic:
    """A diagnostic of severity warning."""
    return Diagnostic(Severity.WARNING, code, message, span, hint)


def usage_error(message: str, hint: str) -> PursueError:
    """The error of a command line that cannot be used."""
    return PursueError([error("CLI004", message, hint=hint)])


def counted(number: object, noun: str) -> str:
    """`1 error`, `2 errors`, of a number of them or its text."""
    return f"{number} {noun}{'' if str(number) == '1' else 's'}"


def units(amount: object) -> str:
    """`1 unit`, `2 units`; of a time in a scenario that says what a unit is: `2 min`."""
    return getattr(amount, "in_words", "") or counted(amount, "unit")


def an(kind: str) -> str:
    """`an event`, `a rule`: a kind of thing with its article."""
    return f"{'an' if kind[0] in 'ae' else 'a'} {kind}"


def lines_in_words(spans: Iterable[Span]) -> str:
    """`lines 3 and 21 (r is room1; r is room2)`: the lines of these places, each once, with the members that are
    meant."""
    members: Dict[int, List[str]] = {}
    for span in dict.fromkeys(spans):
        members.setdefault(span.line, []).append(span.member)
    some = [f"{line} ({'; '.join(found)})" if any(found) else str(line) for line, found in members.items()]
    return f"line{'s' * (len(some) > 1)} {listed(some)}"


def in_order(diagnostics: Iterable[Diagnostic]) -> Tuple[Diagnostic, ...]:
    """The diagnostics by file, line and column; those without a place last.

    What is wrong with a statement that was written for each member of a group is said once where it is the same for
    several of them, else with the member, and that the line is for each.
    """

    def key(diagnostic: Diagnostic) -> Tuple[bool, str, int, int]:
        span = diagnostic.span
        return (True, "", 0, 0) if span is None else (False, span.file, span.line, span.column)

    found: Dict[Diagnostic, List[str]] = {}
    for diagnostic in diagnostics:
        member = diagnostic.span.member if diagnostic.span is not None else ""
        found.setdefault(diagnostic.at_member(""), []).append(member)
    alone = ((one, some[0] if len(some) == 1 else "") for one, some in found.items())
    said = (_of_member(one, member) if member else one for one, member in alone)
    return tuple(sorted(said, key=key))


def _of_member(diagnostic: Diagnostic, member: str) -> Diagnostic:
    hint = f"{diagnostic.hint}; the line is for each of its group" if diagnostic.hint else ""
    return replace(diagnostic, message=f"{diagnostic.message} ({member})", hint=hint)


def render(diagnostic: Diagnostic, source: Optional[str] = None) -> str:
    """The diagnostic as `file:line:column: severity CODE: message`, the source line with a caret, and the hint."""
    span = diagnostic.span
    place = f"{span.file}:{span.line}:{span.column}: " if span else ""
    lines = [f"{place}{diagnostic.severity.value} {diagnostic.code}: {diagnostic.message}"]
    source_lines = _lines(source) if source is not None else ()
    if span and 1 <= span.line <= len(source_lines):
        lines += _excerpt(source_lines[span.line - 1], span)
    if diagnostic.hint:
        lines.append(f"    help: {diagnostic.hint}")
    return "\n".join(lines)


@lru_cache(maxsize=2)
def _lines(source: str) -> Tuple[str, ...]:
    """The lines, split as all readers of files count them."""
    return tuple(source.replace("\r\n", "\n").replace("\r", "\n").split("\n"))


def _excerpt(text: str, span: Span) -> List[str]:
    """The line, or a part of a very long one, with carets under the span; unprintable characters are replaced."""
    start = max(0, span.column - 1 - _WIDEST // 2) if len(text) > _WIDEST else 0
    column = span.column - start
    width = span.end_column - span.column if span.end_line == span.line else len(text) - span.column + 1
    before, behind = "…" * (start > 0), "…" * (start + _WIDEST < len(text))
    text = text[start : start + _WIDEST]
    shown = "".join(c if c == "\t" or c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    margin = " " * len(before) + "".join("\t" if c == "\t" else " " for c in text[: column - 1])
    carets = "^" * max(1, min(width, len(text) - column + 1))
    return [f"    {before}{shown}{behind}", f"    {margin}{carets}"]


def as_json(diagnostic: Diagnostic) -> Dict[str, Any]:
    """The diagnostic as a JSON object: severity, code, message, hint, and file, line, column, end_line, end_column."""
    result: Dict[str, Any] = {
        "severity": diagnostic.severity.value,
        "code": diagnostic.code,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
    }
    if diagnostic.span:
        result.update({name: value for name, value in vars(diagnostic.span).items() if name != "member"})
    return result
