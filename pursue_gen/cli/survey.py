"""The command `survey`."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Iterable, List, Optional, Sequence, Tuple

import typer

from pursue_gen.cli.console import ended, guarded, info, show, suggest
from pursue_gen.cli.options import JSON, ROBOT, SCENARIO, speeds_of
from pursue_gen.diagnostics import as_json, error, usage_error
from pursue_gen.files import check_new, shell_quoted, write_bytes
from pursue_gen.outcomes import Invalid, Unavailable

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.survey.make import Options, Survey
    from pursue_gen.workspace.levels import Level
    from pursue_gen.workspace.robot_size import Told


_RADIUS = typer.Option(
    None, metavar="METRES", help="The radius of all robots in this survey, whatever their size; is not written."
)
_CLEARANCE = typer.Option(
    None, metavar="METRES", help="How far two robots that stand stay from each other: twice their goal tolerance."
)
_SPEED = typer.Option(
    [], metavar="[ROBOT=]M/S", help="The speed of all robots, or of this one: gives it travel times; repeatable."
)


@dataclass(frozen=True)
class _Given:
    """What is surveyed, with what was told of its robots; `copy`: the name of the copy, "" for none."""

    levels: Sequence[Level]
    scenario: Path
    sizes: Told
    radius: Optional[float]
    speed: List[str]
    copy: str


@guarded
def survey(
    floor: Path = typer.Argument(..., metavar="MAP.yaml", help="A map of map_server, or the file of levels."),
    scenario: Path = SCENARIO,
    robot: List[str] = ROBOT,
    radius: Optional[float] = _RADIUS,
    clearance: Optional[float] = _CLEARANCE,
    speed: List[str] = _SPEED,
    time_unit: Optional[float] = typer.Option(None, metavar="SECONDS", help="A time unit: the scenario's, or 1."),
    turning: float = typer.Option(0.5, metavar="RAD/S", help="How fast robots turn on the spot."),
    acceleration: float = typer.Option(0.5, metavar="M/S^2", help="How fast robots start and stop."),
    start: float = typer.Option(2.0, metavar="SECONDS", help="How long planning may take in a movement."),
    reserve: float = typer.Option(25.0, metavar="PERCENT", help="How much longer than computed a movement may take."),
    tolerance: float = typer.Option(
        0.4, metavar="METRES", help="How far from the pose a robot has arrived (~end_tolerance)."
    ),
    unit: float = typer.Option(1.0, metavar="METRES", help="How long a unit of distance is."),
    ways: bool = typer.Option(False, "--ways", help="Write the ways that are missing into the copy, too."),
    keep: List[str] = typer.Option([], metavar="PLACE,PLACE", help="Keep the distance of this way; repeatable."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="The copy; SCENARIO_surveyed.pur beside it by default."
    ),
    picture: Optional[Path] = typer.Option(
        None, metavar="FILE.svg", help="Draw the map with places, paths and spots there."
    ),
    force: bool = typer.Option(False, "--force", help="Replace a file that is there already."),
    dry_run: bool = typer.Option(False, "--dry-run", help="Write no copy."),
    as_json_: bool = JSON,
) -> None:
    """Measure a scenario's ways on a map of the building, and write them into a copy of the scenario.

    Reports places in obstacles, places that cannot be reached, places that are too near each other for two robots, and
    ways that lead through a third place; proposes the ways that are missing, and a spot for each robot at each place.
    """
    target = output or scenario.with_name(f"{scenario.stem}_surveyed.pur")
    if not dry_run:
        check_new(target, force)
    _check_numbers(0.0, radius=radius, clearance=clearance, start=start, reserve=reserve, tolerance=tolerance)
    _check_numbers(0.001, time_unit=time_unit, turning=turning, acceleration=acceleration, unit=unit)
    _check_packages()
    from pursue_gen.survey.make import Options
    from pursue_gen.survey.routes import Drive
    from pursue_gen.workspace.levels import read_levels
    from pursue_gen.workspace.robot_size import read_sizes

    levels = read_levels(floor, whole=True)
    pictures = {} if picture is None else {_picture_of(level, picture): level for level in levels}
    for file in pictures:
        check_new(file, force)

    drive = Drive({}, time_unit or 0.0, turning, acceleration, start, reserve / 100, tolerance)
    options = Options(clearance=clearance, unit=unit, ways=ways, keep=tuple(map(_pair, keep)), drive=drive)
    given = _Given(levels, scenario, read_sizes(robot), radius, speed, "" if dry_run else str(target))
    read, copy, found, size = _surveyed(given, options)
    files = {} if dry_run else {target: copy}
    files.update({file: _picture(read, found, level, size) for file, level in pictures.items()})
    write_bytes(files)
    _print(found, as_json_, files)
    _go_on(found, as_json_, None if dry_run else target)


def _go_on(found: Survey, as_json_: bool, copy: Optional[Path]) -> None:
    """Prints what comes next; ends the command with status 3 where the `copy` would have errors."""
    if found.errors:
        show(() if as_json_ else found.errors)
        info("The copy has errors. Mend the scenario, first what the map says above, and survey it again:")
        info("with --ways, if ways are missing that the table has.")
        raise ended(Invalid(found.errors))
    from pursue_gen.survey.make import BY_LIFT

    if any(way.kept not in ("", BY_LIFT) and way.metres is None for way in found.ways):
        info("Ways that could not be measured are as you wrote them: mend what the map says above, and survey again.")
    elif copy is not None:
        suggest(f"pursue-gen solve {shell_quoted(copy)}")


def _check_packages() -> None:
    """Raises PursueError (exit status 6) where what a survey needs is not installed."""
    try:
        import numpy
        import scipy
    except ImportError as problem:
        message = f"survey needs the Python packages numpy and scipy, which are not installed here ({problem})"
        hint = "install them: pip install 'pursue-gen[survey]'"
        raise Unavailable([error("MAP002", message, hint=hint)]) from None
    del numpy, scipy


def _surveyed(given: _Given, options: Options) -> Tuple[Scenario, bytes, Survey, float]:
    """The scenario, its copy, the survey, and the radius of the largest robot."""
    from pursue_gen.language.parser import read_text
    from pursue_gen.survey.copying import with_sizes
    from pursue_gen.survey.make import surveyed
    from pursue_gen.workspace.map_check import read_placed
    from pursue_gen.workspace.robot_size import sizes_of

    text, file = read_text(str(given.scenario)), str(given.scenario)
    scenario = read_placed(text, file)
    scenario = read_placed(with_sizes(scenario, sizes_of(scenario, given.sizes)), file)
    robots = [agent.name for agent in scenario.agents if agent.is_robot and agent.mobile is not None]
    if options.unit != 1 and scenario.in_metres:
        raise usage_error(f"--unit is {options.unit:g}, and distances are metres", "leave it out")
    unit = _time_unit(options.drive.time_unit, scenario)
    drive = replace(options.drive, speeds=speeds_of(given.speed, robots), time_unit=unit)
    sizes = sizes_of(scenario).with_radius(given.radius)
    found = surveyed(scenario, given.levels, replace(options, robots=sizes, drive=drive), given.copy)
    copy = found.text.replace("\n", "\r\n") if "\r\n" in text else found.text
    return scenario, copy.encode("utf-8"), found, sizes.largest.radius


def _picture_of(level: Level, picture: Path) -> Path:
    """The file for the picture of a level."""
    return picture.with_name(f"{picture.stem}_{level.name}{picture.suffix}") if level.name else picture


def _picture(scenario: Scenario, found: Survey, level: Level, radius: float) -> bytes:
    from pursue_gen.drawing.floor_picture import read_floor
    from pursue_gen.survey.picture import drawn
    from pursue_gen.workspace.levels import on_level

    part = on_level(scenario, level)
    here = {poi.name for poi in part.pois if poi.pose is not None}
    ways = tuple(way for way in found.ways if {way.a, way.b} <= here)
    spots = {place: some for place, some in found.spots.items() if place in here}
    return drawn(part, replace(found, ways=ways, spots=spots), read_floor(level.file), radius).encode("utf-8")


def _print(found: Survey, as_json_: bool, files: Iterable[Path]) -> None:
    from pursue_gen.survey.survey_table import as_data, table

    if as_json_:
        findings = [as_json(finding) for finding in (*found.findings, *found.errors)]
        print(json.dumps({**as_data(found), "findings": findings}, indent=1))
    else:
        show(found.findings)
        print(*table(found), sep="\n")
    for file in files:
        info(f"wrote {file}")


def _check_numbers(least: float, **values: Optional[float]) -> None:
    """Raises PursueError (exit status 2) for options with values below `least`, or too large."""
    for name, value in values.items():
        if value is not None and not least <= value <= 1000:
            option = f"--{name.replace('_', '-')}"
            raise usage_error(f"{option} is {value:g}", f"expected a number from {least:g} to 1000")


def _pair(text: str) -> Tuple[str, str]:
    """The two places of a way."""
    places = tuple(name.strip() for name in text.split(","))
    if len(places) != 2:
        raise usage_error(f"--keep {text} is no way", "expected two places, such as desk,shelf")
    return places[0], places[1]


def _time_unit(asked: float, scenario: Scenario) -> float:
    """The seconds of a time unit; `asked`: 0 where nothing was. Raises PursueError where the scenario has another."""
    said = float(scenario.unit or 0)
    if said and asked and asked != said:
        hint = "leave the option out: what is written counts in the scenario's unit"
        raise usage_error(f"--time-unit is {asked:g}, and the scenario says unit {scenario.units[0].written}", hint)
    return asked or said or 1.0
