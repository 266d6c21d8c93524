"""YAML that a person writes, as a tree whose nodes know their places: for messages with line and column."""

from __future__ import annotations

from typing import Any

from pursue_gen.diagnostics import Diagnostic, PursueError, Span, error


def composed(text: str, file: str, missing: Diagnostic, code: str, hint: str) -> Any:
    """The text as PyYAML's tree of nodes, None for an empty text; `file` is its name in messages.

    Raises PursueError with `missing` where PyYAML is not installed (exit status 6), and with this code and hint where
    the text is not YAML (exit status 2).
    """
    try:
        import yaml
    except ImportError:
        raise PursueError([missing], exit_status=6) from None
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except (yaml.YAMLError, ValueError, RecursionError) as problem:
        mark = getattr(problem, "problem_mark", None) or getattr(problem, "context_mark", None)
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        place = Span(file, line, column, line, column + 1)
        raise PursueError([error(code, f"this is not YAML: {_reason(problem)}", place, hint)], exit_status=2) from None


def span_of(node: Any, file: str) -> Span:
    """Where a node stands; None: the beginning of the file."""
    if node is None:
        return Span(file, 1, 1, 1, 2)
    start, end = node.start_mark, node.end_mark
    return Span(file, start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def _reason(problem: Exception) -> str:
    if isinstance(problem, RecursionError):
        return "it is nested too deeply"
    return str(getattr(problem, "problem", None) or getattr(problem, "reason", None) or str(problem).split("\n")[0])
