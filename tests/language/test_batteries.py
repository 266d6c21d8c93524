"""Batteries as a text: what they are read as, at which levels they can be, and what is wrong with them."""

from __future__ import annotations

from typing import List

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.batteries import (
    MOST_LEVELS,
    actions_use,
    full,
    levels,
    levels_in,
    movements_use,
    recharges,
    shown_level,
)
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read
from pursue_gen.language.sentences import speed_words

HOUSE = """\
poi "dock"
poi "hall"
connect dock and hall distance 3
event "charge" location dock duration 8
event "wipe" location hall duration 2 to 4
event "sing" duration 5
event "lift" collaborative together location hall duration 2
event "ring" location hall
agent "bot" controllable mobile 1 location dock can_do charge, wipe, sing, ring
agent "guest" mobile 1 location hall can_do lift
agent "maid" location hall reacts_to lift
travel bot from dock to hall takes 5 to 8
{}
reach_objective: do wipe
"""
BATTERY = "battery bot capacity {} uses {} per unit recharges {} per unit at dock"
FULL = BATTERY.format(24, 2, 4)


def codes(statement: str, text: str = HOUSE) -> List[str]:
    return [finding.code for finding in check_reading(read(text.format(statement), "x.pur", "x"))]


def test_movements_and_actions_use_what_they_take_at_most_but_at_the_dock() -> None:
    scenario = parse(HOUSE.format(FULL), "x.pur", "x")
    (battery,) = scenario.batteries
    assert movements_use(scenario, battery) == {("dock", "hall"): 16, ("hall", "dock"): 8}
    assert actions_use(scenario, battery) == {("wipe", "hall"): 8, ("sing", "hall"): 12}
    assert recharges(scenario, battery) == {("charge", "dock"): 32, ("sing", "dock"): 20}
    assert levels(scenario, battery) == (24, 20, 16, 12, 8, 4, 0)


def test_levels_are_whole_where_numbers_are_not() -> None:
    scenario = parse(HOUSE.format(BATTERY.format(24, 0.5, 1.9)), "x.pur", "x")
    (battery,) = scenario.batteries
    assert movements_use(scenario, battery) == {("dock", "hall"): 4, ("hall", "dock"): 2}
    assert actions_use(scenario, battery) == {("wipe", "hall"): 2, ("sing", "hall"): 3}
    assert recharges(scenario, battery) == {("charge", "dock"): 15, ("sing", "dock"): 9}
    assert "PML014" in codes("battery bot capacity 2.5 uses 1 per unit")


BY_DISTANCE = "battery bot capacity 24 uses 0.5 per metre, 2 per unit recharges 4 per unit at dock"


def test_ways_use_by_their_length_and_nothing_is_rounded() -> None:
    scenario = parse(HOUSE.format(BY_DISTANCE), "x.pur", "x")
    (battery,) = scenario.batteries
    assert (levels_in(scenario, battery), full(scenario, battery)) == (2, 48)
    assert movements_use(scenario, battery) == {("dock", "hall"): 3, ("hall", "dock"): 3}
    assert actions_use(scenario, battery) == {("wipe", "hall"): 16, ("sing", "hall"): 24}
    assert recharges(scenario, battery) == {("charge", "dock"): 64, ("sing", "dock"): 40}
    assert shown_level(scenario, battery, 45) == "22.5" and codes(BY_DISTANCE) == []
    assert battery.text == BY_DISTANCE.replace("bot", '"bot"')
    assert speed_words(scenario.agents[0], scenario).endswith(
        "battery of 24, uses 0.5 per metre on its way, 2 per unit at work, recharges 4 per unit at dock"
    )
    assert codes(BY_DISTANCE.replace("2 per unit", "0 per unit")) == []


@pytest.mark.parametrize(
    ("statement", "code"),
    [
        (BY_DISTANCE.replace("0.5 per", "0 per").replace("2 per", "0 per"), "PML312"),
        (BY_DISTANCE.replace("0.5", "9"), "PML316"),
        (BY_DISTANCE.replace("0.5", "0.001").replace("24", "1000"), "PML315"),
        (BY_DISTANCE.replace("0.5", "0.3"), "PML315"),
        (BY_DISTANCE.replace("metre,", "metre"), "PML010"),
    ],
)
def test_what_is_wrong_with_those_by_distance(statement: str, code: str) -> None:
    assert set(codes(statement)) == {code}


def test_the_name_may_stand_in_quotes_and_the_rest_be_left_out() -> None:
    scenario = parse(HOUSE.format('battery "bot" capacity 8 uses 1 per unit'), "x.pur", "x")
    assert scenario.batteries[0].dock is None and levels(scenario, scenario.batteries[0]) == (8, 4, 2, 0)
    assert speed_words(scenario.agents[0], scenario).endswith("battery of 8, uses 1 per unit")


@pytest.mark.parametrize(
    ("statement", "code"),
    [
        (BATTERY.replace("bot", "guest").format(24, 2, 3), "PML310"),
        (f"{FULL}\n{BATTERY.format(30, 1, 1)}", "PML311"),
        (BATTERY.format(0, 2, 3), "PML312"),
        (BATTERY.format(24, 0, 3), "PML312"),
        (BATTERY.format(24, 2, 0), "PML312"),
        (BATTERY.format(10001, 2, 3), "PML312"),
        (BATTERY.format(1000, 1, 1), "PML315"),
        (BATTERY.format(12, 2, 3), "PML316"),
        (FULL.replace("dock", "cellar"), "PML110"),
        (FULL.replace("bot", "bat"), "PML110"),
    ],
)
def test_what_is_wrong_with_them(statement: str, code: str) -> None:
    assert codes(statement) == [code]


def test_a_robot_that_does_nothing_at_the_dock_never_recharges() -> None:
    assert "PML313" not in codes(FULL, HOUSE.replace("can_do charge, wipe, sing, ring", "can_do sing, wipe, ring"))
    assert "PML313" in codes(FULL, HOUSE.replace("can_do charge, wipe, sing, ring", "can_do wipe, ring"))


def test_a_robot_that_others_keep_busy_has_no_battery() -> None:
    assert codes(FULL, HOUSE.replace("sing, ring", "sing, ring reacts_to lift")) == ["PML314"]


def test_what_is_too_much_says_how_many_states_it_costs() -> None:
    (finding,) = check_reading(read(HOUSE.format(BATTERY.format(1000, 1, 1)), "x.pur", "x"))
    assert "multiplies the states of the game by as many" in finding.message
    assert str(MOST_LEVELS) in finding.hint and "at most: 4, 6, 8" in finding.hint


@pytest.mark.parametrize("name", ["battery", "capacity", "uses", "per", "metre", "unit", "recharges"])
def test_its_words_are_names_as_well(name: str) -> None:
    text = HOUSE.replace("ring", name).replace("dock", "unit" if name != "unit" else "dock")
    assert codes(FULL.replace("dock", "unit" if name != "unit" else "dock"), text) == []


@settings(max_examples=40)
@given(st.integers(1, 60), st.integers(1, 4), st.integers(1, 6))
def test_levels_are_closed_under_what_is_used_and_recharged(capacity: int, uses: int, rate: int) -> None:
    scenario = parse(HOUSE.format(BATTERY.format(capacity, uses, rate)), "x.pur", "x")
    (battery,) = scenario.batteries
    found = set(levels(scenario, battery))
    assert max(found) == capacity and min(found) >= 0
    used = {*movements_use(scenario, battery).values(), *actions_use(scenario, battery).values()}
    assert all(level - use in found for level in found for use in used if use <= level)
    gained = recharges(scenario, battery).values()
    assert all(min(capacity, level + gain) in found for level in found for gain in gained)
