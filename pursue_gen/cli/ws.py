"""The command `ws`."""

from __future__ import annotations

from pathlib import Path
from typing import List, Optional

import typer

from pursue_gen.cli.console import guarded, suggest, tell
from pursue_gen.cli.options import (
    ENDS,
    EXPLAIN,
    LIMIT,
    MEMORY,
    OPTIMIZE,
    PLAN,
    REACH_OBJ,
    REACTION,
    SCENARIO,
    SLACK,
    SOLVER,
    VERIFYTGA,
    Controllers,
    Ends,
    Optimize,
    Solver,
    value,
)
from pursue_gen.files import shell_quoted


@guarded
def ws(
    scenario: Path = SCENARIO,
    folder: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="DIR", help="Where the workspace goes; workspace_out/<scenario> by default."
    ),
    controllers: Controllers = typer.Option(
        Controllers.DISTRIBUTED,
        help="distributed: one per robot; centralized: one; general: one that decides the ends too (the original's).",
    ),
    reach_obj: str = REACH_OBJ,
    ends: Optional[Ends] = ENDS,
    reaction: Optional[str] = REACTION,
    slack: List[str] = SLACK,
    plan: Optional[Path] = PLAN,
    solver: Optional[Solver] = SOLVER,
    verifytga: Optional[Path] = VERIFYTGA,
    optimize: Optional[Optimize] = OPTIMIZE,
    limit: float = LIMIT,
    memory: Optional[int] = MEMORY,
    explain: bool = EXPLAIN,
    machines: Optional[Path] = typer.Option(
        None, metavar="FILE", help="machines.yaml: which machine runs which node; all run where they are launched else."
    ),
    docker: bool = typer.Option(False, "--docker", help="With Dockerfiles and a compose file: a container per node."),
    systemd: bool = typer.Option(False, "--systemd", help="With units of systemd, one per node."),
    force: bool = typer.Option(False, "--force", help="Replace files that were edited since they were generated."),
) -> None:
    """Write a ROS 1 workspace: a controller per robot, the observer, the user interface, simulated robots, tests.

    The folder is printed on stdout.
    """
    from pursue_gen.solving.inputs import scenario_in
    from pursue_gen.solving.options import asked_limits
    from pursue_gen.solving.request import Asked
    from pursue_gen.workspace.make import Extras, make_workspace

    how = (value(solver), verifytga, value(optimize), asked_limits(limit, memory))
    asked = Asked(controllers.value, reach_obj, value(ends), reaction, tuple(slack), plan, *how)
    read = scenario_in(scenario)
    extras = Extras(machines, docker, systemd)
    place = make_workspace(read, asked, extras, folder, force, scenario if explain else None)
    print(place)
    tell(f"A workspace for {read.name} is in {place}; its README.md says what is in it.")
    launch = f"roslaunch {read.name}_bringup mission.launch"
    suggest(f"cd {shell_quoted(place)} && catkin_make", "source devel/setup.bash", launch)
