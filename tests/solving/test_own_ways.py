"""Ways and places that are for some agents only: a story that is won because of them, and one that is lost."""

from __future__ import annotations

import pytest

from pursue_gen.explanation.explain import explain
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options

VISIT = """\
poi "gate"{gate}
poi "store"
poi "office"
connect gate and store distance 3
connect gate and office distance 2{way}
event "fetch" location store duration 1
agent "bot" controllable mobile 1 location gate can_do fetch
agent "visitor" mobile 1 location office
objective: bot never_with visitor
reach_objective: do fetch within 40
"""
"""A visitor may come to the gate, and further, where the robot is."""

DELIVERY = """\
poi "dock"
poi "lift"
poi "ward"
connect dock and lift distance 2{lift}
connect lift and ward distance 2
connect dock and ward distance 20
event "bring" location ward duration 1
agent "cart" controllable mobile 1 location dock can_do bring
agent "nurse" human controllable mobile 1 location ward
reach_objective: do bring within 15
"""
"""By the lift the cart is in time; by the other way it is not."""


def scenario(text: str) -> Scenario:
    return parse(text, "x.pur", "x")


def solved(text: str) -> Solution:
    return solve_scenario(scenario(text), DEFAULT)


@pytest.mark.parametrize("words", [" except visitor", " for robots", " for bot, visitor except visitor"])
def test_a_place_or_a_way_that_is_not_for_somebody_makes_it_won(words: str) -> None:
    with pytest.raises(Lost):
        solved(VISIT.format(gate="", way=""))
    for text in (VISIT.format(gate=words, way=""), VISIT.format(gate="", way=words)):
        won, story = solved(text), scenario(text)
        stage = stage_of(story, won, Options())
        for seed in range(3):
            ended = SimulatedMission(stage, Settings("mixed", until=80.0), seed, Remaining(won)).run()
            assert (ended.end, ended.problems) == (GOAL, ())


def test_a_way_that_is_not_for_it_makes_it_lost_and_the_explanation_says_so() -> None:
    assert solved(DELIVERY.format(lift="")).network
    assert solved(DELIVERY.format(lift=" for cart")).network
    lost = DELIVERY.format(lift=" for nurse")
    with pytest.raises(Lost):
        solved(lost)
    changes = explain(scenario(lost), DEFAULT, Limits(60.0)).changes
    assert any("the way between dock and lift for all (without for nurse)" in one.sentence for one in changes)
