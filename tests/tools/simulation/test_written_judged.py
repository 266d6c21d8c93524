"""Orders that people wrote, judged: what is accepted is kept, and what was late or had no plan is found."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Dict, Tuple

import pytest
from stages import stage

from pursue_gen.tools.replay import check
from pursue_gen.tools.replay.finding import FAULT, NOTE
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings

ORDERS = "hotel/tea_orders"


def ordered(scenario: str, seed: int, faults: Tuple[str, ...], *texts: str) -> SimulatedMission:
    """A simulated mission in which people write these orders, one after the other."""
    mission = SimulatedMission(stage(scenario), Settings("still", faults, until=500.0), seed, None)
    for number, text in enumerate(texts):
        mission.events.schedule(mission.events.now + 3.0 + 45.0 * number, lambda text=text: mission._order(text))
    return mission


@pytest.fixture(scope="module")
def recorded() -> Tuple[MissionRecord, Game]:
    """A mission with orders that were written."""
    texts = "bert at kitchen within 90", "do serve_room2 within 9 min", "nora at room3 within 80"
    mission = ordered(ORDERS, 2, (), *texts)
    assert mission.run().end == SAFE
    return mission.recorder.record(mission.events.now), stage(ORDERS).game


def test_what_was_written_is_judged_as_what_the_scenario_has(recorded: Tuple[MissionRecord, Game]) -> None:
    record, game = recorded
    taken = [state.event for state in record.states if state.agent == "order_desk" and state.event.startswith("order")]
    assert [event for event in taken if "_" not in event] == ["order1", "order2", "order3"]
    found = check(record, game)
    assert [each for each in found.findings if each.level != NOTE] == []
    assert found.steps and {step.state.event for step in found.steps} >= {"order1", "order2", "order3"}


def changed(record: MissionRecord, **order: Any) -> MissionRecord:
    """The record whose first order says something else in all plans."""

    def other(plan: Dict[str, Any]) -> Dict[str, Any]:
        adds = plan.get("adds")
        if adds is None:
            return plan
        first, *rest = adds["written"]
        return {**plan, "adds": {**adds, "written": [{**first, **order}, *rest]}}

    return replace(record, plans={number: other(dict(plan)) for number, plan in record.plans.items()})


def test_an_answer_that_comes_too_late_is_found(recorded: Tuple[MissionRecord, Game]) -> None:
    record, game = recorded
    found = check(changed(record, within=10.0), game).findings
    assert any(each.kind == "deadline" and each.level == FAULT for each in found)


def test_an_answer_to_something_else_is_found(recorded: Tuple[MissionRecord, Game]) -> None:
    record, game = recorded
    found = check(changed(record, says="nora at room3"), game).findings
    assert any(each.level == FAULT for each in found)


@pytest.mark.parametrize("order", [{"says": "bert at moon"}, {"event": "order7"}])
def test_what_the_scenario_does_not_know_is_a_fault_of_the_recording(
    recorded: Tuple[MissionRecord, Game], order: Dict[str, str]
) -> None:
    record, game = recorded
    found = check(changed(record, **order), game).findings
    assert any(each.kind == "recording" and "written" in each.text for each in found)


def test_what_was_taken_without_its_plan_is_found(recorded: Tuple[MissionRecord, Game]) -> None:
    record, game = recorded
    plans = {number: {**plan, "order": "another"} for number, plan in record.plans.items()}
    found = check(replace(record, plans=plans), game).findings
    taken = [state.seq for state in record.states if state.event == "order2"]
    assert {each.seq for each in found if each.kind == "order"} >= set(taken)


def test_with_faults_no_robot_gets_a_command_that_no_plan_holds() -> None:
    texts = "bert at kitchen within 150", "nora at room3 within 150", "any robot at room1 within 3 min"
    for seed in (4, 8, 9):  # stopped, and safe with all three of them; in others plans are looked for for long
        outcome = ordered(ORDERS, seed, ("delay", "loss", "deaths", "restart", "reorder"), *texts).run()
        assert outcome.problems == (), outcome.reason


def test_what_was_ordered_is_answered_before_a_mission_is_won() -> None:
    """In this scenario all is achieved after some 25 time units."""
    mission = ordered("thesis/scenario_1", 3, (), "bot1 at a within 90", "bot1 at c within 99")
    mission.events.schedule(mission.events.now + 16.0, lambda: mission._order("bot1 at a within 60 min"))
    assert mission.run().end == GOAL
    record = mission.recorder.record(mission.events.now)
    taken = {state.event for state in record.states if state.agent == "order_desk"}
    last = record.states[-1]
    waits = [name for name, place in last.locations.items() if place == "atRisk"]
    assert taken and last.status == "won" and waits == []
    early = next(state for state in record.states if "atRisk" in state.locations.values())
    states = [state for state in record.states if state.seq < early.seq]
    won = replace(record, states=(*states, early._replace(status="won")))
    found = check(won, stage("thesis/scenario_1").game).findings
    assert any("status is won, but obj is not idle" in each.text for each in found)


def test_a_scenario_without_orders_takes_what_is_written() -> None:
    mission = ordered("thesis/scenario_1", 1, (), "bot1 at a within 40")
    assert mission.run().end == GOAL
    record = mission.recorder.record(mission.events.now)
    assert "order1" in [state.event for state in record.states]
    assert [each for each in check(record, stage("thesis/scenario_1").game).findings if each.level != NOTE] == []
