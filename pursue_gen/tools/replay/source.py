"""Where the game of a recording comes from: the recording itself, or what a person names on the command line."""

from __future__ import annotations

from pathlib import Path
from typing import Optional, Union

from pursue_gen.diagnostics import usage_error
from pursue_gen.language import load
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.request import SolveRequest
from pursue_gen.tga import translate
from pursue_gen.tools.replay.game import Source, from_data, from_workspace
from pursue_gen.tools.replay.journal import Journal
from pursue_gen.tools.replay.record import MissionRecord


def source_of(
    found: Union[MissionRecord, Journal],
    file: Path,
    scenario: Optional[Path],
    workspace: Optional[Path],
    request: SolveRequest,
) -> Source:
    """The source for what was `found` in the recording `file`: a workspace, a scenario, or else the recording.

    Raises PursueError (exit status 2) where there is none, and for a scenario with errors.
    """
    if workspace is not None:
        if scenario is not None or not request.is_default:
            hint = "leave out SCENARIO, --ends, --reaction and --slack"
            raise usage_error("a workspace says which game it plays", hint)
        return from_workspace(workspace)
    if scenario is not None:
        read = settled(load(str(scenario)), request)
        return Source(scenario.stem, read.text, str(scenario), request.rules(translate(read)))
    if not isinstance(found, Journal) and found.game is not None:
        return from_data(found.game, str(file))
    raise usage_error(f"{file} does not hold its scenario", f"pursue-gen replay {file} SCENARIO.pur")
