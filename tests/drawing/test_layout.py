"""Places on a map for the points of interest that have none."""

from __future__ import annotations

import math
from typing import List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.drawing.layout import poses
from pursue_gen.language import parse
from pursue_gen.language.scenario import Pose


def apart(a: Pose, b: Pose) -> float:
    return math.hypot(a.x - b.x, a.y - b.y)


def pois(names: str) -> str:
    return "".join(f'poi "{name}"\n' for name in names)


def test_given_poses_are_kept_as_they_are() -> None:
    scenario = parse('poi "a" //[1, 2, 3, 0, 0, 0, 1]\npoi "b" //[4, 5, 6, 0, 0, 1, 0]', "test.pur")
    found, computed = poses(scenario)
    assert not computed
    assert found == {"a": Pose(1, 2, 3, 0, 0, 0, 1), "b": Pose(4, 5, 6, 0, 0, 1, 0)}


def test_a_triangle_is_laid_out_true_to_scale() -> None:
    ways = "connect a and b distance 3 connect b and c distance 4 connect c and a distance 5"
    found, computed = poses(parse(pois("abc") + ways, "test.pur"))
    assert computed
    for x, y, length in (("a", "b", 3), ("b", "c", 4), ("c", "a", 5)):
        assert apart(found[x], found[y]) == pytest.approx(length, abs=0.05)
    assert all(pose == Pose(pose.x, pose.y, 0, 0, 0, 0, 1) for pose in found.values())


def test_a_corridor_is_a_line() -> None:
    found, _ = poses(parse(pois("acb") + "connect a and c distance 2 connect c and b distance 7", "test.pur"))
    assert apart(found["a"], found["b"]) == pytest.approx(9, abs=0.05)


def test_missing_places_are_found_around_the_given_ones() -> None:
    text = 'poi "a" //[10, 10, 1, 0, 0, 0, 1]\npoi "b" //[16, 10, 1, 0, 0, 0, 1]\npoi "c"\n'
    found, computed = poses(parse(text + "connect a and c distance 5 connect c and b distance 5", "test.pur"))
    assert computed
    assert found["a"] == Pose(10, 10, 1, 0, 0, 0, 1)
    # a and b are 6 apart on the map but 10 by way of c, which does not matter to c
    assert apart(found["a"], found["c"]) == pytest.approx(5, abs=0.1)
    assert apart(found["b"], found["c"]) == pytest.approx(5, abs=0.1)


def test_a_single_place_and_none() -> None:
    assert poses(parse('poi "a"', "test.pur")) == ({"a": Pose(0, 0, 0, 0, 0, 0, 1)}, True)
    assert poses(parse("", "test.pur")) == ({}, False)


def test_parts_that_are_not_connected_stand_side_by_side() -> None:
    text = pois("abcde") + "connect a and b distance 4 connect c and d distance 4"
    found, _ = poses(parse(text, "test.pur"))
    assert max(found["a"].x, found["b"].x) < min(found["c"].x, found["d"].x)
    assert max(found["c"].x, found["d"].x) < found["e"].x


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6), st.integers(0, 30)), max_size=14), st.integers(0, 3))
def test_any_map_gets_finite_rounded_and_repeatable_places(ways: List[Tuple[int, int, int]], given_: int) -> None:
    lines = [f'poi "p{i}"' + (f" //[{i}, {i % 2}, 0, 0, 0, 0, 1]\n" if i < given_ else "\n") for i in range(7)]
    lines += [f"connect p{a} and p{b} distance {length}\n" for a, b, length in ways]
    scenario = parse("".join(lines), "test.pur")
    found, computed = poses(scenario)
    assert computed and list(found) == [poi.name for poi in scenario.pois]
    assert poses(scenario) == (found, computed)
    for pose in found.values():
        assert math.isfinite(pose.x) and math.isfinite(pose.y)
        assert (round(pose.x, 2), round(pose.y, 2)) == (pose.x, pose.y)


@given(st.lists(st.integers(1, 20), min_size=1, max_size=6))
def test_a_tree_of_ways_keeps_every_length(lengths: List[int]) -> None:
    """A star: every pair is as far apart as the way over its centre at most, and every way has about its length."""
    text = 'poi "hub"\n' + "".join(f'poi "p{i}"\n' for i in range(len(lengths)))
    text += "".join(f"connect hub and p{i} distance {length}\n" for i, length in enumerate(lengths))
    found, _ = poses(parse(text, "test.pur"))
    for i, length in enumerate(lengths):
        assert apart(found["hub"], found[f"p{i}"]) == pytest.approx(length, rel=0.35)
