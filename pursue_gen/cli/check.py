"""The command `check`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import List

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.diagnostics import Severity, as_json, counted
from pursue_gen.files import shell_quoted


@guarded
def check(
    files: List[Path] = typer.Argument(..., metavar="FILE...", help="Scenarios."),
    as_json_: bool = typer.Option(False, "--json", help="Print the findings as a JSON list."),
) -> None:
    """Tell everything that is wrong with scenarios, with line and column.

    Findings go to stdout; the exit status is 3 where there are errors.
    """
    from pursue_gen.solving.inputs import findings_in

    findings = [finding for file in files for finding in findings_in(file)]
    if as_json_:
        print(json.dumps([as_json(finding) for finding in findings], indent=1))
    else:
        show(findings, sys.stdout)
    errors = sum(finding.severity is Severity.ERROR for finding in findings)
    info(f"{counted(len(files), 'file')}: {counted(errors, 'error')}, {counted(len(findings) - errors, 'warning')}")
    if errors:
        suggest(f"pursue-gen explain {next(f.code for f in findings if f.severity is Severity.ERROR)}")
        raise typer.Exit(3)
    suggest(f"pursue-gen ws {shell_quoted(files[0])}")
