"""poses.yaml: each robot is sent to its own pose of a place, and what cannot be read is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict

import pytest

from pursue_runtime.data import DataError, read_data
from pursue_runtime.poses import Doorway, Poses, read_poses

A, B, OWN = ([float(x), 2.0, 0.0, 0.0, 0.0, 0.0, 1.0] for x in (1, 5, 9))


def test_without_poses_of_their_own_all_robots_have_those_of_the_places() -> None:
    poses = read_poses({"poses": {"a": A, "b": B}})
    assert poses == Poses({"a": A, "b": B}, {}, {}, {}, {})
    assert poses.of(["bot1", "bot2"]) == {"bot1": {"a": A, "b": B}, "bot2": {"a": A, "b": B}}


def test_a_pose_of_a_robot_replaces_that_of_the_place_for_this_robot_alone() -> None:
    poses = read_poses({"poses": {"a": A, "b": B}, "robots": {"bot2": {"a": OWN}, "bot3": {"b": OWN}}})
    assert poses.of(["bot1", "bot2"]) == {"bot1": {"a": A, "b": B}, "bot2": {"a": OWN, "b": B}}


def test_spare_poses_are_of_single_robots_and_no_pose_of_a_place() -> None:
    poses = read_poses({"poses": {"a": A, "b": B}, "spare": {"bot2": {"a": OWN}}})
    assert poses.spare == {"bot2": {"a": OWN}} and poses.of(["bot2"]) == {"bot2": {"a": A, "b": B}}


def test_ways_of_a_robot_may_have_doors_and_a_place_in_front_of_them() -> None:
    ways = {"going_a_to_b": {"doors": ["d1"], "wait": OWN}, "going_b_to_a": {"doors": ["d1", "d2"]}}
    poses = read_poses({"poses": {"a": A, "b": B}, "doors": {"bot2": ways}})
    assert poses.doors == {
        "bot2": {
            "going_a_to_b": (Doorway(frozenset({"d1"}), OWN),), "going_b_to_a": (Doorway(frozenset({"d1", "d2"})),)
        }
    }  # fmt: skip


def test_on_a_way_by_lift_a_robot_waits_twice() -> None:
    inside = {"doors": ["l1 at b"], "wait": B, "aboard": True, "out": A}
    by_lift = [{"doors": ["l1 at a"], "wait": OWN}, inside]
    poses = read_poses({"poses": {"a": A, "b": B}, "doors": {"bot2": {"going_a_to_b": by_lift}}})
    halts = Doorway(frozenset({"l1 at a"}), OWN), Doorway(frozenset({"l1 at b"}), B, True, A)
    assert poses.doors == {"bot2": {"going_a_to_b": halts}}


@pytest.mark.parametrize(
    "doors",
    [
        7, {"b": 7}, {"b": {"x": ["d"]}}, {"b": {"x": []}}, {"b": {"x": {"doors": []}}},
        {"b": {"x": {"doors": ["d"], "wait": [1]}}},
    ],
)
def test_doors_that_cannot_be_read_are_refused(doors: object) -> None:
    with pytest.raises(DataError, match="poses.yaml"):
        read_poses({"poses": {"a": A}, "doors": doors})


def test_whole_numbers_and_those_that_yaml_takes_for_a_text_count() -> None:
    assert read_poses({"poses": {"a": [1, "2e0", 0, 0, 0, 0, 1]}}).places == {"a": A}


@pytest.mark.parametrize(
    ("data", "what"),
    [
        ({}, "expected poses:"),
        ({"poses": 7}, "expected poses:"),
        ({"poses": {"a": A}, "robots": []}, "robots: and a table"),
        ({"poses": {"a": A}, "robots": {"bot2": A}}, "bot2's own"),
        ({"poses": {"a": A}, "robots": {"bot2": {"b": B}}}, "bot2 has a pose at b"),
        ({"poses": {"a": A}, "robots": {"bot2": {"a": B[:6]}}}, "the pose of a for bot2"),
        ({"poses": {"a": A}, "spare": [A]}, "spare: and a table"),
        ({"poses": {"a": A}, "spare": {"bot2": {"b": B}}}, "bot2 has a pose at b"),
        ({"poses": {"a": A}, "spare": {"bot2": {"a": 3}}}, "the pose of a for bot2"),
        ({"poses": {"a": A[:6]}}, "the pose of a is"),
        ({"poses": {"a": [*A[:6], "east"]}}, "expected seven numbers"),
        ({"poses": {"a": [*A[:6], float("nan")]}}, "expected seven numbers"),
        ({"poses": {"a": [*A[:6], 10**400]}}, "expected seven numbers"),
        ({"poses": {"a": 3}}, "expected seven numbers"),
    ],
)
def test_what_is_no_table_of_poses_is_refused(data: Dict[str, Any], what: str) -> None:
    with pytest.raises(DataError, match=what):
        read_poses(data)


def test_all_formats_of_the_file_are_read_and_a_newer_one_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "poses.yaml"
    for number in (1, 2, 3, 4, 5, 6):
        file.write_text(f"format: {number}\nposes: {{a: {A}}}\n")
        assert read_poses(read_data(str(file))).places == {"a": A}
    file.write_text("format: 7\nposes: {}\n")
    with pytest.raises(DataError, match=r"poses\.yaml has format 7, and pursue_runtime [\d.]+ reads format 6"):
        read_data(str(file))
