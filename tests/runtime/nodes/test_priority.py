"""Nodes that decide nothing about robots have a lower priority, also where the kernel groups processes by session."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

AUTOGROUP = Path("/proc/self/autogroup")
PROGRAM = """
import os, pathlib
from pursue_runtime.nodes.node import lower_priority
def shown():
    print(os.nice(0), pathlib.Path("/proc/self/autogroup").read_text().split()[-1])
shown()
lower_priority()
shown()
"""


def priorities(leads_session: bool) -> List[List[int]]:
    """The nice values of a process and of its session, before and after."""
    command = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(command, start_new_session=leads_session, stdout=subprocess.PIPE, text=True, check=True)
    return [[int(number) for number in line.split()] for line in done.stdout.splitlines()]


@pytest.mark.skipif(not AUTOGROUP.is_file() or not AUTOGROUP.read_text(), reason="the kernel has no autogroups")
@pytest.mark.parametrize("leads_session", [True, False], ids=["a node of roslaunch", "in the session of others"])
def test_the_priority_of_the_session_is_lowered_where_the_node_has_it_for_itself(leads_session: bool) -> None:
    before, after = priorities(leads_session)
    assert after == [before[0] + 5, before[1] + (5 if leads_session else 0)]
