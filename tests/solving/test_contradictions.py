"""Two promises that exclude each other where somebody stays."""

from __future__ import annotations

from itertools import combinations
from typing import Tuple

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.outcomes import Lost
from pursue_gen.solving.contradictions import excluded_by_a_stay
from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.solving.stays import LostToAStay
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective

FLOOR = """
poi "hall"
poi "room1"
poi "room2"
connect hall and room1 distance 2
connect hall and room2 distance 2
agent "bot1" controllable mobile 1 location room2
agent "bot2" controllable mobile 1 location hall
agent "guest" mobile 2 location hall
"""

AVOID, NEAR = "avoid any robot at room1 and guest at room1", "if guest at room1 then any robot at room1 within 30"
ALWAYS, PATROL = "always not guest at room1 or any robot at room1", "patrol room1 every 40 by any robot"
FORMS = [form.replace("any robot", who) for form in (AVOID, NEAR, ALWAYS, PATROL) for who in ("any robot", "bot1")]
FORMS += ["patrol hall every 40 by bot1", "bot1 never_with bot2 at room1"]


def game(*objectives: str, floor: str = FLOOR) -> Tuple[Network, Objective]:
    text = floor + "".join(f"objective: {objective}\n" for objective in objectives)
    scenario = parse(text, "floor.pur", "floor")
    return played(translate(scenario), DEFAULT), scenario_objective(scenario)


@pytest.mark.parametrize("other", [NEAR, ALWAYS])
def test_a_guest_who_stays_excludes_them(other: str) -> None:
    network, objective = game(AVOID, other)
    assert excluded_by_a_stay(network, objective) == LostToAStay(objective, "guest", "room1")
    many = FLOOR + "".join(f'agent "more{k}" controllable mobile 1 location hall\n' for k in range(4))
    network, objective = game(other, "patrol room2 every 90 by any robot", AVOID, floor=many)
    found = excluded_by_a_stay(network, objective)
    assert found is not None and [name for name, _ in found.promises.bad] == ["obj", "obj3"]


@pytest.mark.parametrize(
    "one, two",
    [
        pytest.param(AVOID.replace("any robot", "bot1"), NEAR, id="the other robot may be there"),
        pytest.param(AVOID.replace("room1", "room2"), NEAR, id="another room"),
        pytest.param(NEAR, ALWAYS, id="both want a robot there"),
        pytest.param(NEAR, PATROL, id="a robot may stay there"),
    ],
)
def test_what_a_robot_may_keep_is_not_excluded(one: str, two: str) -> None:
    assert excluded_by_a_stay(*game(one, two)) is None


def test_who_cannot_come_or_has_to_leave_excludes_nothing() -> None:
    apart = FLOOR.replace('"guest" mobile 2 location hall', '"guest" location hall')
    assert excluded_by_a_stay(*game(AVOID, NEAR, floor=apart)) is None
    for assumed in ("guest leaves room1 within 20", "guest never at room1"):
        assert excluded_by_a_stay(*game(AVOID, NEAR, floor=f"{FLOOR}assume: {assumed}\n")) is None


@pytest.mark.parametrize("one, two", list(combinations(FORMS, 2)))
def test_what_is_excluded_is_lost_in_the_exact_game(one: str, two: str) -> None:
    network, objective = game(one, two)
    if excluded_by_a_stay(network, objective):
        assert not solve(network, objective, DEFAULT.reaction).won


def test_the_two_statements_are_named() -> None:
    text = FLOOR + f"objective: {AVOID}\nobjective: patrol room2 every 90 by any robot\nobjective: {ALWAYS}\n"
    with pytest.raises(PursueError) as problem:
        solve_scenario(parse(text, "floor.pur", "floor"), DEFAULT)
    assert isinstance(problem.value, Lost)
    assert problem.value.parts == (("obj", "obj3"),)


EVENTS = """event "call"
event "serve" location room1 duration 1
event "look" location room2 duration 1
"""
CALLED = FLOOR.replace("location room2\n", "location room2 can_do serve, look\n").replace("agent", f"{EVENTS}agent", 1)
SERVE = "if call then serve within 60"


def called(who: str) -> str:
    """The floor on which this agent may call."""
    if who == "guest":
        return CALLED.replace("2 location hall\n", "2 location hall can_do call\n")
    return CALLED + f'agent "{who}" location hall can_do call\n'


@pytest.mark.parametrize("who", ["people", "guest"])
def test_what_is_to_be_done_where_no_robot_may_be_is_excluded(who: str) -> None:
    network, objective = game(AVOID, SERVE, floor=called(who))
    assert excluded_by_a_stay(network, objective) == LostToAStay(objective, "guest", "room1")
    assert excluded_by_a_stay(*game(AVOID, SERVE.replace("serve", "look"), floor=called(who))) is None
    assert excluded_by_a_stay(*game(AVOID, SERVE, floor=CALLED + 'agent "people" location hall\n')) is None


@pytest.mark.parametrize("assumed", ["people does call at_most 1 times", "guest leaves room1 within 20"])
def test_who_may_not_call_then_or_has_to_leave_excludes_nothing(assumed: str) -> None:
    floor = f"{called('people')}assume: {assumed}\n"
    assert excluded_by_a_stay(*game(AVOID, SERVE, floor=floor)) is None


@pytest.mark.parametrize("who", ["people", "guest"])
@pytest.mark.parametrize("serve", ["serve", "look"])
@pytest.mark.parametrize("other", [AVOID, NEAR, ALWAYS, PATROL])
def test_what_is_excluded_by_a_call_is_lost_in_the_exact_game(who: str, serve: str, other: str) -> None:
    alone = called(who).replace('agent "bot2" controllable mobile 1 location hall\n', "")
    network, objective = game(SERVE.replace("serve", serve), other, floor=alone)
    if excluded_by_a_stay(network, objective):
        assert not solve(network, objective, DEFAULT.reaction).won
