"""The command `examples`."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Optional

import typer

from pursue_gen.cli.console import guarded, suggest


@guarded
def examples(
    name: Optional[str] = typer.Argument(None, metavar="[NAME]", help="Copy this one; without it, list them."),
    folder: Path = typer.Option(Path("."), "-o", "--output", metavar="DIR", help="Where to copy to; here by default."),
    force: bool = typer.Option(False, "--force", help="Replace a file that is there already."),
) -> None:
    """List the scenarios that come with pursue-gen, or copy one to begin with.

    The list, or the name of the new file, goes to stdout.
    """
    from pursue_gen.tools.authoring import examples as ready

    if name is None:
        print(ready.listed(ready.examples(), sys.stdout.isatty()))
        suggest("pursue-gen examples NAME")
        return
    file = ready.copied(ready.example(name), folder, force)
    print(file)
    suggest(f"pursue-gen solve {shlex.quote(str(file))}")
