"""Several promises at once: what wins or loses them is tried with more and more work."""

from __future__ import annotations

from typing import Tuple

import pytest

from benchmarks.lab_scenarios import lab_scenario
from benchmarks.ordinary_families import warehouse
from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.attempts import BESIDE_A_GOAL, decided_by_attempts
from pursue_gen.solving.efforts import EFFORTS
from pursue_gen.solving.found import Found
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.policies import won_by_policy
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.shares import Known, won_in_shares
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from tests.solving.test_one_robot import AVOIDS, FLOOR
from tests.synthesis.test_guess import HUB

REACTION = Rules().reaction
TWO_PATROLS = FLOOR[: FLOOR.index("objective")] + """
objective: patrol room1 every 40 by bot1
objective: patrol room2 every 60 by bot2
"""
BOTH_AT_ONE_PLACE = FLOOR[: FLOOR.index("objective")] + """
objective: patrol room1 every 40 by bot1
objective: patrol room1 every 40 by bot2
objective: bot1 never_with bot2 at room1
"""


def game(text: str) -> Tuple[Network, Objective]:
    scenario = parse(text, "floor.pur", "floor")
    return played(translate(scenario), Rules()), scenario_objective(scenario)


def test_what_is_won_is_proven() -> None:
    network, objective = game(TWO_PATROLS)
    found = decided_by_attempts(network, objective, REACTION, SolveOptions())
    assert isinstance(found, Found)
    assert verify(network, objective, found.strategy, REACTION).ok


@pytest.mark.parametrize("text, parts", [(AVOIDS, ("obj", "obj2")), (FLOOR, ("obj", "obj3"))])
def test_what_is_lost_is_named(text: str, parts: Tuple[str, ...]) -> None:
    found = decided_by_attempts(*game(text), REACTION, SolveOptions())
    assert isinstance(found, tuple)
    assert [tuple(name for name, _ in part.bad) for part in found] == [parts]


def test_one_robot_keeps_a_single_promise_that_several_can() -> None:
    """The whole game has three robots, and rules that name what other robots do."""
    before, *_ = lab_scenario(112).partition("objective")
    network, objective = game(before + "objective: if order1 then drop1 within 133\n")
    found = decided_by_attempts(network, objective, REACTION, SolveOptions())
    assert isinstance(found, Found)
    assert len(found.strategy.shares) == 1
    assert verify(network, objective, found.strategy, REACTION).ok


def test_games_that_less_effort_decided_are_not_played_again() -> None:
    network, objective = game(TWO_PATROLS)
    known = Known()
    first = won_in_shares(network, objective, REACTION, SolveOptions(), EFFORTS[1:2], known)
    won, lost = dict(known.won), set(known.lost)
    second = won_in_shares(network, objective, REACTION, SolveOptions(), EFFORTS[2:3], known)
    assert first is not None and second is not None
    assert second.strategy == first.strategy
    assert (known.won, known.lost) == (won, lost), "and nothing new had to be looked at"
    assert second.stats == first.stats


def test_groups_that_stand_in_each_others_way_are_joined_with_more_effort() -> None:
    network, objective = game(BOTH_AT_ONE_PLACE)
    assert won_in_shares(network, objective, REACTION, SolveOptions(), EFFORTS[1:2]) is None
    found = won_in_shares(network, objective, REACTION, SolveOptions(), EFFORTS[2:3])
    assert found is not None and len(found.strategy.shares) == 1


def test_a_post_is_two_robots_task_until_the_one_that_stays_is_there() -> None:
    """bot1, which alone can drop what is ordered, sees to hall3 until bot3 is there; bot2 is on patrol."""
    found = won_in_shares(
        *game(lab_scenario(68)), REACTION, SolveOptions(), [each for each in EFFORTS if each.pairs]
    )
    assert found is not None and len(found.strategy.shares) == 2
    commands = (command.moves[0] for block in found.strategy.blocks for command in block.commands)
    assert {"bot1", "bot3"} <= {move.automaton for move in commands}


def test_fewer_robots_than_promises_keep_what_all_can() -> None:
    network, objective = game(warehouse(3))
    found = won_in_shares(network, objective, REACTION, SolveOptions(), EFFORTS[:1])
    assert found is not None
    assert verify(network, objective, found.strategy, REACTION, closed=True).ok
    commands = (command for block in found.strategy.blocks for command in block.commands)
    assert {command.moves[0].automaton for command in commands} == {"bot1", "bot2"}


def test_all_robots_keep_all_promises_by_taking_turns() -> None:
    found = won_in_shares(*game(WITH_A_WALKER), REACTION, SolveOptions(), [each for each in EFFORTS if each.turns])
    assert found is not None and len(found.strategy.shares) == 1
    assert verify(*game(WITH_A_WALKER), found.strategy, REACTION).ok


def test_robots_that_never_meet_win_without_a_right_of_way() -> None:
    found = decided_by_attempts(*game(lab_scenario(26)), REACTION, SolveOptions())
    assert isinstance(found, Found)


WITH_A_WALKER = HUB.replace('"nurse" location', '"nurse" mobile 1 location')
"""The nurse, who walks, is hidden from the robots' game."""


CORRIDOR = """
poi "hall1"
poi "hall2"
connect hall1 and hall2 distance 3
event "call1"
event "call2"
event "serve1" location hall1 duration 1
event "serve2" location hall2 duration 1
agent "bot1" controllable mobile 1 location hall2 can_do serve1, serve2
agent "bot2" controllable mobile 1 location hall1 can_do serve1, serve2
agent "people" location hall1 can_do call1, call2
objective: if call1 then serve1 within 40
objective: if call2 then serve2 within 40
"""


def test_the_nearest_robot_keeps_a_promise_that_each_can() -> None:
    found = won_in_shares(*game(CORRIDOR), REACTION, SolveOptions(), EFFORTS[1:2])
    assert found is not None
    moves = (command.moves[0] for block in found.strategy.blocks for command in block.commands)
    assert {(move.automaton, move.edge.target) for move in moves} == {
        ("bot1", "doing_serve2_in_hall2"),
        ("bot2", "doing_serve1_in_hall1"),
    }


ROUNDS = """
poi "hall1"
poi "hall2"
poi "hall3"
connect hall1 and hall2 distance 3
connect hall2 and hall3 distance 3
event "call1"
event "call2"
event "serve1" location hall3 duration 1
event "serve2" location hall3 duration 2
agent "bot1" controllable mobile 1 location hall1
agent "bot2" controllable mobile 1 location hall3 can_do serve1, serve2
agent "people" location hall1 can_do call1, call2
objective: patrol hall1, hall2 every 40 by any robot
objective: if call1 then serve1 within 40
objective: if call2 then serve2 within 40
"""


def test_who_sees_to_one_place_of_a_patrol_stays_there_and_another_robot_sees_to_the_next() -> None:
    found = won_in_shares(*game(ROUNDS), REACTION, SolveOptions(), EFFORTS[1:2])
    assert found is not None
    commands = (command for block in found.strategy.blocks for command in block.commands)
    assert {command.moves[0].automaton for command in commands} == {"bot2"}


YARD = """
poi "press"
poi "yard"
poi "gate"
poi "bin1"
poi "bin2"
connect press and yard distance 3
connect yard and gate distance 4
connect yard and bin1 distance 3
connect yard and bin2 distance 5
event "full1"
event "full2"
event "lift1" location bin1
event "tip1" location press
event "lift2" location bin2
event "tip2" location press
event "lorry"
event "opens" location gate
rule "one": lift1 before tip1
rule "two": lift2 before tip2
agent "bot" controllable mobile 1 location yard can_do lift1, tip1, lift2, tip2, opens
agent "bins" location bin1 can_do full1, full2
agent "driver" location gate can_do lorry
objective: if full1 then tip1 within 100
objective: if full2 then tip2 within 100
objective: if lorry then opens within 44
"""
"""Two bins, either of which may take a robot as long as the gate leaves it."""


def test_what_has_a_short_limit_is_done_between_what_has_long_ones() -> None:
    network, objective = game(YARD)
    found = won_by_policy(network, objective, REACTION, 5_000_000, SolveOptions())
    assert found is not None
    assert verify(network, objective, found.strategy, REACTION).ok


SCHOOL = """
unit 1 s
poi "gate"
poi "yard"
poi "room1"
poi "room2"
poi "gym"
poi "store"
connect gate and yard distance 10
connect yard and room1 distance 14
connect yard and room2 distance 14
connect yard and gym distance 30
connect yard and store distance 8
event "ring" location gate
event "open" location gate duration 10
event "mop1" location room1 duration 5 min
event "mop2" location room2 duration 5 min
event "mop3" location gym duration 10 min
agent "guard" mobile 1 location yard
agent "visitor" location gate can_do ring
agent "porter" controllable mobile 1 location gate can_do open
agent "mopper" controllable mobile 1 location store can_do mop1, mop2, mop3
assume: guard leaves yard within 30
assume: visitor waits 3 min between ring
objective: if ring then open within 1 min
objective: patrol store every 20 min by any robot
objective: avoid mopper doing mop3 and guard at gym
reach_objective: do mop1
reach_objective: do mop2 within 30 min
reach_objective: do mop3
"""


def test_who_comes_to_the_goal_leaves_promises_to_others() -> None:
    """A porter answers the gate for the twenty minutes that the rooms take: too many plays for one game."""
    network, objective = game(f"{SCHOOL}assume: guard never at gym")
    found = decided_by_attempts(network, objective, REACTION, SolveOptions(), BESIDE_A_GOAL)
    assert isinstance(found, Found)
    shares = [(found.strategy.commanded_by(k), dict(places)) for k, places in enumerate(found.strategy.shares)]
    assert any("mopper" in who and {"reachObj", "reachObj2", "reachObj3"} <= kept.keys() for who, kept in shares)
    assert any(who == {"porter"} and {"obj", "obj2"} <= kept.keys() for who, kept in shares)
    assert verify(network, objective, found.strategy, REACTION).ok


def test_a_goal_that_a_promise_excludes_is_named_with_it() -> None:
    network, objective = game(SCHOOL)  # the guard may come to the gym while it is mopped
    found = decided_by_attempts(network, objective, REACTION, SolveOptions(), BESIDE_A_GOAL)
    assert isinstance(found, tuple)
    assert [(part.goal, part.bad) for part in found] == [((("reachObj3", "win"),), (("obj3", "lose"),))]
