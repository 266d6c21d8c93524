"""How pytest-xdist shares out the tests: files as a whole, the longest first, so that all workers end together.

(`--dist loadgroup` is made for this, but does not group anything with pytest 9.)
"""

from __future__ import annotations

from typing import Any, Iterable

import pytest
from xdist.scheduler import LoadScopeScheduling

LONGEST = (
    "ros/test_missions", "ros/test_faults", "ros/test_robots", "ros/test_witness", "ros/test_links",
    "ros/test_missions_with_blocked_ways", "ros/test_run_mission", "ros/test_nodes", "ros/test_disturbed_missions",
    "ros/test_web", "ros/test_fleet", "ros/test_newcomer", "ros/test_install_space", "ros/test_received_missions",
    "ros/test_recording", "ros/test_missions_with_spots", "ros/test_real_robots_launch", "ros/test_parameters",
    "ros/test_ui_node", "ros/test_benchmarks", "scenarios/test_scenarios", "workspace/test_writer_kills",
    "simulation/test_simulated_missions", "proof/test_checker", "synthesis/test_verdicts",
    "simulation/test_simulated_command", "proof/test_invariant", "runtime/manager/test_hostile_requests",
    "synthesis/test_native", "synthesis/test_engines", "solving/test_verifytga", "lsp/test_packaging",
    "language/test_hostile", "cli/test_progress", "solving/test_least_time", "synthesis/test_plan", "test_tutorial",
    "workspace/test_generate", "cli/test_commands", "transport/test_bundles",
)
"""Files that take more than some ten seconds, the longest first; all others are short, in any order."""

ROS_WORKERS = ("gw0", "gw1")
"""Workers that prefer tests on ROS: those wait much and compute little, so the others keep the processors busy, and a
machine with two of these never runs more than two missions at once while there is anything else to do."""


def rank(file: str) -> int:
    """The place of a file in the list of the longest."""
    name = file[: -len(".py")].rpartition("tests/")[2]
    return LONGEST.index(name) if name in LONGEST else len(LONGEST)


def best(files: Iterable[str], worker: str) -> str:
    """The longest of these files that is of the kind that the worker prefers; of any kind where there is none."""
    return min(files, key=lambda file: (("tests/ros/" in file) != (worker in ROS_WORKERS), rank(file)))


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
