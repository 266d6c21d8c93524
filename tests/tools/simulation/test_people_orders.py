"""People who order in simulated missions: what is accepted is kept, and a judge finds what was taken without a plan."""

from __future__ import annotations

from dataclasses import replace

from stages import stage

from pursue_gen.tools.replay import check
from pursue_gen.tools.replay.finding import FAULT
from pursue_gen.tools.simulation.mission import SimulatedMission, simulate_mission
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_runtime.event_words import CANCELLED

ORDERS = "hotel/tea_orders"


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


def test_nobody_orders_where_there_is_nothing_to_order() -> None:
    mission = SimulatedMission(stage("thesis/scenario_1"), Settings("still"), 1, None, record=True)
    mission.run()
    assert not any("somebody orders" in line for line in mission.lines)
