"""What the process beside the page does to measure a text's ways on the map, as `pursue-gen survey` does."""

from __future__ import annotations

from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Dict, Optional

from pursue_gen.drawing.ground import read_ground
from pursue_gen.language.formatter import format_text
from pursue_gen.tools.draw.solve_work import ERRORS, Work, sentences, working
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import read_placed
from pursue_gen.workspace.robot_size import sizes_of

SURVEYED = "surveyed"


@dataclass(frozen=True)
class SurveyWork(Work):
    """A text whose ways are to be measured, on the map `floor`.

    `radius`: that of all robots, in metres; None: as it is said or was told; `speed`: metres per second of all robots,
    None: no travel times; `ways`: those that are missing are added.
    """

    radius: Optional[float] = None
    speed: Optional[float] = None
    ways: bool = False


def survey(given: SurveyWork, pipe: Connection) -> None:
    """Sends {"verdict": "surveyed", "lines": …, "surveyed": the text with what was measured, "paths": of the ways, with
    their bends in metres}, or why not."""
    with working(pipe):
        pipe.send({"progress": "measuring"})
        try:
            assert given.floor is not None, "the page offers this with a map only"
            pipe.send(_measured(given, given.floor))
        except ImportError as problem:
            what = f"this needs the Python packages numpy and scipy, which are not installed here ({problem})"
            pipe.send({"verdict": ERRORS, "lines": [f"{what}: pip install 'pursue-gen[survey]'"]})


def _measured(given: SurveyWork, floor: Path) -> Dict[str, Any]:
    from pursue_gen.survey.copying import with_sizes
    from pursue_gen.survey.make import Options, surveyed  # needs numpy and scipy
    from pursue_gen.survey.routes import Drive
    from pursue_gen.survey.survey_table import table

    scenario = read_placed(given.text, given.file)
    scenario = read_placed(with_sizes(scenario, sizes_of(scenario, given.told)), given.file)
    robots = [agent.name for agent in scenario.agents if agent.is_robot and agent.mobile is not None]
    speeds = {} if given.speed is None else dict.fromkeys(robots, given.speed)
    drive = Drive(speeds, float(scenario.unit or 1))
    options = Options(sizes_of(scenario).with_radius(given.radius), ways=given.ways, drive=drive)
    found = surveyed(scenario, (Level(read_ground(floor, whole=True), floor),), options)
    lines = [*sentences(found.findings), *table(found)]
    paths = [{"a": way.a, "b": way.b, "line": way.line} for way in found.ways if way.line]
    return {"verdict": SURVEYED, "lines": lines, "surveyed": format_text(found.text, given.file), "paths": paths}
