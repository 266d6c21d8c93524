"""The command `new`."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Optional

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import choice
from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.tools.authoring.requirements import MOST_ROBOTS


@guarded
def new(
    name: str = typer.Argument(..., metavar="NAME", help="What it is called: letters, digits and _."),
    robots: Optional[int] = typer.Option(None, metavar="N", min=1, max=MOST_ROBOTS, help="How many robots."),
    places: Optional[str] = typer.Option(None, metavar="A,B,...", help="The places, neighbours side by side."),
    kind: Optional[str] = choice("kind", None, "What the goal is like."),
    yes: bool = typer.Option(False, "--yes", "-y", help="Ask nothing; take the suggestions for what is not given."),
    force: bool = typer.Option(False, "--force", help="Replace a file that is there already."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Where to write; NAME.pur here by default."
    ),
) -> None:
    """Write a first scenario that works, from a few questions.

    Answers that are given as options are not asked for. The file's name is printed on stdout. The robots win the
    scenario: that is checked.
    """
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.files import write_texts
    from pursue_gen.language.checks import checked
    from pursue_gen.tools.authoring.dialog import Dialog, ask_requirements
    from pursue_gen.tools.authoring.first_scenario import place_for, scenario_text, tried

    file = place_for(name, output)
    if file.exists() and not force:
        raise usage_error(f"{file} is there already", "choose another name, or replace it with --force")
    dialog = Dialog(sys.stdin, sys.stderr, quiet=yes)
    dialog.show("A few questions; Enter takes what stands in brackets, Ctrl-C leaves without writing anything.")
    text = scenario_text(ask_requirements(dialog, kind, places, robots), str(file))
    scenario = checked(text, str(file))
    problem: Optional[PursueError] = None
    try:
        with progress_line() as progress:
            tried(scenario, progress)
    except PursueError as found:  # written all the same: it is a sound scenario, and says how to go on
        problem = found
    write_texts({file: text})
    print(file)
    if problem is None:
        info("The scenario has no errors, and the robots can win it whatever the others do.")
    else:
        show(problem.diagnostics)
    suggest(f"pursue-gen solve {shlex.quote(str(file))}")
