"""A workspace as a person asks for it on the command line: solved, proven, and written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from pursue_gen.cli.console import show, tell
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.margin import QUICK, strategy_margin, told
from pursue_gen.solving.request import Asked, told_solution
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace import Options, machines_for, write_workspace


@dataclass(frozen=True)
class Extras:
    """What a workspace may have besides: a machines.yaml, and files for containers and for services."""

    machines: Optional[Path] = None
    docker: bool = False
    systemd: bool = False


def make_workspace(
    read: Scenario,
    asked: Asked,
    extras: Extras = Extras(),
    folder: Optional[Path] = None,
    force: bool = False,
    explained: Optional[Path] = None,
) -> Path:
    """Writes the workspace and returns its folder; `folder` and `force` as for `write_workspace`.

    `explained` is as for `told_solution`. The verdict, the margin and warnings are told. Raises as these do.
    """
    network, objective = translate(read), scenario_objective(read)
    if asked.decides_ends:
        tell("ends: controllable, since a general controller decides them itself (else: --ends reported)")
    won = told_solution(network, objective, asked, explained)
    late = told(strategy_margin(won.network, objective, won.strategy, won.reaction, QUICK, asked.limits), won.strategy)
    tell(late)
    options = Options(
        asked.controllers,
        asked.reach_obj,
        won.reaction,
        won.rules.ends,
        won.rules.slack,
        late,
        docker=extras.docker,
        systemd=extras.systemd,
    )
    if extras.machines is not None:
        options, findings = machines_for(extras.machines, read, won.network, won.strategy, options)
        show(findings)
    return write_workspace(read, won.network, objective, won.strategy, options, folder, force)
