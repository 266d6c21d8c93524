"""Events of a controller that is not subscribed to the states count for nothing: they may be of an earlier mission."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Callable

import pytest
from ros_world import PUBLISH_EVENT, Ros, end

from tests.waiting import until

pytestmark = pytest.mark.ros
NODE = Path(__file__).resolve().parent / "controller_without_states.py"


def test_words_of_a_controller_that_does_not_hear_the_observer_count_nothing(
    ros: Ros, built: Callable[..., Path], tmp_path: Path
) -> None:
    workspace, source = built("thesis/scenario_1"), "source devel/setup.bash; "
    with ros.master() as where:
        command = f"{source}exec rosrun observer observer --planner off _on_uncovered:=warn"
        log = tmp_path / "observer"
        observer = ros.start(command, workspace, log, PYTHONUNBUFFERED="1", **where)

        def state() -> str:
            return ros.run("rostopic echo -n 1 pursue/system_state", workspace, **where).stdout

        def counted() -> bool:
            text = state()
            assert "status=" in text and "status=waiting" not in text, text
            return "bot1=going_c_to_b" in text

        controller = subprocess.Popen(
            ["bash", "-c", f"{source}exec python3 {NODE}"], cwd=workspace, env={**ros.environment, **where}, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
        )  # fmt: skip

        def publish(word: str) -> None:
            assert controller.stdin is not None and controller.stdout is not None
            controller.stdin.write(word + "\n")
            controller.stdin.flush()
            assert controller.stdout.readline().strip() == word

        try:
            ros.run(f"python3 {PUBLISH_EVENT} _start_", workspace, **where)
            until(lambda: "status=waiting" not in state(), "the mission runs")
            publish("bot1:bot1_c2b")
            until(lambda: "does not receive the states" in log.read_text(), "the observer has received the event")
            assert not counted(), log.read_text()
            publish("listen")
            publish("bot1:bot1_c2b")
            until(counted, "the event counts")
        finally:
            assert controller.stdin is not None
            controller.stdin.close()  # it reads until then
            end(controller)
            end(observer)
