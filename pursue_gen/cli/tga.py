"""The command `tga`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from pursue_gen.cli.console import guarded, suggest
from pursue_gen.cli.inputs import scenario_from
from pursue_gen.cli.options import REQUEST, SCENARIO, choice, with_request
from pursue_gen.files import shell_quoted, write_texts

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest

IDEAL_ENDS = choice(
    "ends", "controllable", "reported: ends are the environment's, as in the default game of solve and ws."
)


@guarded
@with_request("ends", "slack", ends=IDEAL_ENDS)
def tga(
    scenario: Path = SCENARIO,
    folder: Path = typer.Option(Path("."), "-o", "--output", metavar="DIR", help="Where to write; here by default."),
    request: SolveRequest = REQUEST,
) -> None:
    """Write a scenario's timed game as UPPAAL's files TGA.xml and TCTL.q (the original's ideal game)."""
    from pursue_gen import api

    network, query_text = api.as_uppaal(scenario_from(scenario, request), replace(request, reaction="0"))
    model, query = folder / "TGA.xml", folder / "TCTL.q"
    write_texts({model: network, query: query_text})
    print(model, query, sep="\n")
    suggest(f"pursue-gen solve {shell_quoted(model)} {shell_quoted(query)}")
