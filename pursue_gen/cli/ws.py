"""The command `ws`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.inputs import placed_on
from pursue_gen.cli.options import EXPLAIN, MISSION, REQUEST, ROBOT, SCENARIO, SPOT_DISTANCE, choice, with_request
from pursue_gen.files import shell_quoted

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest

CONTROLLERS = choice(
    "controllers",
    "distributed",
    "distributed: one per robot; centralized: one; general: one that decides the ends too (the original's).",
)


@guarded
@with_request(*MISSION, controllers=CONTROLLERS)
def ws(
    scenario: Path = SCENARIO,
    folder: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="DIR", help="Where the workspace goes; workspace_out/<scenario> by default."
    ),
    request: SolveRequest = REQUEST,
    explain: bool = EXPLAIN,
    machines: Optional[Path] = typer.Option(
        None, metavar="FILE", help="machines.yaml: which machine runs which node; all run where they are launched else."
    ),
    docker: bool = typer.Option(False, "--docker", help="With Dockerfiles and a compose file: a container per node."),
    systemd: bool = typer.Option(False, "--systemd", help="With units of systemd, one per node."),
    floor: Optional[Path] = typer.Option(
        None, "--map", metavar="YAML", help="A map of map_server, to lie under that of the UI's page; or levels."
    ),
    spot_distance: float = SPOT_DISTANCE,
    robot: List[str] = ROBOT,
    force: bool = typer.Option(False, "--force", help="Replace files that were edited since they were generated."),
) -> None:
    """Write a ROS 1 workspace: a controller per robot, the observer, the user interface, simulated robots, tests.

    The folder is printed on stdout.
    """
    from pursue_gen import api
    from pursue_gen.cli.inputs import scenario_from, solve_and_print
    from pursue_gen.workspace.make import Extras
    from pursue_gen.workspace.map_spots import spare_spots
    from pursue_gen.workspace.robot_size import read_sizes, sizes_of

    told = read_sizes(robot)
    extras = Extras(machines, docker, systemd, spot_distance)
    start = request.options.limits.now()
    read = scenario_from(scenario, request)
    request = request.since(start)
    if floor is not None:
        read, plan, levels = placed_on(read, floor, spot_distance, told)
        spare = spare_spots(read, levels, spot_distance, sizes_of(read, told))
        heights = {level.name: level.elevation for level in levels if level.elevation is not None}
        extras = replace(extras, floor=plan, spare=spare, levels=heights)
    if request.decides_ends:
        info("ends: controllable, since a general controller decides them itself (else: --ends reported)")
    made = api.write_workspace(solve_and_print(read, request, explain), folder, extras, force)
    info(made.margin)
    show(made.findings)
    print(made.folder)
    info(f"A workspace for {read.name} is in {made.folder}; its README.md says what is in it.")
    launch = f"rosrun {read.name}_bringup run_mission"
    suggest(f"cd {shell_quoted(made.folder)} && catkin_make", "source devel/setup.bash", launch)
