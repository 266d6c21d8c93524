"""The command `import`."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import List, Optional

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import speeds_of
from pursue_gen.diagnostics import counted, usage_error

_SPEED = 0.5
"""Metres per second, where nobody says it: what small robots do indoors."""


@guarded
def import_(
    building: Path = typer.Argument(
        ..., metavar="BUILDING.yaml", help="The building file of Open-RMF's traffic editor (*.building.yaml)."
    ),
    robots: Optional[str] = typer.Option(None, metavar="A,B,...", help="These robots alone; all by default."),
    speed: List[str] = typer.Option(
        [], metavar="[ROBOT=]M/S", help="The speed of all robots (0.5), or of this one; repeatable."
    ),
    traffic: bool = typer.Option(False, "--traffic", help="Each place and each way holds one robot at a time."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Where to write; the building's name and .pur here by default."
    ),
    force: bool = typer.Option(False, "--force", help="Replace a file that is there already."),
) -> None:
    """Make a scenario of a building's lanes and robots, as Open-RMF's traffic editor writes them.

    Places, ways in metres, chargers, lifts and what dispensers are for come from the file; a patrol of all places with
    a name stands where your own objectives go. The new file's name is printed on stdout.
    """
    from pursue_gen.files import check_new, write_texts
    from pursue_gen.language.checks import check, checked
    from pursue_gen.language.usable import fitting
    from pursue_gen.tools.importing.building import read_building
    from pursue_gen.tools.importing.plan import floor_plan
    from pursue_gen.tools.importing.scenario_text import chosen, scenario_text

    file = output or Path(f"{fitting(building.name.split('.')[0])}.pur")
    check_new(file, force)
    read = read_building(building)
    plan = floor_plan(read)
    some = chosen(plan, robots)
    names = [robot.name for robot in some]
    speeds = speeds_of(speed, names)
    for name in speeds.keys() - set(names):
        raise usage_error(f"--speed: there is no robot {name}", f"there are: {', '.join(names)}")
    text = scenario_text(read, plan, some, {**dict.fromkeys(names, _SPEED), **speeds}, str(file), traffic)
    scenario = checked(text, str(file))
    write_texts({file: text})
    show(check(scenario))
    print(file)
    sizes = (len(some), "robot"), (len(scenario.pois), "place"), (len(scenario.connections), "way")
    info(f"{', '.join(counted(*size) for size in sizes)}.")
    suggest(f"pursue-gen solve {shlex.quote(str(file))}")

