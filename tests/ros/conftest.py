"""ROS and built workspaces, for all tests of a session."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Callable, Iterator

import pytest
from preloaded import preloaded
from ros_world import NEEDED, Ros, generated, lay_over

Build = Callable[..., Path]
How = Callable[[Ros, Path], Path]


@pytest.fixture(scope="session")
def ros(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ros]:
    """ROS 1 of this machine; the test is skipped where there is none."""
    base = tmp_path_factory.getbasetemp()
    shared = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "shared"
    shared.mkdir(exist_ok=True)
    found = Ros(tmp_path_factory.mktemp("ros_home"), shared)
    paths = found.run(f"type -p {' '.join(NEEDED)}", found.home)
    missing = [name for name in NEEDED if f"/{name}\n" not in paths.stdout]
    if missing:
        pytest.skip(f"ROS 1 is not here: no {', '.join(missing)} on PATH")
    wanted = "rospy, rostest, transitions, diagnostic_msgs.msg, geometry_msgs.msg"
    modules = found.run(f"python3 -c 'import {wanted}'", found.home)
    if modules.returncode:
        pytest.skip(f"ROS 1 is not complete here: {modules.stdout.strip().splitlines()[-1]}")
    with preloaded(tmp_path_factory.mktemp("preloaded"), found.environment["PATH"]) as found.preloaded:
        yield found


@pytest.fixture(scope="session")
def built(ros: Ros) -> Build:
    """`built(name, controllers)`: the workspace of scenarios/<name>.pur, generated, and run from its sources over the
    packages that all have in common, so that its nodes are forked; each once in a session.

    `built(name, controllers, make)` builds it with that function of ros_world. Other tests use a workspace at the same
    time: who changes anything in it makes one of their own.
    """

    def build(name: str, controllers: str = "distributed", how: How = lay_over) -> Path:
        def workspace(folder: Path) -> None:
            how(ros, generated(name, folder, controllers))

        return ros.once(f"{Path(name).name}_{controllers}_{how.__name__}", workspace)

    return build
