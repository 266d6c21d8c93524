"""People order while a mission is under way: accepted with a plan that is proven, refused with the reason."""

from __future__ import annotations

from pathlib import Path

import pytest
from ordered_missions import ask, ordering, told
from ros_world import Ros

from tests.runtime.observer.test_ordering import TEA as STORY_TEXT

pytestmark = pytest.mark.ros

TEA = STORY_TEXT.replace("within 60", "within 200")

PUBLISH = "rostopic pub -1 pursue/orders std_msgs/String 'data: {}'"


def test_orders_are_accepted_with_a_plan_or_refused_with_the_reason(ros: Ros, tmp_path: Path) -> None:
    with ordering(ros, tmp_path, TEA, ("bot",)) as run:
        assert "refused: nobody can order coffee; expected one of tea1, tea2" in ask(run, "coffee")
        accepted = ask(run, "tea1")
        assert "accepted: True" in accepted and "s at the latest" in accepted
        assert run.now()["places"]["obj"] == "atRisk" and run.now()["plan"] != "0"
        refused = ask(run, "tea2 within 2")
        assert "accepted: False" in refused and "possible: " in refused and "possible: 0.0" not in refused
        assert run.now()["places"]["obj2"] == "idle"
        assert "not cancelled: no tea2 waits for its answer" in ask(run, "cancel tea2")
        told(run, PUBLISH.format("tea2"))
        run.until(lambda: run.now()["places"]["obj2"] == "atRisk")
        assert "text: \"cancelled\"" in ask(run, "cancel tea2")
        assert run.now()["places"]["obj2"] == "idle"
        run.until(lambda: run.steps().count("serve1DONE") > 0)
        assert run.now()["places"]["obj"] == "idle" and "serve2" not in run.steps()
        assert run.now()["status"] == "running"


def test_what_is_written_is_accepted_where_the_scenario_has_no_orders(ros: Ros, tmp_path: Path) -> None:
    text = "\n".join(line for line in TEA.splitlines() if "tea" not in line)
    text += '\npoi "garden"\nagent "guest" location garden\n'
    with ordering(ros, tmp_path, f"{text}\nobjective: bot never_with guest\n", ("bot",)) as run:
        assert "column 8: there is no POI room9" in ask(run, "bot at room9 within 60")
        accepted = ask(run, "bot at room1 within 100")
        assert "accepted: True" in accepted and "s at the latest" in accepted
        assert run.now()["places"]["obj2"] == "atRisk" and run.now()["plan"] != "0"
        refused = ask(run, "bot at room2 within 2")
        assert "accepted: False" in refused and "possible: " in refused and "possible: 0.0" not in refused
        run.until(lambda: run.now()["places"]["bot"] == "room1")
        assert run.now()["places"]["obj2"] == "idle"
        told(run, PUBLISH.format("do serve2 within 100"))
        run.until(lambda: run.steps().count("serve2DONE") > 0)
        assert run.now()["places"]["obj3"] == "idle" and run.now()["status"] == "running"
