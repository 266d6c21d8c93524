"""Promises that only one robot can keep, and that it cannot keep together."""

from __future__ import annotations

import re
from typing import Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from benchmarks.lab_scenarios import Size, lab_scenario
from pursue_gen.language import parse
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.freer import asking_only, punctual, standing, with_one_walk
from pursue_gen.solving.lost_promises import only_promises, promises, watched
from pursue_gen.solving.one_robot import lost_for_one
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind, Objective

LITTLE = Limits(work=3_000_000, states=20_000)

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


DELIVERIES = """
poi "a"
poi "b"
poi "c"
poi "d"
connect a and b distance 4
connect b and c distance 12
connect c and d distance 4
event "order1"
event "order2"
event "drop1" location a duration 1
event "drop2" location d duration 1
agent "bot1" controllable mobile 1 location a can_do drop1, drop2
agent "bot2" controllable mobile 1 location d
agent "people1" location a can_do order1
agent "people2" location d can_do order2
objective: if order1 then drop1 within {}
objective: if order2 then drop2 within 150
"""


@pytest.mark.parametrize("deadline, is_lost", [(40, True), (60, False)])
def test_who_calls_again_and_again_keeps_a_robot_from_what_is_far(deadline: int, is_lost: bool) -> None:
    """If each called once, all would be in time: one way takes some 25 time units."""
    scenario = parse(DELIVERIES.format(deadline), "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    assert bool(lost_for_one(network, objective, Rules().reaction, SolveOptions())) == is_lost


TURNS = """
event "ask"
event "fetch" location b duration 1
rule "turn": ask before fetch
"""
"""Whoever fetches next has to be asked for it: who asks, and the other robot, matter to no delivery."""


def test_what_else_people_ask_for_and_other_robots_do_is_no_matter() -> None:
    more = DELIVERIES.format(40).replace('agent "bot1"', TURNS[1:] + 'agent "bot1"')
    some = more.replace("drop1, drop2\n", "drop1, drop2, fetch\n").replace("order1\nagent", "order1, ask\nagent")
    scenario = parse(some.replace("location d\n", "location d can_do fetch\n", 1), "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    assert lost_for_one(network, objective, Rules().reaction, SolveOptions()) == (objective,)


STAYS = """
poi "store"
poi "room"
connect store and room distance 8
event "order"
event "pick" location store duration 1
event "drop" location room duration 1
rule "goods": pick before drop
agent "bot1" controllable mobile 1 location store can_do pick, drop
agent "bot2" controllable mobile 1 location store
agent "guest" mobile 2 location store
agent "people" location store can_do order
objective: always not guest at room or bot1 at room
objective: if order then drop within 60
"""


def test_who_stays_somewhere_while_another_calls_again() -> None:
    """One order is kept where bot1 has picked before the guest came; for the next one it has to leave him."""
    scenario = parse(STAYS, "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    assert lost_for_one(network, objective, Rules().reaction, SolveOptions()) == (objective,)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10**6), st.integers(10, 60))
def test_what_is_lost_where_nobody_asks_for_anything_else_is_lost(seed: int, deadline: int) -> None:
    text = lab_scenario(seed, Size(places=3, robots=1, people=2, promises=3))
    hurried = re.sub(r"(within|every) \d+", rf"\1 {deadline}", text)
    scenario = parse(hurried, "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    for wanted in promises(objective):
        whole = only_promises(network, objective, wanted)
        quiet = asking_only(whole, watched(wanted))
        try:
            won = [solve(game, wanted, Rules().reaction, limits=LITTLE).won for game in (quiet, whole)]
        except LimitHit:
            event("too large")
            continue
        event(f"changed: {quiet != whole}, quiet, whole: {won}")
        assert won[0] or not won[1]


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10**6), st.integers(10, 60), st.integers(1, 2))
def test_what_a_punctual_environment_wins_is_lost(seed: int, deadline: int, people: int) -> None:
    text = lab_scenario(seed, Size(places=3, robots=1, people=people, promises=2))
    hurried = re.sub(r"(within|every) \d+", rf"\1 {deadline}", text)
    scenario = parse(hurried, "floor.pur", "floor")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    reaction = Rules().reaction
    try:
        fewer = (standing(network), *with_one_walk(network, watched(objective)))
        games = (*(punctual(some, "bot1") for some in fewer), network)
        won = [solve(game, objective, reaction, limits=LITTLE).won for game in games]
    except LimitHit:
        event("too large")
        return
    event(f"punctual, whole: {all(won[:-1])}, {won[-1]}")
    assert all(won) or not won[-1]
