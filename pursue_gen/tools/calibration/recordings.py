"""Recordings that a person names → the times in them: bags of missions or of drives, and journals."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Iterator, List, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error, warning
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.periods import longest, with_period, without_period
from pursue_gen.tools.calibration.samples import Samples, of_record, together
from pursue_gen.tools.replay.journal import Journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.read import read_recording
from pursue_gen.tools.replay.record import MissionRecord

_SOME = 5
"""So many names of each kind are listed in a message."""


def samples_in(
    files: Sequence[Path], scenario: Scenario, unit: Optional[float] = None
) -> Tuple[Samples, Tuple[Diagnostic, ...]]:
    """The times in all of the recordings, with warnings. `unit`: the seconds per time unit, None: as was recorded, 1
    where that says nothing.

    Raises PursueError (exit status 2) for a file that cannot be read or belongs to another scenario, for units that
    differ, and where nothing was measured at all.
    """
    parts: List[Samples] = []
    findings: List[Diagnostic] = []
    for file in files:
        part = of_record(_record(file, scenario), scenario, file.name)
        _check_names(part, scenario, file)
        findings += _warnings(part, file)
        parts.append(part)
    if unit is None:
        unit = _unit(files, parts, scenario)
    found = replace(together(parts), unit=unit)
    if not found.measured:
        begun = len(found.unused)
        what = f"{begun} {'was' if begun == 1 else 'were'} begun, and none ended" if begun else "none was begun"
        message = f"no drive and no action was measured in {', '.join(file.name for file in files)}: {what}"
        raise PursueError([error("CAL002", message, hint=_RECORD)])
    return found, tuple(findings)


_RECORD = "record a mission until robots have arrived (roslaunch … record:=true), or drives (rosrun UI drive_legs)"


def _record(file: Path, scenario: Scenario) -> MissionRecord:
    found = read_recording(file, drives=True)
    if not isinstance(found, Journal):
        return found
    network, objective = game_of(timed(scenario))
    return reconstruct(found, Moves(network), objective)


def timed(scenario: Scenario) -> Scenario:
    """The scenario with some period in each patrol, so that its movements and actions have automata."""
    return with_period(scenario, longest(scenario)) if without_period(scenario) else scenario


def _check_names(part: Samples, scenario: Scenario, file: Path) -> None:
    """Raises PursueError where nobody in the recording is in the scenario."""
    known = {agent.name for agent in scenario.agents}
    if not part.agents or known & set(part.agents):
        return
    theirs, ours = ", ".join(part.agents[:_SOME]), ", ".join(sorted(known)[:_SOME])
    message = f"{file} was recorded with another scenario: it is about {theirs}, and {scenario.file} has {ours}"
    raise PursueError([error("CAL001", message, hint="name the scenario that was played, or other recordings")])


def _unit(files: Sequence[Path], parts: Sequence[Samples], scenario: Scenario) -> float:
    """The seconds of a time unit that all of them have, and the scenario, if it says that."""
    said = scenario.unit
    units = {part.unit: file.name for part, file in zip(parts, files) if part.unit is not None}
    if len(units) > 1:
        each = ", ".join(f"{unit:g} s in {name}" for unit, name in units.items())
        message = f"the recordings have different time units: {each}"
        hint = "say how many seconds a time unit is to be: --time-unit SECONDS"
        raise PursueError([error("CAL003", message, hint=hint)])
    for unit, file in units.items():
        if said is not None and unit is not None and unit != float(said):
            message = f"{file} has time units of {unit:g} s, and the scenario says {scenario.units[0].text}"
            hint = f"--time-unit {unit:g} counts as the mission did (as of simulated ones), "
            hint += f"--time-unit {float(said):g} in real seconds"
            raise PursueError([error("CAL003", message, hint=hint)])
    return next((unit for unit in units if unit is not None), float(said or 1))


def _warnings(part: Samples, file: Path) -> Iterator[Diagnostic]:
    if part.strangers:
        some = ", ".join(part.strangers[:_SOME]) + (" …" if len(part.strangers) > _SOME else "")
        message = f"{file.name} has {len(part.strangers)} movements or actions that the scenario does not have: {some}"
        hint = "they are passed over; if that is not meant, name the scenario that was played"
        yield warning("CAL010", message, hint=hint)
    if part.problems:
        message = f"{file.name} is not whole: {part.problems[0]}"
        yield warning("CAL011", message, hint="what could be read of it counts")
