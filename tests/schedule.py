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
    "ros/test_witness", "ros/test_install_space", "ros/test_fleet", "ros/test_newcomer", "ros/test_nodes",
    "ros/test_missions_with_blocked_ways", "ros/test_run_mission", "ros/test_benchmarks", "ros/test_web",
    "ros/test_ui_node", "ros/test_disturbed_missions", "ros/test_real_robots_launch", "ros/test_recording",
    "ros/test_received_missions", "ros/test_missions_with_spots",
    "scenarios/test_scenarios", "explanation/test_explain", "test_tutorial", "synthesis/test_cone",
    "synthesis/test_engines", "proof/test_checker", "lsp/test_hostile", "authoring/test_new", "lsp/test_server",
    "synthesis/test_verdicts", "language/test_formatter", "proof/test_invariant", "cli/test_progress",
    "partition/test_split", "language/test_hostile", "proof/test_simplify", "replanning/test_request",
    "explanation/test_position", "synthesis/test_start", "solving/test_verifytga", "proof/test_twins",
    "solving/test_least_time", "transport/test_bundles", "partition/test_strategy_file", "replay/test_game",
    "proof/test_stages", "workspace/test_writer_kills", "simulation/test_simulated_command",
    "runtime/test_hostile_texts", "benchmarks/test_stories", "solving/test_quick",
    "simulation/test_simulated_missions", "runtime/manager/test_hostile_requests", "workspace/test_generate",
    "report/test_report_command", "cli/test_commands", "play/test_session", "zones/test_dbm", "lsp/test_packaging",
)
"""Files that take more than some ten seconds, the longest first; all others are short, in any order."""

ROS_WORKERS = ("gw0", "gw1", "gw2")
"""Workers that prefer tests on ROS: a mission takes less than half a processor, so three of them and one worker for all
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
