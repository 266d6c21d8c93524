"""The command `import`."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Dict, List, Optional, Sequence

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import speeds_of
from pursue_gen.diagnostics import counted, usage_error

_SPEED = 0.5
"""Metres per second, where nobody says it: what small robots do indoors."""


@guarded
def import_(
    source: Path = typer.Argument(
        ..., metavar="FILE", help="A building of Open-RMF (*.building.yaml), or places with poses (*.yaml, *.csv)."
    ),
    robots: Optional[str] = typer.Option(
        None, metavar="A,B,...", help="Of a building these robots alone; beside a list of places the robots' names."
    ),
    speed: List[str] = typer.Option(
        [], metavar="[ROBOT=]M/S", help="The speed of all robots (0.5), or of this one; repeatable."
    ),
    connect: bool = typer.Option(False, "--connect", help="Neighbours in a list of places have a straight way."),
    traffic: bool = typer.Option(False, "--traffic", help="Each place and each way holds one robot at a time."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Where to write; the file's name and .pur here by default."
    ),
    force: bool = typer.Option(False, "--force", help="Replace a file that is there already."),
) -> None:
    """Make a scenario of what people have: a building of Open-RMF, or a list of places with poses.

    Of a building's lanes and robots, as Open-RMF's traffic editor writes them: places, ways in metres, chargers, lifts
    and what dispensers are for. Of waypoints for move_base or Nav2, and of markers of rviz: places; ways are measured
    by survey, or with --connect they are straight. A patrol stands where your own objectives go. The new file's name is
    printed on stdout.
    """
    from pursue_gen.files import check_new, write_texts
    from pursue_gen.language.checks import check, checked
    from pursue_gen.language.names import fitting
    from pursue_gen.language.parser import parse
    from pursue_gen.tools.importing.building import read_building
    from pursue_gen.tools.importing.plan import floor_plan
    from pursue_gen.tools.importing.scenario_text import chosen, scenario_text
    from pursue_gen.tools.importing.waypoints import is_building, read_waypoints, robots_named, waypoints_text

    file = output or Path(f"{fitting(source.name.split('.')[0])}.pur")
    check_new(file, force)
    if is_building(source):
        if connect:
            raise usage_error("--connect is for lists of places", "a building has its lanes: leave --connect out")
        read = read_building(source)
        plan = floor_plan(read)
        some = chosen(plan, robots)
        speeds = _speeds(speed, [robot.name for robot in some])
        text = scenario_text(read, plan, some, speeds, str(file), traffic)
    else:
        places = read_waypoints(source)
        speeds = _speeds(speed, robots_named(robots, places))
        text = waypoints_text(source.name, places, speeds, str(file), connect, traffic)
    has_ways = "\nconnect " in text
    scenario = checked(text, str(file)) if has_ways else parse(text, str(file))
    write_texts({file: text})
    if has_ways:
        show(check(scenario))
    print(file)
    sizes = (len(speeds), "robot"), (len(scenario.pois), "place"), (len(scenario.connections), "way")
    info(f"{', '.join(counted(*size) for size in sizes)}.")
    name = shlex.quote(str(file))
    suggest(f"pursue-gen solve {name}" if has_ways else f"pursue-gen survey MAP.yaml {name} --ways")


def _speeds(texts: Sequence[str], names: Sequence[str]) -> Dict[str, float]:
    """Robot → metres per second, in this order."""
    speeds = speeds_of(texts, names)
    for name in speeds.keys() - set(names):
        raise usage_error(f"--speed: there is no robot {name}", f"there are: {', '.join(names)}")
    return {**dict.fromkeys(names, _SPEED), **speeds}
