"""The frames of the maps: one for all levels, or one for each."""

from __future__ import annotations

import pytest

from pursue_runtime.controller.settings import Settings, read_settings
from pursue_runtime.controller.whereabouts import NO_LEVELS, MapFrames, Position, Whereabouts, place_of
from pursue_runtime.data import DataError
from pursue_runtime.poses import read_poses

LEVELS = {"low": 0.0, "high": 4.0}


def test_one_frame_is_for_all_levels_and_says_nothing_of_the_level() -> None:
    for levels in (NO_LEVELS, LEVELS):
        frames = MapFrames("map", levels)
        assert (frames.of(0.0), frames.of(4.0), frames.elevation("/map")) == ("map", "map", None)


def test_each_level_may_have_a_frame_of_its_own() -> None:
    frames = MapFrames(read_settings("bot1", {"map_frame": "/{namespace}/{level}/map"}).map_frame, LEVELS)
    assert (frames.of(-0.2), frames.of(1.9), frames.of(4.3)) == ("bot1/low/map", "bot1/low/map", "bot1/high/map")
    assert frames.elevation("/bot1/high/map") == 4.0
    with pytest.raises(KeyError):
        frames.elevation("map")
    with pytest.raises(DataError, match="poses.yaml has no levels: generate the workspace with --map"):
        MapFrames("{level}/map", NO_LEVELS)


def test_a_robot_on_another_level_is_not_at_a_place_above_or_below_it() -> None:
    at = Whereabouts(Settings())
    here, above = (place_of(poi, [1.0, 2.0, z, 0.0, 0.0, 0.0, 1.0]) for poi, z in (("hall", 0.0), ("room", 4.0)))
    at.on_position(Position(1.0, 2.0, 0.0), 0.0)
    assert at.is_near(here) and at.is_near(above), "one map for all does not say where"
    at.on_position(Position(1.0, 2.0, 0.0, 0.0), 1.0)
    assert at.is_near(here) and not at.is_near(above) and at.describe(above) == "is on another level than {room}"
    at.on_arrival("hall")
    at.on_position(Position(1.0, 2.0, 0.0, 4.0), 2.0)
    assert at.is_near(above) and not at.is_known_at(here, 9.0), "it has moved"


def test_levels_are_read_with_the_poses() -> None:
    data = {"format": 6, "poses": {"hall": [0, 0, 0, 0, 0, 0, 1]}}
    assert read_poses(data).levels == {} and read_poses({**data, "levels": {"low": 0, "high": 4.5}}).levels == {
        "low": 0.0, "high": 4.5
    }  # fmt: skip
    for wrong in ([], {"low": "ground"}, {"low": float("inf")}, 3):
        with pytest.raises(DataError, match="expected levels: and the elevation of each"):
            read_poses({**data, "levels": wrong})
