"""What is made of a solved scenario: a workspace, simulated missions; and new plans on the way."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, Mapping, Optional

from pursue_gen.api.requests import File, check_words
from pursue_gen.api.solutions import Solved

if TYPE_CHECKING:
    from pursue_gen.tools.simulation.runs import Summary
    from pursue_gen.workspace.make import Extras, Made


def write_workspace(
    solved: Solved, folder: Optional[File] = None, extras: Optional[Extras] = None, force: bool = False
) -> Made:
    """Writes a ROS 1 workspace, to `workspace_out/<scenario>` where no folder is given.

    `extras`: machines, containers, services, and where robots stand; `force`: files that a person has edited are
    replaced. Raises PursueError, with nothing written, where they are in the way.

    >>> import tempfile
    >>> made = write_workspace(solve(read("scenarios/thesis/scenario_1.pur")), tempfile.mkdtemp())
    >>> sorted(package.name for package in (made.folder / "src").glob("controller_*"))
    ['controller_bot1', 'controller_bot2']
    """
    from pursue_gen.workspace.make import Extras, make_workspace

    place = None if folder is None else Path(folder)
    return make_workspace(solved.scenario, solved.solution, solved.request, extras or Extras(), place, force)


def simulate(
    solved: Solved,
    runs: int = 1000,
    seed: int = 1,
    opponent: str = "mixed",
    faults: str = "none",
    until: Optional[float] = None,
    *,
    jobs: int = 1,
    scheduler: Optional[str] = None,
    progress: Callable[[int], Any] = lambda done: None,
) -> Summary:
    """Missions with the generated code in a simulated world, each judged; the same for the same seeds on all machines.

    `seed`: the number of the first mission. `opponent`: "random", "worst", "still" or "mixed"; `faults`: as for
    `pursue-gen sim`; `until`: when a mission is over (time units; None: 1000 with a goal, or twice the
    time to it if that is more; else 200); `jobs`: so many processes; `scheduler`: the address of a Dask scheduler
    instead. `progress`: called with how many are done. Raises PursueError.

    >>> summary = simulate(solve(read("scenarios/thesis/scenario_1.pur")), runs=20)
    >>> summary.missions, summary.failed, [row.end for row in summary.rows]
    (20, 0, ['goal'])
    """
    from pursue_gen.tools.simulation.cluster import cluster, outcomes_on
    from pursue_gen.tools.simulation.faults import read_faults
    from pursue_gen.tools.simulation.runs import make_case, simulate

    kinds = read_faults(faults)
    check_words(opponent=opponent)
    case, knows = make_case(solved.scenario, solved.solution, solved.request, opponent, kinds, until)
    seeds = range(seed, seed + runs)
    played = None if scheduler is None else outcomes_on(cluster(scheduler), case, seeds)
    return simulate(case, seeds, jobs, progress, remaining=knows, played=played)


def replan(data: Mapping[str, Any], states: int = 0) -> Dict[str, Any]:
    """The answer to a request for a new plan in a mission that is under way, as docs/run_time.md has both.

    `states`: a limit on the work in place of time and memory. Raises PursueError for a request that cannot be used.
    """
    from pursue_gen.tools.replanning import replan

    return replan(data, states)
