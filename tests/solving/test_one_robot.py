"""Promises that only one robot can keep, and that it cannot keep together."""

from __future__ import annotations

from typing import Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.one_robot import lost_for_one
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind, Objective

FLOOR = """
poi "room1"
poi "hall"
poi "room2"
connect room1 and hall distance 3
connect hall and room2 distance 3
agent "bot1" controllable mobile 1 location room1
agent "bot2" controllable mobile 1 location hall
agent "guest" mobile 2 location room2
objective: always not guest at room1 or bot1 at room1
objective: patrol hall every 40 by bot2
objective: patrol room2 every 60 by bot1
"""
"""The guest may stay in room1 for ever, and bot1 with him."""


AVOIDS = FLOOR[: FLOOR.index("objective")] + """
objective: patrol room1 every 40 by bot1
objective: avoid any robot at room1 and guest at room1
objective: bot1 never_with bot2 at hall
"""
"""The guest may stay in room1 for ever, and bot1 has to come there."""


@pytest.mark.parametrize(
    "text, lost",
    [
        (AVOIDS, ("obj", "obj2")),
        (AVOIDS.replace("by bot1", "by any robot"), ()),
        (AVOIDS.replace("any robot at room1 and", "bot2 at room1 and"), ()),
        (FLOOR, ("obj", "obj3")),
        (FLOOR.replace("or bot1 at room1", "or any robot at room1"), ()),
        (FLOOR.replace("patrol room2 every 60 by bot1", "patrol room2 every 60 by any robot"), ()),
    ],
    ids=["all avoid", "another may patrol", "another avoids", "one does both", "another may stay", "another may visit"],
)
def test_two_promises_of_one_robot_that_exclude_each_other(text: str, lost: Tuple[str, ...]) -> None:
    scenario = parse(text, "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    found = lost_for_one(network, objective, Rules().reaction, SolveOptions())
    assert found == ((Objective(Kind.SAFETY, bad=tuple((name, "lose") for name in lost)),) if lost else ())
