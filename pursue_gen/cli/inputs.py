"""Scenarios and games from files, with their warnings on stderr."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Sequence, Tuple

from pursue_gen.cli.console import show

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.tga.network import Network, Objective


def scenario_from(file: Path) -> Scenario:
    """The scenario in a file; its warnings are printed. Raises PursueError."""
    from pursue_gen.solving.inputs import findings_in, load_scenario

    scenario = load_scenario(file)
    show(findings_in(file))
    return scenario


def game_from(files: Sequence[Path]) -> Tuple[Network, Objective]:
    """The ideal game of a scenario's file, whose warnings are printed, or of UPPAAL's two files. Raises PursueError."""
    from pursue_gen.solving.inputs import are_scenario, findings_in, load_game

    game = load_game(files)
    if are_scenario(files):
        show(findings_in(files[0]))
    return game
