"""The run time is what its imports say: everything but its nodes runs without ROS, and all of it on Python 3.8."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import Set

import pytest

import pursue_runtime

ROOT = Path(pursue_runtime.__file__).parent
MODULES = sorted(path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*.py"))
ROS = {"rospy", "roslib", "rosbag", "rosgraph", "rospkg", "rostest", "genpy", "tf2_ros"}


def imported(text: str) -> Set[str]:
    """The top-level names of what a module imports, wherever it does that."""
    found: Set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {name.name.split(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add((node.module or "").split(".")[0])
    return found


@pytest.mark.parametrize("module", MODULES)
def test_a_module_is_python_3_8_and_needs_ros_only_as_a_node(module: str) -> None:
    text = (ROOT / module).read_text(encoding="utf-8")
    ast.parse(text, module, feature_version=(3, 8))
    names = imported(text)
    assert "pursue_gen" not in names
    if not module.startswith("nodes/"):
        assert not {name for name in names if name in ROS or name.endswith("_msgs")}


def test_the_decisions_can_be_imported_where_there_is_no_ros() -> None:
    code = "import sys; sys.modules.update(rospy=None, rosgraph=None); import pursue_runtime.{}"
    for module in ("observer.mission", "controller.follower", "ui.mission_view", "simulator.simulator", "reader.store"):
        subprocess.run([sys.executable, "-c", code.format(module)], check=True)
