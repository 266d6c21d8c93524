"""The command `draw`."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import List, Optional, Tuple

import typer

from pursue_gen.cli.console import guarded, info, suggest
from pursue_gen.cli.options import ROBOT
from pursue_gen.diagnostics import usage_error
from pursue_gen.files import shell_quoted

_LIMIT = 120.0


@guarded
def draw(
    files: Optional[List[Path]] = typer.Argument(
        None, metavar="[MAP.yaml] [SCENARIO]", help="A floor plan of map_server, and the scenario to draw or to begin."
    ),
    port: int = typer.Option(0, metavar="N", min=0, max=65535, help="The port of the page; 0: any that is free."),
    browser: bool = typer.Option(False, "--browser", help="Open the page in your browser."),
    limit: float = typer.Option(
        _LIMIT, metavar="SECONDS", min=1, max=86400, help="So much processor time the page's button Solve may take."
    ),
    robot: List[str] = ROBOT,
    force: bool = typer.Option(
        False, "--force", help="Without SCENARIO: begin anew, and let Save replace the file that is there."
    ),
) -> None:
    """Draw a scenario on a page in your browser, with the text beside it (docs/draw.md).

    The page is for this machine alone. Its address is printed on stdout; Ctrl-C ends it. Without SCENARIO the file is
    called like the map.
    """
    from pursue_gen.synthesis.limits import careful_memory
    from pursue_gen.tools.draw import storage
    from pursue_gen.tools.draw.jobs import Jobs
    from pursue_gen.tools.draw.page import DrawPage, file_for
    from pursue_gen.tools.draw.server import DrawServer
    from pursue_gen.workspace.robot_size import read_sizes

    plan, scenario = _named(files or [])
    file = file_for(scenario, plan)
    if scenario is None:
        storage.check_new(file, force)
    _, version = storage.opened(file)
    jobs = Jobs(file.name, plan, limit, careful_memory(), read_sizes(robot))
    with DrawServer(DrawPage(file, plan, jobs, anew=scenario is None), port) as server:
        print(server.url, flush=True)
        begins = scenario is None or version == storage.NOTHING
        info(f"{file} is {'begun' if begins else 'drawn'} there; Save writes it. Ctrl-C ends the page.")
        if browser:
            webbrowser.open(server.url)
        try:
            server.serve_forever()
        except KeyboardInterrupt:  # which is how it ends
            info("")
        finally:
            jobs.end()
    suggest(f"pursue-gen check {shell_quoted(file)}")


def _named(files: List[Path]) -> Tuple[Optional[Path], Optional[Path]]:
    """The map and the scenario among the files. Raises PursueError (exit status 2)."""
    maps = [file for file in files if file.suffix in (".yaml", ".yml")]
    scenarios = [file for file in files if file.suffix not in (".yaml", ".yml")]
    if len(maps) > 1 or len(scenarios) > 1:
        raise usage_error("expected at most one map and one scenario", "pursue-gen draw map.yaml my_floor.pur")
    return (maps[0] if maps else None), (scenarios[0] if scenarios else None)
