"""A robot that turned round on a blocked way: a recording shows it, and nothing of it is a fault."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest
import yaml

from pursue_gen.tools.replay.check import check
from pursue_gen.tools.replay.finding import FAULT, WORLD
from pursue_gen.tools.replay.journal import Journal as JournalFile
from pursue_gen.tools.replay.journal import read_journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.record import MissionRecord, RobotOrder, read_word
from pursue_runtime.model import Model
from pursue_runtime.observer.journal import Journal
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import SystemState
from tests.tools.replay.recordings import game
from tests.tools.replay.test_check import plan_data
from tests.workspace.worlds import files

PLAN = {**plan_data(), "cover": {"format": 1, "cover": [{"state": {}, "wait": ["always"]}]}}
for part in PLAN["strategies"].values():
    part["strategy"] = []  # the workspace's own would take the blocked way

CALLS: Tuple[Tuple[float, str, Tuple[Any, ...]], ...] = (
    (0.0, "hear", ("_start_",)),
    (0.2, "hear", ("reachObj:reachObj_going_initial_location2unlocked@1",)),
    (1.2, "hear", ("bot1:bot1_c2b@2",)),
    (9.0, "hear", ("bot1:_blocked_",)),
    (9.5, "planned", (1, {**PLAN, "turning": ["bot1"]})),
    (9.6, "hear", ("controller_bot1:_plan_@1",)),
    (12.0, "hear", ("bot1_going_b_to_c2c",)),
)
"""bot1 cannot go from c to b, and goes back to c."""


@pytest.fixture(params=[0.0, 10.0])
def played(tmp_path: Path, request: pytest.FixtureRequest) -> Tuple[List[SystemState], bytes]:
    """The states of the mission, and its journal; the plan comes at once, or after the way back begins with it."""
    model = Model(yaml.safe_load(files("thesis/scenario_1")["src/observer/config/model.yaml"]))
    log = lambda level, text: None
    mission = Mission(model, None, log, on_uncovered="plan", controllers=["controller_bot1"])
    header: Dict[str, Any] = {"scenario": "scenario_1", "settings": {"time_unit": 1.0}}
    journal = Journal(mission, str(tmp_path / "journal.jsonl"), header, log)
    moments = [100.0 + at + (request.param if at > 9.0 else 0.0) for at, _, _ in CALLS]
    calls = zip(moments, CALLS)
    states = [state for now, (_, name, args) in calls for state in journal.call(name, *args, now=now)]
    return states, (tmp_path / "journal.jsonl").read_bytes()


def test_the_turn_is_shown_and_is_no_fault(played: Tuple[List[SystemState], bytes]) -> None:
    states, _ = played
    assert [state.locations["bot1"] for state in states][-3:] == ["going_c_to_b", "going_b_to_c", "c"]
    words = tuple(
        read_word(100.0 + at, args[0], "controller_bot1" if at == 1.2 else "controllerObj" if "@" in args[0] else "")
        for at, name, args in CALLS if name == "hear"
    )
    turned = next(state.stamp for state in states if state.locations["bot1"] == "going_b_to_c")
    goals = ((101.3, 1.0), (turned + 0.1, 2.0))
    orders = tuple(RobotOrder(at, "bot1", "controller_bot1", (x, 0.0, 0.0)) for at, x in goals)
    findings = check(MissionRecord(tuple(states), words, orders, {1: PLAN}), game()).findings
    assert [f.kind for f in findings if f.level == FAULT] == []
    assert [(f.kind, f.text) for f in findings if f.kind == "turned" and f.level == WORLD] == [
        ("turned", "bot1 turned round: it could not go on")
    ]


def test_a_goal_back_without_a_turn_is_a_fault(played: Tuple[List[SystemState], bytes]) -> None:
    states, _ = played
    there = [state._replace(plan=0) for state in states]
    kinds = {f.kind for f in check(MissionRecord(tuple(there), (), ()), game()).findings if f.level == FAULT}
    assert "step" in kinds


@pytest.mark.parametrize("played", [0.0], indirect=True)  # a journal does not say for when a plan was computed
def test_the_journal_leads_to_the_same_states(played: Tuple[List[SystemState], bytes]) -> None:
    states, content = played
    journal = read_journal(content)
    assert isinstance(journal, JournalFile) and not journal.problems
    record = reconstruct(journal, Moves(game().network), game().objective)
    seen = {state.seq: (state.discrete(), state.plan, state.clocks) for state in record.states}
    assert seen == {state.seq: (state.discrete(), state.plan, state.clocks) for state in states}
