"""Where a robot carries too little, or has to change its tool too often, the explanation says what would do."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.explanation.number_changes import Repair
from pursue_gen.explanation.part import part_of_scenario
from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario

SHOP = """\
poi "store"
poi "shop"
connect store and shop distance 10
thing "box"
thing "brush"
event "load" location store duration 1 takes box
event "unload" location shop gives box
event "change" location store duration 4 mounts brush
event "sweep" location shop needs brush
agent "cart" controllable mobile 1 location store can_do load, unload, change, sweep
agent "boy" mobile 1{} location store can_do load, unload
{}
"""


def scenario(carries: str, objective: str) -> Scenario:
    return parse(SHOP.format(carries, objective), "x.pur", "x")


def lost(story: Scenario, what: str) -> List[Repair]:
    with pytest.raises(Lost):
        solve_scenario(story, DEFAULT)
    return [each for each in repairs(story, DEFAULT) if each.what == what]


def test_more_room_is_a_change_that_wins() -> None:
    story = scenario("", "reach_objective: do load and unload within 30\nobjective: avoid boy at shop")
    assert [each.name for each in repairs(story, DEFAULT) if each.what == "room"] == ["cart"]
    (more,) = lost(scenario("", "reach_objective: do unload twice within 24\nassume: boy never at shop"), "room")
    assert (list(more.values), more.say(2)) == ([2, 3], "cart carries 2 instead of 1")
    changed = more.make(2)
    assert isinstance(changed, Scenario)
    solve_scenario(changed, DEFAULT)


def test_who_is_not_controlled_would_have_to_carry_less() -> None:
    story = scenario(" carries 3", "reach_objective: do sweep")
    found = {each.name: list(each.values) for each in repairs(story, DEFAULT) if each.what == "room"}
    assert found == {"cart": [2, 3], "boy": [2, 1]}


def test_a_tool_that_is_needed_may_be_left_out() -> None:
    (without,) = lost(scenario("", "reach_objective: do sweep within 16"), "condition")
    assert without.label == "sweep without needs brush"
    changed = without.make("")
    assert isinstance(changed, Scenario)
    solve_scenario(changed, DEFAULT)


def test_events_that_move_things_are_no_pastime() -> None:
    story = scenario("", "reach_objective: do sweep")
    assert {"change", "sweep"} <= {event.name for event in part_of_scenario(story, story.objectives, DEFAULT).events}
