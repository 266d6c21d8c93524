"""A workspace for a solved scenario, written."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Mapping, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.drawing.floor import Floor
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition.split import UI, partition
from pursue_gen.proof.worst_case import answer_times, worst_case
from pursue_gen.solving.answers import STATES
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.verdict import margin_text, margins
from pursue_gen.workspace import Options, write_workspace
from pursue_gen.workspace.machines import read_machines
from pursue_gen.workspace.spots import SPOT_DISTANCE, Table, spots_in_one

_STATES = 10_000
"""Symbolic states of the checker that may tell the worst-case time: a second at most, as a rule."""


@dataclass(frozen=True)
class Extras:
    """What a workspace may have besides: a machines.yaml, and files for containers and for services.

    `spot_distance`: metres between the robots at one place; `spare`: as `map_spots.spare_spots` finds them. `floor`: a
    floor plan for the UI's page; `levels`: those that have maps of their own, with their elevations (metres).
    """

    machines: Optional[Path] = None
    docker: bool = False
    systemd: bool = False
    spot_distance: float = SPOT_DISTANCE
    floor: Optional[Floor] = None
    spare: Mapping[str, Table] = field(default_factory=dict)
    levels: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Made:
    """A workspace on the disk: its folder, the margin of its strategy in sentences, and findings (spots, machines)."""

    folder: Path
    margin: str
    findings: Tuple[Diagnostic, ...] = ()


def options_for(request: SolveRequest, won: Solution, margin: str = "", extras: Extras = Extras()) -> Options:
    """The options of a workspace for a solution; without the machines of the extras."""
    return Options(
        request.controllers,
        request.reach_obj,
        won.reaction,
        won.rules.ends,
        won.rules.slack,
        request.options.optimize,
        won.within,
        margin,
        _guarantee(won),
        answer_times(won.network, won.objective, won.strategy, won.reaction, STATES),
        extras.floor,
        docker=extras.docker,
        systemd=extras.systemd,
        spot_distance=extras.spot_distance,
        spare=extras.spare,
        levels=extras.levels,
    )


def _guarantee(won: Solution) -> Optional[Fraction]:
    """In how many time units the strategy comes to the goal at worst; None where that is not quickly found out.

    The same on every machine: the search counts states, and no limit in seconds ends it.
    """
    if not won.objective.reaches:
        return None
    known = won.guarantee.worst if won.guarantee is not None else None
    worst = worst_case(won.network, won.objective, won.strategy, won.reaction, _STATES) if known is None else known
    return won.within if worst is None else worst


def make_workspace(
    scenario: Scenario,
    won: Solution,
    request: SolveRequest,
    extras: Extras = Extras(),
    folder: Optional[Path] = None,
    force: bool = False,
) -> Made:
    """Writes the workspace; `folder` and `force` as for `write_workspace`. Raises as it, and as `read_machines` and
    `partition`."""
    margin = margin_text(won, margins(won, False, request.options.limits)[0], unit=scenario.unit)
    options = options_for(request, won, margin, extras)
    findings = spots_in_one(scenario, extras.spot_distance)
    if extras.machines is not None:
        subs = partition(won.strategy, won.network, scenario.agents, request.controllers, request.reach_obj)
        controllers = [sub.controller for sub in subs if sub.controller != UI]
        machines, more = read_machines(extras.machines, controllers)
        options, findings = replace(options, machines=machines), findings + more
    written = write_workspace(scenario, won.network, won.objective, won.strategy, options, folder, force)
    return Made(written, margin, findings)
