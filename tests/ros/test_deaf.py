"""Who does not hear the observer cannot speak of this mission: what it says may be of the one before."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Callable

import pytest
from ros_world import SAY, Ros, end

from tests.waiting import until

pytestmark = pytest.mark.ros
DEAF = Path(__file__).resolve().parent / "deaf.py"


def test_words_of_a_controller_that_does_not_hear_the_observer_count_nothing(
    ros: Ros, built: Callable[..., Path], tmp_path: Path
) -> None:
    workspace, source = built("thesis/scenario_1"), "source devel/setup.bash; "
    with ros.master() as where:
        command = f"{source}exec rosrun observer observer _planner:=off _on_uncovered:=warn"
        log = tmp_path / "observer"
        observer = ros.start(command, workspace, log, PYTHONUNBUFFERED="1", **where)

        def state() -> str:
            return ros.run("rostopic echo -n 1 pursue/system_state", workspace, **where).stdout

        def goes() -> bool:
            text = state()
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

        try:
            ros.run(f"python3 {SAY} _start_", workspace, **where)
            until(lambda: "status=waiting" not in state(), "the mission runs")
            say("bot1:bot1_c2b")
            until(lambda: "does not receive the states" in log.read_text(), "the observer has heard the word")
            assert not goes(), log.read_text()
            say("listen")
            say("bot1:bot1_c2b")
            until(goes, "the word counts")
        finally:
            assert deaf.stdin is not None
            deaf.stdin.close()  # it reads on whatever else it is told
            end(deaf)
            end(observer)
