"""Where robots stand at a place: side by side unless the scenario says it, never on one point."""

from __future__ import annotations

import dataclasses
import math
from itertools import combinations
from typing import Dict, List, Mapping, Set, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.drawing.layout import poses
from pursue_gen.language import parse
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.tga import translate
from pursue_gen.workspace.spots import moved, spots, spots_in_one

ROUNDING = 0.002  # metres: spots are rounded to millimetres
EAST, NORTH = "0, 0, 0, 1", f"0, 0, {math.sin(math.pi / 4)!r}, {math.cos(math.pi / 4)!r}"


def scenario(places: Mapping[str, str], robots: int = 2, more: str = "") -> Scenario:
    """Places with what stands behind them, all connected, and robots that start at the first one."""
    names = list(places)
    text = "".join(f'poi "{name}" {behind}\n' for name, behind in places.items())
    text += "".join(f"connect {names[0]} and {name} distance 3\n" for name in names[1:]) + 'event "work"\n'
    start = f"location {names[0]} can_do work"
    text += "".join(f'agent "bot{number}" controllable mobile 1 {start}\n' for number in range(1, robots + 1))
    return parse(text + more + "reach_objective: do work\n", "test.pur")


def spots_of(made: Scenario, distance: float) -> Dict[str, Dict[str, Pose]]:
    return spots(made, poses(made)[0], distance)


def metres(a: Pose, b: Pose) -> float:
    return math.hypot(a.x - b.x, a.y - b.y)


def points(made: Scenario, distance: float, place: str) -> List[Tuple[float, float]]:
    return [(table[place].x, table[place].y) for table in spots_of(made, distance).values()]


def test_the_first_robot_has_the_given_pose_and_the_others_stand_beside_it_left_first() -> None:
    made = scenario({"a": f"//[1, 2, 0, {EAST}]"}, robots=4)
    assert points(made, 0.5, "a") == [(1, 2), (1, 2.5), (1, 1.5), (1, 3)]


def test_beside_is_across_the_direction_of_the_pose() -> None:
    made = scenario({"a": f"//[1, 2, 0, {NORTH}]"})
    assert points(made, 0.5, "a") == [(1, 2), (0.5, 2)]


def test_all_look_where_the_given_pose_looks_and_stand_on_its_floor() -> None:
    made = scenario({"a": f"//[1, 2, 7, {NORTH}]"}, robots=3)
    given = made.pois[0].pose
    assert given is not None
    for table in spots_of(made, 1.0).values():
        assert dataclasses.replace(table["a"], x=given.x, y=given.y) == given


def test_a_pose_of_its_own_is_kept_and_the_others_keep_away_from_it() -> None:
    made = scenario({"a": f"//[1, 2, 0, {EAST}] bot2 [1, 3, 0, {NORTH}]"}, robots=4)
    assert points(made, 1.0, "a") == [(1, 2), (1, 3), (1, 1), (1, 4)]
    assert spots_of(made, 1.0)["bot2"]["a"] == made.pois[0].spots[0].pose


def test_a_robot_keeps_away_from_the_other_places_where_there_is_room() -> None:
    made = scenario({"a": f"//[0, 0, 0, {EAST}]", "b": f"//[0, 1, 0, {EAST}]"})
    assert points(made, 1.0, "a") == [(0, 0), (0, -1)]
    assert points(made, 1.0, "b") == [(0, 1), (0, 2)]


def test_places_that_are_nearer_than_the_robots_still_have_a_spot_for_each() -> None:
    made = scenario({name: f"//[0, {number / 10}, 0, {EAST}]" for number, name in enumerate("abcdefghij")}, robots=3)
    table = spots_of(made, 2.0)
    for place in "abcdefghij":
        assert all(metres(table[x][place], table[y][place]) >= 2.0 - ROUNDING for x, y in combinations(table, 2))
        assert all(metres(table[robot][place], table["bot1"][place]) <= 12.1 for robot in table)


def test_only_robots_that_may_be_at_a_place_take_room_there() -> None:
    more = 'poi "c" //[9, 9, 0, 0, 0, 0, 1]\nagent "arm" controllable location c can_do work\n'
    made = scenario({"a": f"//[1, 2, 0, {EAST}]"}, robots=2, more=more)
    table = spots_of(made, 0.5)
    assert (table["arm"]["c"].x, table["arm"]["c"].y) == (9, 9) == (table["bot1"]["c"].x, table["bot2"]["c"].y)
    assert table["arm"]["a"] == table["bot1"]["a"]  # it never gets there


def test_people_and_agents_of_the_environment_have_no_spots() -> None:
    more = 'agent "nurse" human controllable mobile 1 location a\nagent "guest" mobile 1 location a\n'
    assert list(spots_of(scenario({"a": f"//[1, 2, 0, {EAST}]"}, robots=1, more=more), 1.0)) == ["bot1"]


def test_poses_change_nothing_of_the_network() -> None:
    plain = scenario({"a": "", "b": ""})
    placed = scenario({"a": f"//[1, 2, 0, {EAST}] bot2 [1, 3, 0, {EAST}]", "b": f"//[4, 2, 0, {EAST}]"})
    assert translate(placed) == translate(plain)


def test_with_distance_0_all_have_the_given_pose_and_the_places_are_named() -> None:
    made = scenario({"a": f"//[1, 2, 0, {EAST}]", "b": f"//[5, 2, 0, {EAST}] bot2 [6, 2, 0, {EAST}]"})
    assert points(made, 0.0, "a") == [(1, 2), (1, 2)] and points(made, 0.0, "b") == [(5, 2), (6, 2)]
    (finding,) = spots_in_one(made, 0.0)
    assert (finding.code, finding.message.split(":")[0]) == ("WSP007", "bot1 and bot2 have one pose at a")
    assert spots_in_one(made, 0.5) == ()
    assert spots_in_one(scenario({"a": ""}, robots=1), 0.0) == ()


def kept_apart(*objectives: str, robots: int = 2, places: str = "ab") -> Scenario:
    """Robots that can all get to all places, far from each other, and objectives that keep some from meeting."""
    behind = {name: f"//[{9 * number}, 0, 0, {EAST}]" for number, name in enumerate(places)}
    return scenario(behind, robots, "".join(f"{objective}\n" for objective in objectives))


def test_a_given_pose_is_forwarded_to_robots_that_are_never_there_together() -> None:
    made = kept_apart("objective: bot1 never_with bot2")
    assert points(made, 0.8, "a") == [(0, 0), (0, 0)] and points(made, 0.8, "b") == [(9, 0), (9, 0)]
    assert spots_in_one(made, 0.0) == ()
    at_one = kept_apart("objective: bot1 never_with bot2 at b")
    assert points(at_one, 0.8, "a") == [(0, 0), (0, 0.8)] and points(at_one, 0.8, "b") == [(9, 0), (9, 0)]


def test_a_given_pose_is_forwarded_to_robots_of_which_its_place_holds_one() -> None:
    made = kept_apart("objective: place b holds 1 robot", robots=3)
    assert points(made, 0.8, "a") == [(0, 0), (0, 0.8), (0, -0.8)] and points(made, 0.8, "b") == [(9, 0)] * 3


def test_what_is_optional_keeps_nobody_apart() -> None:
    assert points(kept_apart("optional 1 objective: bot1 never_with bot2"), 0.8, "b") == [(9, 0), (9, 0.8)]


def test_a_robot_that_meets_one_of_two_has_another_spot_than_that_one() -> None:
    made = kept_apart("objective: bot1 never_with bot2", "objective: bot3 never_with bot2", robots=3)
    assert points(made, 0.8, "b") == [(9, 0), (9, 0), (9, 0.8)], "bot1 and bot3 may be there together"


@given(st.sets(st.sampled_from([(a, b, c) for a, b in combinations("12345", 2) for c in ("", " at a", " at b")])))
def test_whoever_can_be_together_stands_apart(pairs: Set[Tuple[str, str, str]]) -> None:
    made = kept_apart(*(f"objective: bot{a} never_with bot{b}{where}" for a, b, where in sorted(pairs)), robots=5)
    table = spots_of(made, 0.8)
    for place in "ab":
        for a, b in combinations("12345", 2):
            if not pairs & {(a, b, ""), (a, b, f" at {place}")}:
                assert metres(table[f"bot{a}"][place], table[f"bot{b}"][place]) >= 0.8 - ROUNDING


def test_it_is_said_which_robots_are_sent_beside_a_given_pose_and_how_far() -> None:
    made = scenario({"a": f"//[1, 2, 0, {EAST}]", "b": "", "c": f"//[9, 9, 0, {EAST}] bot2 [9, 8, 0, {EAST}]"}, 3)
    assert moved(made, 0.5) == [
        "at a bot1 has the pose of the place; beside it: bot2 0.5 m, bot3 0.5 m (--spot-distance)",
        "at c bot1 has the pose of the place; beside it: bot3 0.5 m (--spot-distance)",
    ]
    assert moved(made, 0.0) == [] == moved(kept_apart("objective: bot1 never_with bot2"), 0.8)


YAW = st.floats(-math.pi, math.pi)
POINT = st.tuples(st.floats(-20, 20), st.floats(-20, 20), YAW)
PLACES = st.lists(POINT, min_size=1, max_size=5)


def comment(point: Tuple[float, float, float]) -> str:
    x, y, yaw = point
    return f"[{x!r}, {y!r}, 0, 0, 0, {math.sin(yaw / 2)!r}, {math.cos(yaw / 2)!r}]"


@settings(deadline=None)
@given(PLACES, st.integers(1, 6), st.floats(0.1, 5), st.dictionaries(st.integers(1, 6), POINT, max_size=3))
def test_robots_at_one_place_are_always_that_far_apart(
    places: List[Tuple[float, float, float]], robots: int, distance: float, own: Dict[int, Tuple[float, float, float]]
) -> None:
    behind = {f"p{number}": f"//{comment(point)}" for number, point in enumerate(places)}
    chosen = {f"bot{number}": point for number, point in own.items() if number <= robots}
    behind["p0"] += "".join(f" {robot} {comment(point)}" for robot, point in chosen.items())
    made = scenario(behind, robots)
    table = spots_of(made, distance)
    assert table == spots_of(made, distance)
    for place, present in robots_at(made).items():
        first = next((robot for robot in present if place != "p0" or robot not in chosen), None)
        for x, y in combinations(present, 2):
            given = {robot for robot in (x, y) if place == "p0" and (robot in chosen or robot == first)}
            if len(given) < 2:  # two poses that the author gave stay as they are
                assert metres(table[x][place], table[y][place]) >= distance - ROUNDING
    for robot, own_table in table.items():
        assert set(own_table) == set(behind)
        for pose in own_table.values():
            assert math.isclose(math.hypot(pose.qx, pose.qy, pose.qz, pose.qw), 1, abs_tol=1e-6), robot
            assert all(math.isfinite(number) for number in dataclasses.astuple(pose))


def test_a_leaning_or_upside_down_pose_has_a_side_too() -> None:
    for quaternion in ("0.7071067811865476, 0, 0, 0.7071067811865476", "0, 0.7071067811865476, 0, 0.7071067811865476"):
        made = scenario({"a": f"//[1, 2, 0, {quaternion}]"})
        first, second = points(made, 0.5, "a")
        assert math.dist(first, second) == pytest.approx(0.5, abs=ROUNDING)
