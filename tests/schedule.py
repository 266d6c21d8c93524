"""How pytest-xdist shares out the tests: files as a whole, the longest first, so that all workers end together.

(`--dist loadgroup` is made for this, but does not group anything with pytest 9.)
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Iterable, List, Sequence

import pytest
from xdist.scheduler import LoadScopeScheduling

LONGEST = (
    "ros/test_robots", "ros/test_missions", "ros/test_links", "ros/test_missions_among_others", "ros/test_faults",
    "ros/test_witness", "ros/test_nodes", "ros/test_run_mission", "ros/test_fleet",
    "ros/test_missions_with_blocked_ways", "ros/test_install_space", "ros/test_benchmarks",
    "ros/test_received_missions", "ros/test_web", "ros/test_disturbed_missions", "ros/test_python38",
    "ros/test_real_robots_launch", "ros/test_missions_objectives", "ros/test_recording", "ros/test_ui_node",
    "ros/test_missions_with_spots", "ros/test_missions_assumptions", "ros/test_parameters",
    "ros/test_controller_without_states", "ros/test_newcomer", "ros/test_missions_patrol", "scenarios/test_scenarios",
    "test_python38", "proof/test_shares", "proof/test_checker", "cli/test_progress", "solving/test_ways",
    "synthesis/test_verdicts", "proof/test_invariant", "synthesis/test_cone", "synthesis/test_engines", "test_tutorial",
    "runtime/manager/test_hostile_requests", "tools/lsp/test_packaging", "language/test_hostile",
    "tools/simulation/test_simulated_missions", "runtime/test_hostile_texts", "solving/test_shared_games",
    "solving/test_quick", "tools/simulation/test_simulated_command", "proof/test_stages", "solving/test_least_time",
    "explanation/test_explain", "synthesis/test_start", "synthesis/test_overtaking", "synthesis/test_plan",
    "tools/report/test_report_page", "tools/draw/test_draw_browser", "zones/test_dbm", "cli/test_commands",
    "workspace/test_generate", "tools/draw/test_draw_server", "proof/test_checker_random", "synthesis/test_limits",
    "tools/lsp/test_hostile", "runtime/observer/test_journal", "solving/test_objectives", "tools/lsp/test_server",
    "runtime/ui/test_browser", "tools/authoring/test_new", "tools/report/test_report_command", "solving/test_verifytga",
    "benchmarks/test_synthesis", "tools/replanning/test_request", "solving/test_crowds_random",
    "tools/transport/test_sender", "solving/test_decomposition", "proof/test_twins", "tga/test_conditions",
    "proof/test_simplify", "language/test_formatter", "tools/transport/test_bundles", "workspace/test_writer_kills",
    "zones/test_federation", "benchmarks/test_random_games", "runtime/test_fleet_life", "tga/test_uppaal_write",
    "tools/report/test_commands",
)
"""Files that take more than some seconds, the longest first; all others are short, in any order."""

ROS_WORKERS = ("gw0", "gw1", "gw2", "gw3")
"""Workers that prefer tests on ROS: a mission takes less than half a processor, so four of them and one worker for all
else keep two processors busy."""


def rank(file: str) -> int:
    """The place of a file in the list of the longest."""
    name = file[: -len(".py")].rpartition("tests/")[2]
    return LONGEST.index(name) if name in LONGEST else len(LONGEST)


def best(files: Iterable[str], worker: str) -> str:
    """The longest of these files that is of the kind that the worker prefers; of any kind where there is none."""
    return min(files, key=lambda file: (("tests/ros/" in file) != (worker in ROS_WORKERS), rank(file)))


def files_in(folders: Sequence[str]) -> List[str]:
    """The test files in these folders, in order; none where one of them is no folder."""
    if not all(Path(folder).is_dir() for folder in folders):
        return []
    return [str(file) for folder in folders for file in sorted(Path(folder).rglob("test_*.py"))]


def from_its_share_on(files: Sequence[str], worker: int, workers: int) -> List[str]:
    """All files, from the worker's share on: it compiles its share, and finds the others' compiled when it comes there.

    pytest's assertions take longer to compile than everything else in the collection of tests.
    """
    first = len(files) * worker // workers
    return [*files[first:], *files[:first]]


class LongestFirst(LoadScopeScheduling):
    """Gives a worker that has nothing left the best of the files that are left."""

    def __init__(self, config: pytest.Config, log: Any) -> None:
        super().__init__(config, log)
        config.option.loadscopereorder = False

    def _split_scope(self, nodeid: str) -> str:
        return nodeid.partition("::")[0]

    def _assign_work_unit(self, node: Any) -> None:
        self.workqueue.move_to_end(best(self.workqueue, node.gateway.id), last=False)
        super()._assign_work_unit(node)
