"""The command `lsp`."""

from __future__ import annotations

from typing import Optional

import typer

from pursue_gen.cli.console import guarded
from pursue_gen.diagnostics import error
from pursue_gen.outcomes import NO, Unavailable


@guarded
def lsp(
    docs: Optional[str] = typer.Option(
        None, "--docs", metavar="URL", help="Where the pages about findings are: codes become links to URL/CODE.md."
    ),
    stdio: bool = typer.Option(False, "--stdio", help="Speak on stdin and stdout, which it always does.", hidden=True),
) -> None:
    """Serve an editor with findings, completion and the like while a scenario is written (docs/editors.md).

    An editor starts it and speaks the language server protocol with it on stdin and stdout.
    """
    try:
        from pursue_gen.tools.lsp.server import serve
    except ImportError as problem:
        missing = (problem.name or "").partition(".")[0]
        if missing not in ("pygls", "lsprotocol", "cattrs", "attrs", "attr"):
            raise
        hint = "install it: pip install 'pursue-gen[lsp]', or pip install pygls"
        message = f"the language server needs the Python package pygls ({missing} was not found)"
        raise Unavailable([error("CLI006", message, hint=hint)]) from None
    if not serve(docs):
        raise typer.Exit(NO)
