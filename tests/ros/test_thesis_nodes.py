"""What nodes and eyes of the thesis find in a mission: plain words, states that each node prints, all communication."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Callable

import pytest
from launched_mission import EVENTS, launched
from ros_world import Ros

pytestmark = pytest.mark.ros


def test_a_mission_with_plain_words_printed_states_and_all_communication(
    ros: Ros, built: Callable[..., Path], tmp_path: Path
) -> None:
    options = {"plain_words": True, "print_state": True, "show": "f", "use_sim_time": True, "speed": 4}
    with launched(ros, built("thesis/scenario_1"), tmp_path, **options) as run:
        assert run.until_over() == "won", run.output()
        plain = [entry["data"] for entry in run.of("pursue/plain_words", "observer")]
        steps = [*run.steps(), "Finish!"]
        assert "bot1_c2b" in plain and plain == steps[-len(plain) :], "all from when the logger was connected"
        said = [entry["data"] for entry in run.of(EVENTS, "observer")]
        assert set(said) <= {"Finish!"}, "nothing of it is a word that counts"
        output = run.output()
        for node in ("observer", "controller_bot1", "controllerObj", "simulator", "UI"):
            assert f"{node}: bot1 is going_c_to_b" in output
        assert re.search(r"on pursue/events: bot1:bot1_c2b@\d+", output)
        assert re.search(r"on bot\d/pursue/actions: ", output)
        assert "on pursue/system_state: seq=1 " in output
        assert run.crashes() == []
