"""ROS and built workspaces, for all tests of a session."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict

import pytest
from ros_world import NEEDED, Ros, generated, make

Build = Callable[..., Path]


@pytest.fixture(scope="session")
def ros(tmp_path_factory: pytest.TempPathFactory) -> Ros:
    """ROS 1 of this machine; the test is skipped where there is none."""
    found = Ros(tmp_path_factory.mktemp("ros_home"))
    paths = found.run(f"type -p {' '.join(NEEDED)}", found.home)
    missing = [name for name in NEEDED if f"/{name}\n" not in paths.stdout]
    if missing:
        pytest.skip(f"ROS 1 is not here: no {', '.join(missing)} on PATH")
    wanted = "rospy, rostest, transitions, diagnostic_msgs.msg, geometry_msgs.msg"
    modules = found.run(f"python3 -c 'import {wanted}'", found.home)
    if modules.returncode:
        pytest.skip(f"ROS 1 is not complete here: {modules.stdout.strip().splitlines()[-1]}")
    return found


@pytest.fixture(scope="session")
def built(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Build:
    """`built(name, controllers)`: the workspace of scenarios/<name>.pur, generated and built; each once."""
    known: Dict[str, Path] = {}

    def build(name: str, controllers: str = "distributed") -> Path:
        key = f"{Path(name).name}_{controllers}"
        if key not in known:
            known[key] = make(ros, generated(name, tmp_path_factory.mktemp(key) / "ws", controllers))
        return known[key]

    return build
