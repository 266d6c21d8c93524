"""Spots of robots on a map: where there is room beside the poses of places."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Tuple

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.drawing.floor import MapSettings
from pursue_gen.drawing.ground import Clearance, Ground, cells_of, to_line
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import check_spots
from pursue_gen.workspace.map_spots import SPARE_REACH, is_seen, spare_spots, with_spots
from pursue_gen.workspace.robot_size import RobotSize, Sizes
from pursue_gen.workspace.spots import placing
from tests.tools.authoring.commands import pursue
from tests.workspace.test_spots import scenario, spots_of

SIZE = RobotSize(0.2, 0.1)
EAST = "0, 0, 0, 1"


def ground(walls: List[List[float]], width: float = 8.0, height: float = 6.0) -> Ground:
    """A floor in cells of 0.1 m with walls around and in it: left, bottom, right, top in metres."""
    columns, rows = round(width * 10), round(height * 10)
    greys = [bytearray([254] * columns) for _ in range(rows)]
    for box in (*walls, [0, 0, width, 0.1], [0, 0, 0.1, height], [width - 0.1, 0, width, height]):
        left, bottom, right, top = (round(10 * one) for one in box)
        for row in greys[bottom:top]:
            row[left:right] = bytes(right - left)
    place = MapSettings(Path("map.pgm"), 0.1, 0.0, 0.0, 0.0, False, 0.65, 0.196, "trinary")
    return Ground(place, columns, rows, cells_of(place, 1, [bytes(row) for row in greys[::-1]]))


FLAT = (Level(ground([])),)


def beside(made: Scenario, floor: Ground, size: RobotSize = SIZE, distance: float = 0.8) -> Dict[str, List[float]]:
    """Where robots stand at the first place."""
    where = placing(with_spots(made, (Level(floor),), distance, Sizes(size)), distance)
    found: Dict[str, Pose] = {robot: table["a"] for robot, table in where.spots.items()}
    return {robot: [round(pose.x, 3), round(pose.y, 3)] for robot, pose in found.items()}


def test_where_there_is_room_on_both_sides_all_is_as_without_a_map() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]", "b": f"//[6.5, 3, 0, {EAST}]"}, 3)
    assert placing(with_spots(made, FLAT, 0.8, Sizes(SIZE)), 0.8).spots == spots_of(made, 0.8)


def test_a_spot_in_a_wall_or_too_near_one_gives_way_to_the_next_one() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 2)
    assert beside(made, ground([]))["bot2"] == [4, 3.8], "on the left"
    assert beside(made, ground([[0, 3.6, 8, 3.8]]))["bot2"] == [4, 2.2], "on the right, for a wall is on the left"
    assert beside(made, ground([[0, 4.0, 8, 4.2]]))["bot2"] == [4, 2.2], "0.2 m are not enough to turn there"
    corridor = ground([[0, 3.6, 8, 3.8], [0, 2.2, 8, 2.4]])
    x, y = beside(made, corridor)["bot2"]
    assert abs(math.dist((x, y), (4, 3)) - 0.8) < 0.01 and 2.7 < y < 3.3, "in the corridor, before or behind it"


def test_no_robot_is_sent_through_a_wall_though_there_is_room_beyond_it() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 2)
    thin = ground([[0, 3.4, 8, 3.5]])
    assert beside(made, thin)["bot2"] == [4, 2.2] and beside(made, ground([]))["bot2"] == [4, 3.8]


def test_a_spot_outside_what_is_inflated_goes_before_one_that_is_nearer() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 2)
    floor = ground([[0, 4.2, 8, 4.4]])
    assert beside(made, floor)["bot2"] == [4, 3.8]
    assert beside(made, floor, RobotSize(0.2, 0.1, 0.3))["bot2"] == [4, 2.2]


def test_no_spot_is_far_from_its_place_because_planners_would_like_it() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 2)
    corridor = ground([[0, 4.2, 8, 4.4], [0, 1.6, 6, 1.8]])
    near, liked = beside(made, corridor), beside(made, corridor, RobotSize(0.2, 0.1, 1.0))
    assert liked["bot2"] == near["bot2"] == [4, 3.8]


def test_a_small_robot_stands_where_a_large_one_could_not() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 3)
    niche = ground([[0, 4.2, 8, 4.4], [0, 0, 8, 2.0], [5.4, 0, 8, 6], [0, 0, 2.6, 6]])
    sizes = Sizes(RobotSize(0.5, 0.1), {"bot2": RobotSize(0.2, 0.1)})
    placed = placing(with_spots(made, (Level(niche),), 0.8, sizes), 0.8).spots
    assert (placed["bot2"]["a"].x, placed["bot2"]["a"].y) == (4, 3.8), "0.4 m from the wall"
    clear = Clearance(niche).metres(placed["bot3"]["a"].x, placed["bot3"]["a"].y, 2.0)
    assert clear > 0.6, "which needs more"


def test_a_spot_is_not_on_the_way_to_its_place_nor_on_that_of_others() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]", "b": f"//[4, 5, 0, {EAST}]", "c": f"//[1, 1, 0, {EAST}]"}, 2)
    there = {("a", "b"): [(4.0, 3.0), (4.0, 5.0)]}
    beyond = {("b", "c"): [(4.0, 5.0), (3.6, 2.2), (1.0, 1.0)]}
    found = []
    for ways in ({}, there, {("b", "a"): there["a", "b"][::-1]}, {**there, **beyond}):
        done = with_spots(made, (Level(ground([]), ways=ways),), 0.8, Sizes(SIZE))
        found.append(next((spot.pose.x, spot.pose.y) for spot in done.pois[0].spots))
    assert found[:3] == [(4, 3.8), (4, 2.2), (4, 2.2)], "left, unless the way comes from there"
    x, y = found[3]
    assert math.dist((x, y), (4, 3)) == pytest.approx(0.8, abs=0.01) and x > 4, "away from the other one, too"


def test_where_nothing_fits_the_spots_are_as_without_a_map() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 3)
    cell = ground([[0, 3.3, 8, 6], [0, 0, 8, 2.7], [4.3, 0, 8, 6], [0, 0, 3.7, 6]])
    assert beside(made, cell) == beside(made, ground([])), "check says that they are in a wall"


def test_a_pose_of_its_own_and_a_place_without_a_pose_stay() -> None:
    made = scenario({"a": f"//[4, 3, 0, {EAST}] bot2 [4, 5.95, 0, {EAST}]", "b": ""}, 2)
    done = with_spots(made, FLAT, 0.8, Sizes(SIZE))
    assert done.pois == made.pois and done.text == made.text


@settings(deadline=None, max_examples=40)
@given(
    st.lists(st.tuples(st.integers(1, 70), st.integers(1, 50), st.integers(1, 12), st.integers(1, 12)), max_size=8),
    st.integers(2, 4),
)
def test_a_spare_spot_has_room_and_is_apart_from_all_others_and_off_the_ways(
    things: List[Tuple[int, int, int, int]], robots: int
) -> None:
    floor = ground([[x / 10, y / 10, (x + w) / 10, (y + h) / 10] for x, y, w, h in things])
    made = scenario({"a": f"//[4, 3, 0, {EAST}]", "b": f"//[6, 5, 0, {EAST}]"}, robots)
    ways = {("a", "b"): [(4.0, 3.0), (4.0, 5.0), (6.0, 5.0)]}
    sizes = Sizes(RobotSize(0.3, 0.1), {"bot1": RobotSize(0.2, 0.1, 0.5)})
    levels = (Level(floor, ways=ways),)
    placed = with_spots(made, levels, 0.8, sizes)
    found, spots, clear = spare_spots(placed, levels, 0.8, sizes), placing(placed, 0.8).spots, Clearance(floor)
    points = [(robot, at, pose) for table in (spots, found) for robot in table for at, pose in table[robot].items()]
    for robot, table in found.items():
        for place, pose in table.items():
            size, own, here = sizes.of([robot]), spots[robot][place], (pose.x, pose.y)
            assert clear.metres(*here, 2.0) > size.wanted and to_line(ways["a", "b"], here)[0] >= 2 * 0.3
            assert size.needed <= math.dist(here, (own.x, own.y)) <= SPARE_REACH + 0.001
            assert is_seen(floor, (own.x, own.y), here) and pose == replace(own, x=pose.x, y=pose.y)
            for other, _, at in points:
                room = size.needed + sizes.of([other]).needed
                assert other == robot or math.dist(here, (at.x, at.y)) >= room - 0.001


def test_where_there_is_room_each_robot_has_a_spare_spot_at_each_place() -> None:
    made, ways = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 2), {("a", "b"): [(4.0, 3.0), (8.0, 3.0)]}
    levels = (Level(ground([]), ways=ways),)
    found = spare_spots(with_spots(made, levels, 0.8, Sizes(SIZE)), levels, 0.8, Sizes(SIZE))
    assert {robot: list(table) for robot, table in found.items()} == {"bot1": ["a"], "bot2": ["a"]}


@settings(deadline=None, max_examples=40)
@given(
    st.lists(st.tuples(st.integers(1, 70), st.integers(1, 50), st.integers(1, 12), st.integers(1, 12)), max_size=8),
    st.integers(2, 4),
    st.sampled_from([0.0, 0.6]),
)
def test_robots_are_apart_and_no_spot_is_worse_than_without_a_map(
    boxes: List[List[int]], robots: int, inflation: float
) -> None:
    walls = [[x / 10, y / 10, min(8.0, (x + w) / 10), min(6.0, (y + h) / 10)] for x, y, w, h in boxes]
    made, size = scenario({"a": f"//[4, 3, 0, {EAST}]"}, robots), RobotSize(0.2, 0.1, inflation)
    floor = ground(walls)
    points = list(beside(made, floor, size).values())
    apart = [math.dist(one, other) for k, one in enumerate(points) for other in points[:k]]
    assert min(apart) >= 0.79
    counts = []
    for placed in (made, with_spots(made, FLAT, 0.8, Sizes(size))):
        said = check_spots(placed, (Level(floor),), 0.8, Sizes(size))
        messages = [one.message for one in said if one.code == "WSP008"]
        counts.append(sum("spot" in message for message in messages))
    assert counts[0] <= counts[1]


def test_a_workspace_and_check_have_the_same_spots_on_a_map(tmp_path: Path) -> None:
    floor = ground([[0, 3.6, 8, 3.8]])
    shades = bytes(254 if free else 0 for free in floor.free_pixels() or b"")
    (tmp_path / "map.pgm").write_bytes(b"P5 80 60 255\n" + shades)
    (tmp_path / "map.yaml").write_text("image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n")
    made = scenario({"a": f"//[4, 3, 0, {EAST}]"}, 2)
    (tmp_path / "two.pur").write_text(made.text)
    options = ("--map", tmp_path / "map.yaml", "--robot", "0.2")
    done = pursue("ws", tmp_path / "two.pur", "-o", tmp_path / "ws", *options)
    assert done.status == 0 and "MAP003" not in done.err and "WSP008" not in done.err
    poses = yaml.safe_load((tmp_path / "ws/src/controller_bot2/config/poses.yaml").read_text())["poses"]
    assert poses["a"][:2] == [4, 2.2]
    assert "0 warnings" in pursue("check", tmp_path / "two.pur", *options).err
    before = pursue("check", tmp_path / "two.pur", "--map", tmp_path / "map.yaml", "--robot", "1")
    assert "MAP003" in before.out and "MAP005" in before.out, "larger robots have no room there"
