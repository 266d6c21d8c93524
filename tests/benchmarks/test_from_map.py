"""The robots of benchmarks.from_map: they drive around walls, and as they are; and what it writes."""

from __future__ import annotations

import math
from itertools import groupby
from pathlib import Path
from random import Random

import pytest

from benchmarks import from_map
from benchmarks.robots_on_map import DEVIATION, Floor, Nature, drive, pose_after
from pursue_gen.drawing.ground import FREE, read_ground
from pursue_gen.language import parse
from pursue_gen.survey.make import Options, surveyed
from pursue_gen.workspace.levels import Level

pytestmark = pytest.mark.benchmark

GROUND = read_ground(from_map.MAP, whole=True)
FLOOR = Floor(GROUND, from_map.RADIUS)
DESK, HALL, SHELF = (1.0, 1.0, 0.0), (6.0, 2.5, 0.0), (11.0, 5.0, math.pi / 2)
ROBOT = Nature(0.4, 0.3, 0.7, 1.0, {"fetch": 3.0})


def test_paths_keep_the_radius_from_walls_and_are_hardly_longer_than_the_shortest() -> None:
    scenario = parse(from_map.SCENARIO, "my_floor.pur", "my_floor")
    shortest = surveyed(scenario, (Level(GROUND),), Options()).text
    for (a, b), metres in {(DESK, HALL): 7.7, (HALL, SHELF): 6.7}.items():
        assert f"distance {metres}" in shortest
        path = FLOOR.path(a[:2], b[:2])
        length = sum(math.dist(u, v) for u, v in zip(path, path[1:]))
        assert metres - 0.3 <= length <= 1.1 * metres
        for x, y in path:
            around = [k * math.pi / 8 for k in range(16)]
            assert all(GROUND.at(x + 0.2 * math.cos(a), y + 0.2 * math.sin(a)) == FREE for a in around)


def test_no_path_leads_through_a_wall_without_a_door() -> None:
    lonely = Floor(GROUND, 0.9)  # too large for the doors
    with pytest.raises(ValueError, match="no way"):
        lonely.path(DESK[:2], SHELF[:2])


@pytest.mark.parametrize("seed", range(5))
def test_a_drive_ends_at_the_goal_and_never_exceeds_the_speed_by_more_than_its_times_vary(seed: int) -> None:
    moments = drive(FLOOR, DESK, SHELF, ROBOT, Random(seed))
    assert pose_after(0.0, moments) == DESK and pose_after(moments[-1].after, moments) == SHELF
    assert [moment.after for moment in moments] == sorted(moment.after for moment in moments)
    fastest = ROBOT.speed * math.exp(5 * DEVIATION)
    step = 0.1
    poses = [pose_after(step * k, moments) for k in range(int(moments[-1].after / step) + 2)]
    assert all(math.dist(a[:2], b[:2]) <= fastest * step for a, b in zip(poses, poses[1:]))
    assert len(list(groupby(poses))) > 200, "it drives, and does not jump"


def test_a_robot_that_turns_more_slowly_takes_longer() -> None:
    slow = Nature(ROBOT.speed, ROBOT.acceleration, ROBOT.turning / 3, ROBOT.planning, ROBOT.acts)
    times = [drive(FLOOR, SHELF, HALL, robot, Random(1))[-1].after for robot in (ROBOT, slow)]
    assert times[1] > times[0] + 3.0


def test_windows_are_read_and_shown_with_the_missions(tmp_path: Path) -> None:
    scenario = tmp_path / "my_floor.pur"
    scenario.write_text('event "fetch" location b duration 2 to 5\ntravel bot1 from a to b takes 3.5 to 6 // survey\n')
    found = from_map.windows(scenario)
    assert found == {"fetch": "2 to 5", "bot1 from a to b": "3.5 to 6"}
    mission = {"outcome": "goal", "why": "", "seconds": 81.4, "left": ["bot1 was late"]}
    pair = {"seed": 1, "promised": 100.4, "windows": {"fetch": ["3", "2 to 5"]}, "missions": [mission]}
    other = {**pair, "seed": 2, "windows": {"fetch": ["3", "1 to 9"]}, "missions": [{**mission, "left": []}]}
    data = {"pairs": [pair, other]}
    page = from_map.filled("before\n<!-- measured: from_map -->\nold\n<!-- end -->\nafter\n", data)
    assert "| fetch | 3 | 2 to 5 | 1 to 9 |" in page and "| 1 | 1 | goal | bot1 was late | 81 | 100 |" in page
    assert "| 2 | 1 | goal | nothing | 81 | 100 |" in page and "old" not in page
    assert from_map.filled(page, data) == page
