"""Sub-strategies, network and poses → a catkin workspace on the disk (the thesis's UP2SUBCO, UP2EX and UP2OB)."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

from pursue_gen.language.scenario import Scenario
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.workspace.context import Options
from pursue_gen.workspace.generate import generate
from pursue_gen.workspace.packages import templates_dir
from pursue_gen.workspace.writer import write_tree

__all__ = ["Options", "generate", "templates_dir", "write_tree", "write_workspace"]


def write_workspace(
    scenario: Scenario,
    network: Network,
    objective: Objective,
    strategy: Strategy,
    options: Optional[Options] = None,
    folder: Optional[Path] = None,
    force: bool = False,
) -> Path:
    """Writes the workspace to `folder`, `workspace_out/<scenario>` where none is given, and returns that folder.

    `network` is the game that the strategy was made for. Raises PursueError, with nothing written, where files that a
    person has edited are in the way (and `force` is not given), and what `generate` raises.
    """
    files = generate(scenario, network, objective, strategy, options or Options())
    target = folder if folder is not None else Path("workspace_out") / scenario.name
    write_tree(files, target, force)
    return target
