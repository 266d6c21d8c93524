"""People take a robot out of service while a mission runs, and bring it back."""

from __future__ import annotations

from pathlib import Path

import pytest
from ordered_missions import ask, ordering
from ros_world import Ros

pytestmark = pytest.mark.ros

WARD = """\
poi "hall"
poi "east"
poi "west"
connect hall and east distance 10
connect hall and west distance 10
event "tea" on_order
event "serve" location east duration 3
agent "bot1" controllable mobile 1 location hall can_do serve
agent "bot2" controllable mobile 1 location west can_do serve
objective: if tea then serve within 200
"""


def test_a_robot_leaves_gets_no_order_and_comes_back_whatever_becomes_of_the_observer(ros: Ros, tmp_path: Path) -> None:
    with ordering(ros, tmp_path, WARD, ("bot1", "bot2")) as run:
        assert "in service already" in ask(run, "join bot2")
        left = ask(run, "leave bot2")
        assert "accepted: True" in left and "it stands at west, and counts there" in left
        assert run.now()["out_of_service"] == "bot2" and run.now()["plan"] != "0"
        old = run.kill("observer")
        run.until_back("observer", old)
        assert run.now()["out_of_service"] == "bot2"
        assert "accepted: True" in ask(run, "tea")
        run.until(lambda: run.steps().count("serveDONE") > 0)
        assert not [order for order in run.orders() if "bot2" in str(order)]
        assert "in service again" in ask(run, "join bot2")
        run.until(lambda: "out_of_service" not in run.now())
