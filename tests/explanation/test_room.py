"""Where a place or a way holds too few, the explanation says so, and for how many more there would have to be room."""

from __future__ import annotations

import pytest

from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import parse
from pursue_gen.language.scenario import PlaceHolds, Scenario
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario

TEXT = """\
poi "hall"
poi "a"
poi "b"
connect hall and a distance 1
connect hall and b distance 1
event "w1" location hall duration 9
event "w2" location hall duration 9
agent "bot1" controllable mobile 1 location hall can_do w1
agent "bot2" controllable mobile 1 location a can_do w2
objective: place hall holds {} robot
reach_objective: do w1 and w2 within 18
"""


def test_more_room_is_a_change_that_wins() -> None:
    scenario = parse(TEXT.format(1), "x.pur", "x")
    with pytest.raises(Lost):
        solve_scenario(scenario, DEFAULT)
    (more,) = (each for each in repairs(scenario, DEFAULT) if each.what == "room")
    assert (list(more.values), more.say(2)) == ([2], "room for 2 robots at hall instead of 1 robot")
    changed = more.make(2)
    assert isinstance(changed, Scenario) and isinstance(changed.safety[0], PlaceHolds)
    solve_scenario(changed, DEFAULT)
