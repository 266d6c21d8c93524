"""Promises that are lost alone, or two of them together: named as they are written, and only where that is true."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Sequence, Tuple

import pytest

from benchmarks.lab_scenarios import Size, lab_scenario
from benchmarks.ordinary_families import errands_beside_a_visitor
from pursue_gen.language import parse
from pursue_gen.outcomes import Lost
from pursue_gen.solving.freer import standing, with_one_walk, without_turns
from pursue_gen.solving.lost_promises import (
    lost_alone,
    lost_promises,
    lost_to_one_walk,
    only_promises,
    promises,
    watched,
)
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.options import DEFAULT
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.shares import won_in_shares
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_runtime.locations import is_movement
from tests.stories import CARE_HOME

NIGHT = CARE_HOME + """event "fall"
agent "nora" controllable mobile 2 location station
agent "otto" controllable mobile 2 location room1
agent "resident1" location room1 can_do ring1
agent "resident3" location room3 can_do ring3
agent "walker" mobile 3 location corridor can_do fall
objective: if ring1 then nora at room1 within {first}
objective: if ring3 then nora at room3 within {second}
objective: if walker at room3 then any robot at corridor within 40
objective: patrol corridor every 80 by any robot
"""

SUPPLY = """poi "store"
poi "hall"
poi "m1"
poi "m2"
connect store and hall distance 10
connect hall and m1 distance 5
connect hall and m2 distance 8
event "empty"
event "load" location store duration 12
event "fill" location m2 duration 4
event "prune" location hall duration 40
event "scrap"
rule "supply": load before fill
agent "cart" controllable mobile 1 location store can_do load, fill
agent "tug" controllable mobile 2 location hall can_do prune, fill
agent "line" location m2 can_do empty
agent "mechanic" mobile 1 location {start} can_do scrap
objective: patrol store every 90 by cart
objective: avoid mechanic at hall and tug doing prune
objective: if scrap then prune within 200
"""

GUARDED = """poi "gate"
poi "hall"
poi "yard"
connect gate and hall distance 3
connect hall and yard distance 3
event "ring"
event "open" location gate
agent "bot" controllable mobile 1 location gate can_do open
agent "aide" controllable mobile 1 location gate
agent "guest" mobile 1 location hall can_do ring
assume: guest leaves hall within 6
assume: guest never at hall
assume: guest never at gate
objective: avoid bot at hall and guest at hall
objective: patrol hall every 30 by bot
objective: if ring then open within 50
"""


def game(text: str) -> Tuple[Network, Objective]:
    scenario = parse(text, "x.pur")
    return played(translate(scenario), Rules()), scenario_objective(scenario)


def lost(text: str) -> Lost:
    with pytest.raises(Lost) as raised:
        promised_of(parse(text, "x.pur"), SolveRequest())
    return raised.value


def named(parts: Sequence[Objective]) -> Tuple[Tuple[str, ...], ...]:
    return tuple(watched(part) for part in parts)


def test_each_promise_that_is_lost_alone_is_named_as_it_is_written_with_its_place() -> None:
    problem = lost(NIGHT.format(first=15, second=30))
    first, second = problem.diagnostics
    assert first.message.startswith(
        '"if ring1 then nora at room1 within 15" (line 16) cannot be promised, even if nothing else is, with ends'
    )
    assert second.message.startswith('"if ring3 then nora at room3 within 30" (line 17) cannot be promised, even')
    assert [(one.code, one.span and one.span.line) for one in problem.diagnostics] == [("SYN021", 16), ("SYN021", 17)]
    assert problem.parts == (("obj",), ("obj2",))
    assert pickle.loads(pickle.dumps(problem)).parts == problem.parts


def test_two_promises_that_exclude_each_other_are_named_with_their_lines() -> None:
    (finding,) = lost(SUPPLY.format(start="m1")).diagnostics
    assert finding.message.startswith(
        '"avoid mechanic at hall and tug doing prune" (line 19) and "if scrap then prune within 200" (line 20) cannot '
        "be promised together, even if nothing else is"
    )
    assert finding.span is not None and finding.span.line == 19


@pytest.mark.parametrize(
    "text",
    [
        NIGHT.format(first=120, second=120),
        SUPPLY.format(start="m1").replace("mobile 1 location m1 can_do scrap", "location m1 can_do scrap"),
        GUARDED,
    ],
)
def test_what_is_won_alone_and_in_pairs_is_not_called_lost(text: str) -> None:
    network, objective = game(text)
    assert lost_alone(network, objective, Rules().reaction, DEFAULT) == ()
    assert lost_promises(network, objective, Rules().reaction, DEFAULT) == ()


def test_who_has_to_leave_in_time_does_not_stand_still() -> None:
    network, _ = game(GUARDED)
    still = standing(network).automaton("guest")
    sources = {edge.source for edge in still.edges if is_movement(edge.target)}
    assert "hall" in sources and "yard" not in sources


STAYS = """
poi "gate"
poi "yard"
poi "hall"
poi "shed"
connect gate and yard distance 2
connect yard and hall distance 2
connect yard and shed distance 2
agent "bot1" controllable mobile 1 location hall
agent "guest" mobile 1 location gate
agent "other" mobile 1 location gate
objective: avoid bot1 at shed and guest at shed
objective: patrol shed every 60 by bot1
"""


def test_a_guest_walks_to_where_he_is_in_the_way_and_stays_there() -> None:
    network, objective = game(STAYS)
    walks = list(with_one_walk(network, watched(objective)))
    moves = [[(e.source, e.target) for e in walk.automaton("guest").edges if is_movement(e.target)] for walk in walks]
    assert moves == [[("gate", "going_gate_to_yard"), ("yard", "going_yard_to_shed")]]
    assert not any(is_movement(e.target) for walk in walks for e in walk.automaton("other").edges)
    assert not solve(walks[0], objective, Rules().reaction).won and not solve(network, objective, Rules().reaction).won


RACE = """
poi "gate"
poi "yard"
poi "hall"
poi "shed"
connect gate and yard distance 2
connect yard and hall distance 2
connect yard and shed distance 2
event "mend" location shed duration 2
agent "bot1" controllable mobile 1 location hall can_do mend
agent "guest" mobile {pace} location gate
objective: avoid bot1 at yard and guest at yard
reach_objective: do mend
"""


@pytest.mark.parametrize(("pace", "too_late"), [(1, True), (5, False)])
def test_a_guest_who_walks_at_once_comes_first_or_not(pace: int, too_late: bool) -> None:
    network, objective = game(RACE.format(pace=pace))
    walk = lost_to_one_walk(network, objective, Rules().reaction, DEFAULT.limits)
    assert (walk is not None) is too_late
    assert solve(network, objective, Rules().reaction).won is not too_late


def test_who_walks_at_once_lingers_nowhere_on_the_way() -> None:
    network, objective = game(errands_beside_a_visitor(6))
    (walk,) = with_one_walk(network, watched(objective), hurried=True)
    stays = [place for place in walk.automaton("visitor").locations if not is_movement(place.name)]
    assert {place.name: bound.bound for place in stays for bound in place.invariant} == {"room1": 2, "hall": 2}
    assert lost_to_one_walk(network, objective, Rules().reaction, DEFAULT.limits) is not None


def test_nobody_is_hurried_out_of_where_time_might_stop() -> None:
    network, objective = game(STAYS)
    guest = network.automaton("guest")
    kept = replace(guest, edges=tuple(replace(e, resets=()) if e.target == "yard" else e for e in guest.edges))
    changed = replace(network, automata=tuple(kept if a is guest else a for a in network.automata))
    (walk,) = with_one_walk(changed, watched(objective), hurried=True)
    places = walk.automaton("guest").locations
    assert [place.name for place in places if place.invariant and not is_movement(place.name)] == ["gate"]


def test_a_milestone_that_cannot_be_reached_is_named_among_others() -> None:
    text = NIGHT.split("objective")[0].replace('event "fall"', 'event "fall"\nevent "sign" location room3').replace(
        "location station", "location station can_do sign"
    )
    text = text.replace("mobile 3 location corridor can_do", "location corridor can_do")
    problem = lost(text + "reach_objective: do sign within 300\nreach_objective: do fall\n")
    (finding,) = problem.diagnostics
    assert finding.message.startswith('"do fall" (line 18) cannot be promised, even if nothing else is, with ends')


def test_nobody_prevents_it_where_all_who_matter_are_controlled() -> None:
    hasty = "objective: patrol room3 every 10 by nora\n"
    walking = "objective: if walker at room3 then any robot at corridor within 40\n"
    for text in (NIGHT.split("agent \"resident1\"")[0] + hasty, NIGHT.split("objective")[0] + hasty + walking):
        (finding,) = lost(text).diagnostics
        assert "nobody controls" not in finding.hint and finding.hint.startswith("give the robots more time")
    (finding, _) = lost(NIGHT.format(first=15, second=30)).diagnostics
    assert "nobody controls" in finding.hint


def test_a_rule_that_only_says_when_robots_may_begin_something_else_is_left_out() -> None:
    network, objective = game(SUPPLY.format(start="m1"))
    wanted = promises(objective)[2]
    part = only_promises(network, objective, wanted)
    assert "supply" not in {each.name for each in without_turns(part, watched(wanted)).automata}


@pytest.mark.parametrize("seed", (0, 3, 6, 9))
def test_promises_of_random_scenarios_that_are_called_lost_are_lost(seed: int) -> None:
    text = lab_scenario(seed, Size(places=4, robots=2, people=1, promises=3))
    for factor in (1, 2, 4):
        network, objective = game("\n".join(shortened(line, factor) for line in text.splitlines()))
        for wanted in lost_promises(network, objective, Rules().reaction, DEFAULT):
            part = only_promises(network, objective, wanted)
            assert not solve(part, wanted, Rules().reaction).won, (seed, factor, watched(wanted))


def shortened(line: str, factor: int) -> str:
    head, within, time = line.partition(" within ")
    return f"{head}{within}{int(time) // factor}" if within and line.startswith("objective") else line


def test_somebody_who_does_nothing_takes_no_shares_away() -> None:
    text = lab_scenario(24)  # its person2 has a clock, and nothing to do
    assert 'agent "person2" location' in text and "can_do" not in text
    network, objective = game(text)
    assert won_in_shares(network, objective, Rules().reaction, DEFAULT) is not None
