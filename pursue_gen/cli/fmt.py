"""The command `fmt`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import List

import typer

from pursue_gen.cli.console import guarded, info
from pursue_gen.diagnostics import Diagnostic, PursueError, counted, usage_error
from pursue_gen.outcomes import NO, Invalid


@guarded
def fmt(
    files: List[Path] = typer.Argument(..., metavar="FILE...", help="Scenarios; - alone: from stdin to stdout."),
    check: bool = typer.Option(False, "--check", help="Change nothing; list what would be, and exit with 1."),
    diff: bool = typer.Option(False, "--diff", help="Change nothing; print what would change, as diff -u does."),
) -> None:
    """Lay out scenarios in the one way: blanks and line breaks change, words, comments and their order never.

    A file with syntax errors is left as it is, and the exit status is 3; where a file cannot be read, it is 2.
    """
    from pursue_gen.language.formatter import Layout, layout_of, layout_of_bytes, replace_text
    from pursue_gen.language.parser import MOST_BYTES

    stdin = files == [Path("-")]
    if Path("-") in files and not stdin:
        raise usage_error("- stands for stdin, and there are files as well", "name files, or - alone")
    layouts: List[Layout] = []
    problems: List[PursueError] = []
    for file in files:
        try:
            if stdin:
                layout = layout_of_bytes(sys.stdin.buffer.read(MOST_BYTES + 1), "<stdin>")
            else:
                layout = layout_of(str(file))
            if layout.changed and not (stdin or check or diff):
                replace_text(layout)
            layouts.append(layout)
        except PursueError as problem:
            problems.append(problem)
    changed = [layout for layout in layouts if layout.changed]
    for layout in changed:
        if diff:
            sys.stdout.write(layout.diff())
        elif check:
            print(layout.file)
        elif not stdin:
            info(f"formatted: {layout.file}")
    if stdin and layouts and not (check or diff):
        sys.stdout.write(layouts[0].after)
    elif not stdin:
        word = "would change" if check or diff else "changed"
        info(f"{counted(len(files), 'file')}: {len(changed)} {word}, {len(layouts) - len(changed)} unchanged")
    if problems:
        findings: List[Diagnostic] = [finding for problem in problems for finding in problem.diagnostics]
        outcome = Invalid if all(isinstance(problem, Invalid) for problem in problems) else PursueError
        raise outcome(findings)
    if check and changed:
        raise typer.Exit(NO)
