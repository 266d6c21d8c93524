"""Who does not hear the observer cannot speak of this mission: what it says may be of the one before."""

from __future__ import annotations

import subprocess
import time
from pathlib import Path
from typing import Callable

import pytest
from ros_world import Ros, end

pytestmark = pytest.mark.ros
DEAF = Path(__file__).resolve().parent / "deaf.py"


def test_words_of_a_controller_that_does_not_hear_the_observer_count_nothing(
    ros: Ros, built: Callable[..., Path], tmp_path: Path
) -> None:
    workspace, source = built("thesis/scenario_1"), "source devel/setup.bash; "
    with ros.master() as where:
        command = f"{source}exec rosrun observer observer _planner:=off _on_uncovered:=warn"
        observer = ros.start(command, workspace, tmp_path / "observer", **where)

        def goes() -> bool:
            text = ros.run("rostopic echo -n 1 pursue/system_state", workspace, 20, **where).stdout
            assert "status=" in text and "status=waiting" not in text, text
            return "bot1=going_c_to_b" in text

        deaf = subprocess.Popen(
            ["bash", "-c", f"{source}exec python3 {DEAF}"], cwd=workspace, env={**ros.environment, **where}, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
        )  # fmt: skip

        def say(word: str) -> None:
            assert deaf.stdin is not None and deaf.stdout is not None
            deaf.stdin.write(word + "\n")
            deaf.stdin.flush()
            assert deaf.stdout.readline().strip() == word
            time.sleep(0.5)

        try:
            ros.run("rostopic pub -1 pursue/events std_msgs/String _start_", workspace, 20, **where)
            say("bot1:bot1_c2b")
            assert not goes(), (tmp_path / "observer").read_text()
            say("listen")
            say("bot1:bot1_c2b")
            assert goes(), (tmp_path / "observer").read_text()
        finally:
            end(deaf)
            end(observer)
