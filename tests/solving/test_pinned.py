"""Robots that have to stay near others, and what they then cannot do."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from benchmarks.lab_scenarios import Size, lab_scenario
from pursue_gen.language import parse
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.pinned import lost_to_pins
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate

WORK = (60_000_000, 40_000_000)

LITTLE = Limits(work=20_000_000, states=100_000)

FLOOR = """
poi "west"
poi "hall"
poi "east"
poi "far"
connect west and hall distance 3
connect hall and east distance 3
connect east and far distance 8
event "call"
event "answer" location far duration 2
rule "turn": call before answer
agent "bot1" controllable mobile 2 location west can_do answer
agent "bot2" controllable mobile 2 location east can_do answer
agent "guest" mobile 1 location hall
agent "people" location far can_do call
objective: always not guest at west or any robot at west
objective: always not guest at east or any robot at east
objective: if call then answer within 60
"""
"""The guest may stay in the hall for ever, four time units from west and from east."""

NAMED = FLOOR.replace("or any robot at east", "or bot2 at east")

BUSY = """
poi "desk"
poi "hall"
poi "shelf"
connect desk and hall distance 6
connect hall and shelf distance 6
event "order"
event "fetch" location shelf duration 1
event "ask"
event "tell" location desk duration 1
agent "bot1" controllable mobile 1 location shelf can_do fetch, open
agent "bot2" controllable mobile 1 location desk can_do fetch, tell
event "ring"
event "open" location desk duration 1
agent "people" location desk can_do order, ask
agent "bell" location desk can_do ring
agent "bot3" controllable mobile 1 location hall
objective: if order then fetch within 30
objective: if ask then tell within {}
objective: if ring then open within 30
"""
"""bot1 fetches and opens, which it cannot do together, and whether bot2 can help depends on who asks."""

ON_CALL = """
poi "hall"
poi "room1"
poi "room2"
connect hall and room1 distance 3
connect hall and room2 distance 3
event "ring"
event "open" location room1 duration 4
event "order"
event "drop" location {} duration 2
rule "turn": order before drop
agent "bot1" controllable mobile 1 location hall can_do drop
agent "bot2" controllable mobile 1 location room1 can_do open
agent "guest" location room2 can_do order, ring
objective: if order then drop within 40
objective: bot2 never_with bot1
objective: if ring then open within {}
"""
"""Where somebody rings, and bot2 has no time to come back, it stays in room1."""


def lost(text: str) -> Tuple[Tuple[str, ...], ...]:
    """The promises of each part that is found to be lost."""
    scenario = parse(text, "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    found = lost_to_pins(network, objective, Rules().reaction, SolveOptions(), WORK)
    return tuple(tuple(name for name, _ in each.bad) for each in found)


WEST, EAST, CALL = "obj", "obj2", "obj3"


@pytest.mark.parametrize(
    "text, expected",
    [
        (FLOOR, ((WEST, EAST, CALL),)),
        (FLOOR.replace("mobile 1", "mobile 9"), ()),
        (FLOOR + 'agent "bot3" controllable mobile 2 location hall can_do answer\n', ()),
        (FLOOR.replace("location far duration 2", "location east duration 2"), ()),
        (NAMED, ((EAST, WEST, CALL),)),
        (FLOOR.replace("within 60", "within 12"), ((WEST, EAST, CALL),)),
        (NAMED.replace("west can_do answer", "west"), ((EAST, CALL),)),
    ],
    ids=["two stay, nobody answers", "slow guest", "a third robot", "one stays where answers are", "a named robot",
         "one stays near who calls", "the only one who answers"],
)  # fmt: skip
def test_who_has_to_stay_near_a_place_does_nothing_elsewhere(text: str, expected: Tuple[Tuple[str, ...], ...]) -> None:
    assert [set(each) for each in lost(text)] == [set(each) for each in expected]


def test_what_is_left_for_one_robot_is_too_much() -> None:
    """bot2 could fetch, if nobody asked: it would be too late for that."""
    assert lost(BUSY.format(12)) == (("obj", "obj2", "obj3"),)
    assert lost(BUSY.format(40)) == ()


@pytest.mark.parametrize(
    "text, expected",
    [
        (ON_CALL.format("room1", 8), (("obj", "obj2", "obj3"),)),
        (ON_CALL.format("room2", 8), ()),
        (ON_CALL.format("room1", 30), ()),
        (ON_CALL.format("room1", 8) + 'agent "bot3" controllable mobile 1 location room1 can_do open\n', ()),
        (ON_CALL.format("room1", 8).replace("never_with bot1", "never_with guest"), ()),
    ],
    ids=["it is there", "elsewhere", "it has time", "another one answers", "kept apart from others"],
)
def test_nobody_begins_what_must_not_be_where_a_robot_has_to_stay(
    text: str, expected: Tuple[Tuple[str, ...], ...]
) -> None:
    assert lost(text) == expected
    scenario = parse(text, "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    with suppress(LimitHit):
        assert solve(network, objective, Rules().reaction, limits=LITTLE).won == (not expected)


LATER = """
poi "room1"
poi "closet"
poi "yard"
poi "shelf"
poi "gate"
poi "bell"
connect room1 and closet distance 20
connect yard and shelf distance 1
connect gate and bell distance 90
event "ring" location bell
event "open" location room1 duration 4
event "order"
event "drop" location shelf duration 2
agent "bot1" controllable mobile 1 location yard can_do drop
agent "bot2" controllable mobile 1 location room1 can_do open
agent "guest" mobile 1 location {} can_do ring
agent "boss" location yard can_do order
objective: if order then drop within 60
objective: always not bot1 at shelf or not bot2 at room1
objective: if ring then open within 40
"""
"""Who goes from room1 to the closet is late for a ring that comes then; who has gone there before it may is not."""


@pytest.mark.parametrize("place, expected", [("bell", (("obj", "obj2", "obj3"),)), ("gate", ())])
def test_who_has_time_to_leave_before_somebody_comes_does_not_stay(
    place: str, expected: Tuple[Tuple[str, ...], ...]
) -> None:
    assert lost(LATER.format(place)) == expected


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10**6), st.integers(8, 40), st.integers(1, 2))
def test_what_is_lost_as_robots_stay_near_others_is_lost(seed: int, deadline: int, people: int) -> None:
    text = lab_scenario(seed, Size(places=3, robots=2, people=people, promises=3))
    scenario = parse(re.sub(r"(within|every) \d+", rf"\1 {deadline}", text), "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    found = lost_to_pins(network, objective, Rules().reaction, SolveOptions(), WORK)
    event(f"found: {bool(found)}")
    for part in found:
        try:
            assert not solve(network, part, Rules().reaction, limits=LITTLE).won
        except LimitHit:
            event("too large")
