"""All that nodes read and write by themselves is under ROS_HOME."""

from __future__ import annotations

from typing import Dict

import pytest

from pursue_runtime.folders import keys_folder, missions_folder, ros_home, scenario_folder


@pytest.mark.parametrize(("environment", "home"), [
    ({"ROS_HOME": "/var/ros"}, "/var/ros"), ({"ROS_HOME": ""}, "/home/ada/.ros"), ({}, "/home/ada/.ros"),
])
def test_folders_are_under_ros_home(environment: Dict[str, str], home: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/home/ada")
    assert ros_home(environment) == home
    assert keys_folder(environment) == f"{home}/pursue/keys"
    assert missions_folder(environment) == f"{home}/pursue/missions"
    assert scenario_folder(environment, "library") == f"{home}/pursue/library"
