"""People who order in simulated missions: what is accepted is kept, and a judge finds what was taken without a plan."""

from __future__ import annotations

from dataclasses import replace
from typing import Dict

from stages import stage

from pursue_gen.tools.replay import check
from pursue_gen.tools.replay.finding import FAULT
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.simulation.mission import SimulatedMission, simulate_mission
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_runtime.event_words import CANCELLED, JOINS, LEAVES

ORDERS = "hotel/tea_orders"
WRONG = (FAULT, "service")


def test_whatever_is_accepted_is_kept() -> None:
    outcomes = [simulate_mission(stage(ORDERS), Settings("mixed", until=700.0), seed) for seed in range(1, 4)]
    assert {each.end for each in outcomes} == {SAFE}, [each.reason for each in outcomes]
    assert sum(each.plan for each in outcomes) > 3


def test_with_faults_no_robot_gets_a_command_that_no_plan_holds() -> None:
    settings = Settings("mixed", ("delay", "loss", "deaths", "restart", "reorder"), until=400.0)
    for seed in (3, 7, 9):  # in others a plan for a mission that holds is looked for for long
        outcome = simulate_mission(stage(ORDERS), settings, seed)
        assert outcome.problems == (), outcome.reason


def test_an_order_that_was_taken_without_its_plan_is_found() -> None:
    mission = SimulatedMission(stage(ORDERS), Settings("still", until=700.0), 2, None)
    mission.run()
    record, game = mission.recorder.record(mission.events.now), stage(ORDERS).game
    taken = [state.seq for state in record.states if state.agent == "order_desk"]
    assert taken and not [each for each in check(record, game).findings if each.level == FAULT]
    plans = {number: {**plan, "order": "another"} for number, plan in record.plans.items()}
    found = check(replace(record, plans=plans), game).findings
    assert {each.seq for each in found if each.kind == "order"} == set(taken)


def test_what_is_cancelled_is_not_due_any_more_and_that_is_proven() -> None:
    mission = SimulatedMission(stage(ORDERS), Settings("still", until=1500.0), 2, None)
    outcome = mission.run()
    record, game = mission.recorder.record(mission.events.now), stage(ORDERS).game
    cancelled = [state.seq for state in record.states if state.event.endswith(CANCELLED)]
    assert outcome.end == SAFE and cancelled
    assert [each.seq for each in check(record, game).findings if "was cancelled" in each.text] == cancelled
    old = next(state for state in record.states if state.seq == cancelled[0] - 1)
    states = [
        each._replace(locations={**each.locations, "nora": old.locations["bert"]}) if each.seq == cancelled[0] else each
        for each in record.states
    ]
    found = check(replace(record, states=states), game).findings
    assert [each.kind for each in found if each.seq == cancelled[0] and each.level == FAULT] == ["step"]


def test_a_robot_that_leaves_gets_no_command_and_a_judge_finds_what_does_not_fit_that() -> None:
    mission = SimulatedMission(stage(ORDERS), Settings("still", until=700.0), 3, None)
    outcome = mission.run()
    record, game = mission.recorder.record(mission.events.now), stage(ORDERS).game
    left, joined = (next(each for each in record.states if each.event == word) for word in (LEAVES, JOINS))
    assert outcome.end == SAFE and left.seq < joined.seq and left.out_of_service == (left.agent,)
    found = check(record, game).findings
    assert not [each for each in found if each.level == FAULT]
    assert [each.seq for each in found if each.kind == "service"][:2] == [left.seq, joined.seq]

    def faults(changed: MissionRecord) -> Dict[int, str]:
        return {each.seq: each.text for each in check(changed, game).findings if (each.level, each.kind) == WRONG}

    plan = {**record.plans[left.plan], "order": "tea"}
    assert set(faults(replace(record, plans={**record.plans, left.plan: plan}))) == {left.seq}
    states = [each._replace(out_of_service=("nora",)) for each in record.states]
    texts = faults(replace(record, states=states)).values()
    assert any("nora, which takes part in it, is out of service" in text for text in texts)
    states = [each._replace(out_of_service=()) if each.seq > left.seq else each for each in record.states]
    unsaid = {left.seq + 1: "bert is in service again, and nobody brought it back"}
    assert faults(replace(record, states=states)) == unsaid


def test_people_write_orders_too_and_what_is_accepted_of_these_is_kept() -> None:
    mission = SimulatedMission(stage(ORDERS), Settings("still", until=700.0), 4, None, record=True)
    assert mission.run().end == SAFE
    assert any(line.endswith("somebody orders bert at hall within 405.9") for line in mission.lines)
    record = mission.recorder.record(mission.events.now)
    assert [state.event for state in record.states if state.event == "order1"] == ["order1"]
    assert not [each for each in check(record, stage(ORDERS).game).findings if each.level == FAULT]


def test_nobody_orders_where_there_is_nothing_to_order() -> None:
    mission = SimulatedMission(stage("thesis/scenario_1"), Settings("still"), 1, None, record=True)
    mission.run()
    assert not any("somebody orders" in line for line in mission.lines)
