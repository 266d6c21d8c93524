"""Folders that the nodes write to and read from under ROS_HOME."""

from __future__ import annotations

import os
from typing import Mapping

MISSIONS = os.path.join("pursue", "missions")
"""The folder of received missions, below ROS_HOME."""


def ros_home(environment: Mapping[str, str]) -> str:
    """Return ROS_HOME; ~/.ros where it is not set."""
    return environment.get("ROS_HOME") or os.path.join(os.path.expanduser("~"), ".ros")


def keys_folder(environment: Mapping[str, str]) -> str:
    """Return the default folder of the trusted keys."""
    return os.path.join(ros_home(environment), "pursue", "keys")


def missions_folder(environment: Mapping[str, str]) -> str:
    """Return the folder of the missions that this machine has received."""
    return os.path.join(ros_home(environment), MISSIONS)


def scenario_folder(environment: Mapping[str, str], scenario: str) -> str:
    """Return the folder of a scenario's journals, recordings and simulated clocks."""
    return os.path.join(ros_home(environment), "pursue", scenario)


def sync_folder(folder: str) -> None:
    """Make the names in this folder ("": the present one) survive a power cut. Raises OSError."""
    handle = os.open(folder or ".", os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
