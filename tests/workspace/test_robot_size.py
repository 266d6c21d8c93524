"""What robots need, read from the parameters of their move_base."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Dict

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.workspace.robot_size import RobotSize, read_size
from tests.cli.test_commands import pursue

FILES = {
    "costmap.yaml": "obstacle_range: 2.5\nrobot_radius: 0.2\ninflation_layer:\n  inflation_radius: 0.5\n",
    "planner.yaml": "DWAPlannerROS:\n  xy_goal_tolerance: 0.15\n  yaw_goal_tolerance: 0.3\n",
    "footprint.yaml": "footprint: [[-0.205, -0.145], [-0.205, 0.145], [0.077, 0.145], [0.077, -0.145]]\n"
    "robot_radius: 0.9\ninflation_radius: 0.2\n",
    "text.yaml": 'footprint: "[[0.3, 0.4], [-0.3, 0.4], [0, -0.4]]"\nfootprint_padding: 0.0\n',
    "empty.yaml": "footprint: []\nrobot_radius: 0.17\nfootprint_padding: 0\n",
    "dump.yaml": "bot1:\n  move_base:\n    global_costmap: {robot_radius: 0.1, inflation_radius: 0.4}\n"
    "    local_costmap: {robot_radius: 0.12, inflation_radius: 0.3}\n",
}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("", {}),
        ("0.17", {"radius": 0.17}),
        ("costmap.yaml", {"radius": 0.21, "inflation": 0.5}),
        ("costmap.yaml planner.yaml", {"radius": 0.21, "inflation": 0.5, "tolerance": 0.15}),
        ("footprint.yaml", {"radius": math.hypot(0.215, 0.155), "inflation": 0.2}),
        ("text.yaml", {"radius": 0.5}),
        ("empty.yaml", {"radius": 0.17}),
        ("dump.yaml", {"radius": 0.13, "inflation": 0.4}),
        ("0.3 dump.yaml", {"radius": 0.3, "inflation": 0.4}),
    ],
)
def test_the_largest_of_all_numbers_count(given: str, expected: Dict[str, float]) -> None:
    found, usual = read_size(given.split()), RobotSize()
    for name in ("radius", "tolerance", "inflation"):
        assert getattr(found, name) == pytest.approx(expected.get(name, getattr(usual, name))), name


def test_a_goal_needs_room_to_stop_and_to_turn_and_should_be_outside_what_is_inflated() -> None:
    size = RobotSize(0.2, 0.1, 0.25)
    assert (size.needed, size.wanted, size.apart) == pytest.approx((0.3, 0.3, 0.6))
    assert RobotSize(0.2, 0.1, 0.5).wanted == 0.5


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("robot_radius: wide\n", "robot_radius is 'wide'"),
        ("robot_radius: -1\n", "robot_radius is -1"),
        ("inflation_radius: .nan\n", "inflation_radius is '.nan'"),
        ("footprint: [[0.1, 0.2], [3]]\n", "footprint is [[0.1, 0.2], [3]]"),
        ("footprint: 7\n", "footprint is 7"),
        ("scan: {topic: scan}\n", "says nothing of a robot's size"),
        ("- 1\n", "says nothing of a robot's size"),
        ("a: [\n", "cannot be read"),
    ],
)
def test_what_is_no_size_is_refused_with_the_file_and_what_is_expected(text: str, told: str) -> None:
    Path("wrong.yaml").write_text(text)
    with pytest.raises(PursueError) as problem:
        read_size(["wrong.yaml"])
    finding = problem.value.diagnostics[0]
    assert told in finding.message and "wrong.yaml" in finding.message and "expected" in finding.hint
    assert problem.value.exit_status == 2


def test_a_wrong_size_is_refused_where_there_is_no_map_either() -> None:
    Path("floor.pur").write_text('poi "a"\npoi "b"\nconnect a and b distance 1\n')
    done = pursue("check", "floor.pur", "--robot", "-1")
    assert done.status == 2 and "no robot has such a radius" in done.err


@pytest.mark.parametrize("given", ["none.yaml", "nan", "-0.1", "1e9", "wide"])
def test_neither_a_radius_nor_a_file_is_refused(given: str) -> None:
    with pytest.raises(PursueError) as problem:
        read_size([given])
    assert given in problem.value.diagnostics[0].message and problem.value.exit_status == 2
