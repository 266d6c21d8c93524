"""Scenarios whose statements no other mission has, on ROS: an escort, and what is done several times."""

from __future__ import annotations

from pathlib import Path

import pytest
from ros_world import BEGIN, Ros, generated, judged, lay_over, missions

pytestmark = pytest.mark.ros


@pytest.mark.parametrize("name", ["museum/escort", "fields/seedlings"])
def test_it_goes_well_whatever_the_others_do(ros: Ros, tmp_path: Path, name: str) -> None:
    assert missions(judged(ros, lay_over(ros, generated(name, tmp_path / "ws")), BEGIN)) == 2
