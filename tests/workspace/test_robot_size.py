"""What robots need, read from the parameters of their move_base."""

from __future__ import annotations

from pathlib import Path
from typing import Dict

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import check, parse
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal_write import write_network
from pursue_gen.workspace.robot_size import RobotSize, Sizes, read_sizes, sizes_of
from tests.cli.test_commands import pursue

FILES = {
    "costmap.yaml": "obstacle_range: 2.5\nrobot_radius: 0.2\ninflation_layer:\n  inflation_radius: 0.5\n",
    "planner.yaml": "DWAPlannerROS:\n  xy_goal_tolerance: 0.15\n  yaw_goal_tolerance: 0.3\n",
    "footprint.yaml": "footprint: [[-0.205, -0.145], [-0.205, 0.145], [0.077, 0.145], [0.077, -0.145]]\n"
    "robot_radius: 0.9\ninflation_radius: 0.2\n",
    "rollout.yaml": "TrajectoryPlannerROS: {xy_goal_tolerance: 0.15}\n",
    "dwa_dump.yaml": "move_base:\n  base_local_planner: dwa_local_planner/DWAPlannerROS\n"
    "  global_costmap: {robot_radius: 0.1, inflation_radius: 0.4}\n",
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
        ("costmap.yaml rollout.yaml", {"radius": 0.21, "inflation": 0.5, "tolerance": 0.15}),
        ("costmap.yaml planner.yaml", {"radius": 0.21, "tolerance": 0.15}),
        ("dwa_dump.yaml", {"radius": 0.11}),
        ("footprint.yaml", {"radius": 0.266, "inflation": 0.2}),
        ("text.yaml", {"radius": 0.5}),
        ("empty.yaml", {"radius": 0.17}),
        ("dump.yaml", {"radius": 0.13, "inflation": 0.4}),
        ("0.3 dump.yaml", {"radius": 0.3, "inflation": 0.4}),
    ],
)
def test_the_largest_of_all_numbers_count(given: str, expected: Dict[str, float]) -> None:
    found = read_sizes(given.split()).get("", {})
    for name in ("radius", "tolerance", "inflation"):
        assert found.get(name) == pytest.approx(expected.get(name)), name


def told(text: str, *given: str) -> Sizes:
    return sizes_of(parse(AGENTS.format(text), "test.pur"), read_sizes(given))


AGENTS = """poi "a"
poi "radius"
connect a and radius distance 1
event "inflation"
agent "bot1" controllable mobile 1 {} location radius can_do inflation
agent "bot2" controllable mobile 1 radius 0.4 location a
agent "tolerance" mobile 1 location radius
reach_objective: do inflation
"""
"""Their words may be names, too."""


def test_the_scenario_says_the_size_of_each_robot_and_what_is_told_goes_before_that() -> None:
    assert told("").own == {"bot1": RobotSize(), "bot2": RobotSize(0.4)}
    said = "radius 0.155 tolerance 0.2 inflation 0.5"
    sizes = told(said)
    assert sizes.own["bot1"] == sizes.of(["bot1"]) == RobotSize(0.155, 0.2, 0.5)
    assert sizes.largest == sizes.of(["bot1", "bot2"]) == sizes.of([]) == RobotSize(0.4, 0.2, 0.5)
    assert told(said, "0.3").own == {"bot1": RobotSize(0.3, 0.2, 0.5), "bot2": RobotSize(0.3)}
    both = told(said, "0.3", "bot1=costmap.yaml", "bot1=0.22")
    assert both.own == {"bot1": RobotSize(0.22, 0.2, 0.5), "bot2": RobotSize(0.3)}
    assert both.with_radius(0.1).own == {"bot1": RobotSize(0.1, 0.2, 0.5), "bot2": RobotSize(0.1)}


def test_a_size_is_at_most_a_hundred_metres_and_of_a_robot() -> None:
    for text, message in (("radius 100.001", "bot1 has radius 100.001: expected 100 metres"), ("radius 100", "")):
        found = [one.message for one in check(parse(AGENTS.format(text), "test.pur"))]
        assert any(message in one for one in found) if message else found == []


def test_a_size_changes_nothing_in_the_network() -> None:
    scenarios = [parse(AGENTS.format(text), "test.pur") for text in ("", "radius 0.2 inflation 0.5")]
    plain, sized = (write_network(translate(one), scenario_objective(one)) for one in scenarios)
    assert plain == sized


def test_a_size_of_what_is_no_robot_of_the_scenario_is_refused() -> None:
    for name, hint in (("bot3", "did you mean bot"), ("tolerance", "expected one of: bot1, bot2")):
        with pytest.raises(PursueError) as problem:
            told("", f"{name}=0.2")
        assert name in problem.value.diagnostics[0].message and hint in problem.value.diagnostics[0].hint
        assert problem.value.exit_status == 2


def test_a_goal_needs_room_to_stop_and_to_turn_and_should_be_outside_what_is_inflated() -> None:
    size = RobotSize(0.2, 0.1, 0.25)
    assert (size.needed, size.wanted, size.apart) == pytest.approx((0.3, 0.55, 0.6))
    assert RobotSize(0.2, 0.1).wanted == pytest.approx(0.3)


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
        read_sizes(["wrong.yaml"])
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
        read_sizes([given])
    assert given in problem.value.diagnostics[0].message and problem.value.exit_status == 2
