"""What missions with doors and with lifts share: a workspace laid over the built one, and what move_base needs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

FAKE = Path(__file__).with_name("fake_move_base.py")
CALM = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}


def made_of(text: str, name: str, ros: Ros, folder: Path, **more: Any) -> Path:
    """The workspace of a scenario."""
    read = parse(text, f"{name}.pur", name)
    won = solve_scenario(read, DEFAULT)
    options = Options(reaction=DEFAULT.reaction, **more)
    return lay_over(ros, write_workspace(read, won.network, won.objective, won.strategy, options, folder / "ws"))


def need_messages(ros: Ros) -> None:
    """Skips where there are not all messages of move_base."""
    wanted = "move_base_msgs.msg, actionlib_msgs.msg, tf2_ros"
    if ros.run(f"python3 -c 'import {wanted}'", ros.home).returncode:
        pytest.skip(f"not all of {wanted} is here")
