"""How pytest-xdist shares out the tests: files as a whole, the longest first, so that all workers end together.

(`--dist loadgroup` is made for this, but does not group anything with pytest 9.)
"""

from __future__ import annotations

from typing import Any, Iterable

import pytest
from xdist.scheduler import LoadScopeScheduling

LONGEST = (
    "ros/test_missions", "ros/test_missions_among_others", "ros/test_robots", "ros/test_faults", "ros/test_links",
    "ros/test_witness", "ros/test_nodes", "ros/test_fleet", "ros/test_missions_with_blocked_ways",
    "ros/test_run_mission", "ros/test_web", "ros/test_disturbed_missions", "ros/test_real_robots_launch",
    "ros/test_newcomer", "ros/test_benchmarks", "ros/test_missions_with_spots", "ros/test_received_missions",
    "ros/test_recording", "ros/test_ui_node", "ros/test_install_space",
    "scenarios/test_scenarios", "proof/test_checker", "synthesis/test_engines", "simulation/test_simulated_command",
    "language/test_hostile", "synthesis/test_cone", "synthesis/test_start", "runtime/manager/test_hostile_requests",
    "simulation/test_simulated_missions", "synthesis/test_plan", "runtime/test_hostile_texts", "lsp/test_packaging",
    "workspace/test_generate", "cli/test_progress", "synthesis/test_limits", "cli/test_commands", "cli/test_statuses",
    "replay/test_command", "synthesis/test_verdicts", "solving/test_least_time", "proof/test_invariant",
    "synthesis/test_native", "solving/test_verifytga", "test_tutorial", "transport/test_bundles",
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
