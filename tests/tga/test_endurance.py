"""Batteries by time in the game: robots are back at their chargers in time, and full only after a whole charge."""

from __future__ import annotations

from typing import List, Optional, Sequence, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.ablations import without_each
from pursue_gen.explanation.explain import explain
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import ClockBound
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.tools.simulation.promises import Promises
from pursue_gen.tools.simulation.runs import MissionRunner, case_of
from pursue_gen.vocabulary.statuses import statuses
from pursue_gen.workspace import Options
from pursue_runtime.state import LOST, SystemState

HOUSE = """\
poi "dock"
poi "hall"
poi "attic"
connect dock and hall distance 3
connect hall and attic distance 3
event "ring" location hall
event "wipe" location hall duration 1
agent "bot" controllable mobile 1 location dock can_do wipe
agent "guest" location hall can_do ring
battery "bot" lasts {}, charges in {} at dock
{}
"""
PATROL = "objective: patrol hall every {} by bot"
CALLS = "assume: guest waits {} between ring\nobjective: if ring then wipe within {}"


def house(lasts: object, charge: object, more: str) -> Scenario:
    return parse(HOUSE.format(lasts, charge, more), "x.pur", "x")


def solved(scenario: Scenario) -> Optional[Solution]:
    try:
        return solve_scenario(scenario, Rules())
    except PursueError as problem:
        assert problem.exit_status == 4
        return None


def test_its_automaton_has_a_clock_since_it_was_full_and_one_since_the_robot_came() -> None:
    network = translate(house(60, 20, PATROL.format(40)))
    automaton = network.automaton("obj2")
    assert network.clocks[-2:] == ("Cobj2", "Ccharge2") and automaton.initial == "idle"
    assert automaton.stays == {
        "atRisk": (ClockBound("Cobj2", "<=", 60),),
        "atCharger": (ClockBound("Ccharge2", "<=", 20), ClockBound("Cobj2", "<=", 60)),
        "atChargerEmpty": (ClockBound("Ccharge2", "<=", 20),),
    }
    assert [(edge.source, edge.target, edge.channel, edge.resets) for edge in automaton.edges if edge.sync] == [
        ("idle", "atRisk", "bot_dock2hall", ("Cobj2",)),
        ("atCharger", "atRisk", "bot_dock2hall", ()),
        ("atChargerEmpty", "lose", "bot_dock2hall", ()),
        ("atRisk", "atCharger", "bot_going_hall_to_dock2dock", ("Ccharge2",)),
    ]
    away = HOUSE.format(60, 20, PATROL.format(40)).replace("location dock can_do", "location hall can_do")
    assert translate(parse(away, "x.pur", "x")).automaton("obj2").initial == "atRisk"
    assert patrols(network) == {"obj"}, "a battery is no patrol: to come is not enough"


def test_it_is_read_as_it_is_written_for_uppaal() -> None:
    scenario = house(60, 20, PATROL.format(40))
    network = translate(scenario)
    assert read_network(write_network(network, scenario_objective(scenario)), "TGA.xml") == network


@pytest.mark.parametrize(
    ("lasts", "charge", "more", "won"),
    [
        # There and back takes 8 to 10 with pauses; after it, a charge.
        (20, 20, PATROL.format(40), True),
        (20, 20, PATROL.format(25), False),  # no time to charge
        (8, 20, PATROL.format(40), False),  # it does not last for the way back
        (60, 20, PATROL.format(25), False),  # it would be full in time, but not again and again
        (60, 20, CALLS.format(60, 40), True),
        (60, 20, CALLS.format(60, 10), True),  # it leaves before it is full
        (60, 30, CALLS.format(25, 10), False),  # and never becomes full
    ],
)
def test_who_wins(lasts: int, charge: int, more: str, won: bool) -> None:
    assert (solved(house(lasts, charge, more)) is not None) == won


@settings(max_examples=12)
@given(st.integers(9, 60), st.integers(1, 30), st.sampled_from([20, 32, 48]), st.booleans())
def test_missions_of_strategies_keep_them_as_the_judge_counts_them(
    lasts: int, charge: int, within: int, calls: bool
) -> None:
    scenario = house(lasts, charge, CALLS.format(40, within) if calls else PATROL.format(within))
    won = solved(scenario)
    if won is None:
        return
    runner = MissionRunner(case_of(scenario, won, Options(), Settings(until=300.0))[0])
    for seed in range(2):
        outcome = runner.run(seed)
        assert outcome.end == SAFE, outcome.reason


Steps = Sequence[Tuple[float, str]]


def problems(steps: Steps, status: str = "") -> List[str]:
    """What the judge says of a mission of a battery that lasts 20 and charges in 10."""
    promises = Promises(house(20, 10, PATROL.format(500)))
    for number, (now, place) in enumerate(steps, 1):
        last = status if number == len(steps) and status else "running"
        state = SystemState(number, now, {"bot": place}, {}, {}, unit=1.0, status=last)
        promises.on_state(state, now)
    return promises.problems


WAY, BACK = "going_dock_to_hall", "going_hall_to_dock"


@pytest.mark.parametrize(
    ("steps", "lost"),
    [
        ([(0, "dock"), (5, WAY), (8, "hall"), (20, BACK), (24.5, "dock")], False),
        ([(0, "dock"), (5, WAY), (8, "hall"), (22, BACK), (25.5, "dock")], True),
        ([(0, "dock"), (5, WAY), (10, "dock"), (21, WAY), (40, "dock")], False),  # full between
        ([(0, "dock"), (5, WAY), (10, "dock"), (19, WAY), (24, "dock")], False),  # broken off
        ([(0, "dock"), (5, WAY), (10, "dock"), (19, WAY), (26, "dock")], True),
        ([(0, "dock"), (5, WAY), (10, "dock"), (90, "dock"), (95, WAY), (114, "dock")], False),
        ([(0, "dock"), (5, WAY), (10, "doing_wipe_in_dock"), (19, "dock"), (21, WAY), (40, "dock")], False),
    ],
)
def test_the_judge_counts_from_the_last_full_charge(steps: Steps, lost: bool) -> None:
    no = ["the mission is lost, but no objective is broken"]
    assert problems(steps, LOST) == ([] if lost else no) and problems(steps) == []


def test_a_lost_scenario_blames_it_and_says_what_would_do() -> None:
    explanation = explain(house(20, 20, PATROL.format(25)), Rules(), Limits(work=20_000_000))
    changes = [change.sentence for change in explanation.changes]
    assert any(change.startswith("a battery of bot that charges in ") for change in changes), changes
    explanation = explain(house(8, 20, PATROL.format(40)), Rules(), Limits(work=20_000_000))
    changes = [change.sentence for change in explanation.changes]
    assert any(change.startswith("a battery of bot that lasts ") for change in changes), changes


def test_what_makes_a_game_large_may_be_it() -> None:
    parts = {part.name: lesser for part, lesser in without_each(house(60, 20, PATROL.format(40)))}
    assert len(parts['battery "bot" lasts 60, charges in 20 at dock'].safety) == 1


def test_its_state_is_said_in_words() -> None:
    scenario = house(60, 20, PATROL.format(40))
    (known,) = (each for each in statuses(scenario, translate(scenario)) if each.of == "obj2")
    assert known.label == 'battery "bot" lasts 60, charges in 20 at dock'
    assert known.texts["atCharger"] == "bot charges at dock"
