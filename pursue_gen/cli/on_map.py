"""What commands with `--map` say of a scenario's places, spots and ways."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Tuple

from pursue_gen.cli.console import info, show

if TYPE_CHECKING:
    from pursue_gen.diagnostics import Diagnostic
    from pursue_gen.drawing.floor import Floor
    from pursue_gen.drawing.ground import Ground
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.workspace.map_spots import Ways
    from pursue_gen.workspace.robot_size import Sizes, Told


def placed_on(scenario: Scenario, file: Path, distance: float, told: Told) -> Tuple[Scenario, Floor, Ground, Sizes]:
    """The scenario with the spots that a map has room for, the floor plan with the paths of its ways, and what they
    were found with; findings are printed. Raises PursueError for a map that cannot be used."""
    from pursue_gen.drawing.floor_picture import read_floor
    from pursue_gen.drawing.ground import read_ground
    from pursue_gen.workspace.map_spots import with_spots
    from pursue_gen.workspace.robot_size import sizes_of

    floor, ground, sizes = read_floor(file), read_ground(file), sizes_of(scenario, told)
    findings, ways = on_map(scenario, ground, distance, sizes)
    show(findings)
    return with_spots(scenario, ground, distance, sizes, ways), replace(floor, paths=ways), ground, sizes


def on_map(scenario: Scenario, ground: Ground, distance: float, sizes: Sizes) -> Tuple[Tuple[Diagnostic, ...], Ways]:
    """The findings of `survey`, and the paths of the ways; of the points alone, and no paths, where its packages or the
    pixels are missing."""
    from pursue_gen.workspace.map_check import check_spots

    if ground.cells is not None:
        try:
            import scipy

            from pursue_gen.survey.make import found_on_map
        except ImportError:
            info("Ways are not looked at on the map without numpy and scipy: pip install 'pursue-gen[survey]'")
        else:
            del scipy
            return found_on_map(scenario, ground, distance, sizes)
    return check_spots(scenario, ground, distance, sizes), {}
