"""How pytest-xdist shares out the tests: files as a whole, the longest first, so that all workers end together.

(`--dist loadgroup` is made for this, but does not group anything with pytest 9.)
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Iterable, List, Optional, Sequence

import pytest
from xdist.scheduler import LoadScopeScheduling

LONGEST = (
    "ros/test_robots", "ros/test_links", "ros/test_witness", "ros/test_faults", "ros/test_missions",
    "ros/test_nodes", "ros/test_signals", "ros/test_missions_with_blocked_ways", "ros/test_newcomer",
    "ros/test_fleet", "ros/test_missions_among_others", "ros/test_install_space", "ros/test_web",
    "ros/test_ui_node", "ros/test_run_mission", "ros/test_received_missions", "ros/test_drive_legs",
    "ros/test_returning_observer", "ros/test_missions_passages", "ros/test_missions_ending", "ros/test_recording",
    "ros/test_real_robots_launch", "ros/test_disturbed_missions", "ros/test_missions_objectives",
    "ros/test_missions_loads", "ros/test_missions_unknown_states", "ros/test_missions_breaking_off",
    "ros/test_missions_assumptions", "ros/test_strangers", "ros/test_missions_battery",
    "ros/test_missions_with_a_late_partner", "ros/test_missions_requests", "ros/test_missions_room",
    "ros/test_missions_with_spots", "ros/test_missions_pauses", "ros/test_missions_patrol", "ros/test_python38",
    "ros/test_controller_without_states", "ros/test_missions_ways", "scenarios/test_scenarios", "test_python38",
    "explanation/test_explain", "tools/simulation/test_simulated_missions", "tools/draw/test_draw_browser",
    "proof/test_shares", "solving/test_passages", "synthesis/test_verdicts", "solving/test_several_times",
    "solving/test_quick", "solving/test_verifytga", "tools/simulation/test_written_judged",
    "tools/lsp/test_packaging", "scenarios/test_patterns", "solving/test_ways", "solving/test_cut_off",
    "proof/test_checker", "tools/simulation/test_people_orders", "tools/replanning/test_replan",
    "proof/test_stages", "language/test_hostile", "synthesis/test_engines", "cli/test_commands",
    "synthesis/test_plan", "explanation/test_part", "runtime/test_hostile_texts", "tga/test_somewhere",
    "synthesis/test_overtaking", "solving/test_tours", "tga/test_unknown_states", "test_retry",
    "tools/simulation/test_simulated_command", "tga/test_hostile_names", "tools/replanning/test_tours_from_here",
    "tga/test_conditions", "cli/test_progress", "solving/test_lost_promises", "tools/lsp/test_server",
    "runtime/ui/test_browser", "proof/test_invariant", "language/assumptions/test_there_by",
    "runtime/manager/test_hostile_requests", "synthesis/test_guess", "solving/test_calm",
    "explanation/test_cheaper", "tools/simulation/test_lanes", "solving/test_decomposition", "proof/test_twins",
    "language/assumptions/test_every", "explanation/test_position", "language/test_groups",
    "tools/draw/test_draw_server", "tools/report/test_commands", "solving/test_contradictions",
    "proof/test_passages", "partition/test_split", "tools/lsp/test_hostile", "tools/report/test_report_command",
    "language/test_times", "runtime/test_launch_arguments", "synthesis/test_limits",
    "tools/replanning/test_request", "solving/test_least_time", "language/assumptions/test_reaches",
    "tga/test_charged_in_parts", "solving/test_shared_games", "tools/simulation/test_cluster",
    "tga/test_meaning_random", "tools/simulation/test_two_stages", "solving/test_objectives", "solving/test_pinned",
    "partition/test_strategy_file", "proof/test_simplify", "workspace/test_writer_kills", "test_setup",
    "test_named_files", "test_tutorial", "language/assumptions/test_stays", "proof/test_left_out_clocks",
    "tools/report/test_timeline", "language/assumptions/test_in_all", "language/test_writer",
    "runtime/test_fleet_life", "tools/report/test_report_page", "solving/test_periods",
    "explanation/test_ablations", "tga/test_uppaal_write", "tools/authoring/test_new", "tga/test_breaking_off",
    "explanation/test_as_written", "runtime/nodes/test_ending", "workspace/test_generate",
    "solving/test_shared_again", "solving/test_one_robot", "zones/test_dbm", "solving/test_pauses_between",
    "tools/simulation/test_crowds", "synthesis/test_cone", "solving/test_tours_beside",
    "solving/test_conditional_games", "tools/replanning/test_written_requests",
    "tools/simulation/test_whole_stories",
)
"""Files that take more than some seconds, the longest first: those on ROS by the clock, then others by processor time,
measured on 30 November 2026. All others are short, in any order."""

ROS_WORKERS = ("gw0", "gw1", "gw2")
"""Workers for tests on ROS. Where there are others, too, they collect no other tests, which takes nine seconds each. A
mission takes a third of a processor; who runs all other tests first, and then helps, keeps two of them busy."""


def rank(file: str) -> int:
    """The place of a file in the list of the longest."""
    name = file[: -len(".py")].rpartition("tests/")[2]
    return LONGEST.index(name) if name in LONGEST else len(LONGEST)


def is_on_ros(file: str) -> bool:
    """True if the tests of the file are on ROS."""
    return "tests/ros/" in file


def best(files: Iterable[str], worker: str) -> Optional[str]:
    """The longest of these files that is of the kind that the worker prefers, else of any kind; None of none."""
    return min(files, key=lambda file: (is_on_ros(file) != (worker in ROS_WORKERS), rank(file)), default=None)


def files_in(folders: Sequence[str]) -> List[str]:
    """The test files in these folders, in order; none where one of them is no folder."""
    if not all(Path(folder).is_dir() for folder in folders):
        return []
    return [str(file) for folder in folders for file in sorted(Path(folder).rglob("test_*.py"))]


def collected_by(worker: int, workers: int, files: Sequence[str]) -> List[str]:
    """What the worker collects: files on ROS, where it is for these and there are others, for which a worker is left.
    Else all, from its share on: it compiles its share, and finds the others' compiled when it comes there.

    pytest's assertions take longer to compile than everything else in the collection of tests.
    """
    on_ros = [file for file in files if is_on_ros(file)]
    if f"gw{worker}" in ROS_WORKERS and workers > len(ROS_WORKERS) and 0 < len(on_ros) < len(files):
        return on_ros
    first = len(files) * worker // workers
    return [*files[first:], *files[:first]]


class LongestFirst(LoadScopeScheduling):
    """Gives a worker that has nothing left the best of the files that are left; where none fits, it is done."""

    def __init__(self, config: pytest.Config, log: Any) -> None:
        super().__init__(config, log)
        config.option.loadscopereorder = False

    def _split_scope(self, nodeid: str) -> str:
        return nodeid.partition("::")[0]

    def _check_nodes_have_same_collection(self) -> bool:
        """True if each has collected what the first has, or a part. Who has most comes first: by that the work is
        shared out, and the last ones go where there is less than one file for each."""
        ordered = sorted(self.registered_collections.items(), key=lambda each: -len(each[1]))
        self.registered_collections = dict(ordered)
        self.assigned_work = {node: self.assigned_work[node] for node, _ in ordered}
        whole = set(ordered[0][1])
        return all(whole.issuperset(tests) for _, tests in ordered) or bool(super()._check_nodes_have_same_collection())

    def _assign_work_unit(self, node: Any) -> None:
        there = {self._split_scope(test) for test in self.registered_collections[node]}
        file = best((file for file in self.workqueue if file in there), node.gateway.id)
        if file is None:
            node.shutdown()
            return
        self.workqueue.move_to_end(file, last=False)
        super()._assign_work_unit(node)
