"""ROS and built workspaces, for all tests of a session."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Callable, Dict, List

import pytest
from ros_world import NEEDED, Ros, generated, make

Build = Callable[..., Path]
HERE = Path(__file__).resolve().parent


def pytest_collection_modifyitems(config: pytest.Config, items: List[pytest.Item]) -> None:
    """In CI a test on ROS that fails is run once more, as rostest's `retry` does it, and the report says so: a dozen
    processes in real time depend on the machine as well. On a person's machine the first failure counts."""
    if os.environ.get("CI") and config.pluginmanager.hasplugin("rerunfailures"):
        for item in items:
            if HERE in item.path.parents:
                item.add_marker(pytest.mark.flaky(reruns=1, reruns_delay=2))


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
