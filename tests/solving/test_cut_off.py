"""Robots that somebody who stays cuts off from what they are asked for."""

from __future__ import annotations

from typing import Sequence, Tuple

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.cut_off import cut_off_by_a_stay
from pursue_gen.solving.rules import DEFAULT, IDEAL, Rules, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.solving.stays import LostToAStay
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import NATIVE, solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective

CLINIC = """
poi "store"
poi "lift"
poi "ward"
poi "office"
connect store and lift distance 2
connect lift and ward distance 2
connect lift and office distance 2
event "ask"
event "pick" location store duration 1
event "hand" location ward duration 1
rule "medicine": pick before hand
agent "r1" controllable mobile 1 location store can_do pick, hand
agent "doctor" location ward can_do ask
agent "bed" mobile 1 location office
objective: if ask then hand within 90
objective: r1 never_with bed at lift
"""
"""The only way from the store to the ward leads past the lift, where the bed may stay."""

OFFICE = 'event "call"\nevent "copy" location store duration 1\nevent "file" location office duration 1\n'
"""A second errand, from the store to the office, which the lift cuts off as well."""


def game(text: str, rules: Rules = DEFAULT) -> Tuple[Network, Objective]:
    scenario = parse(text, "clinic.pur", "clinic")
    return played(translate(scenario), rules), scenario_objective(scenario)


def two_robots(text: str) -> str:
    robot = text[text.index('agent "r1"') : text.index('agent "doctor"')]
    return text.replace(robot, robot + robot.replace("r1", "r2")) + "objective: r2 never_with bed at lift\n"


def test_a_robot_that_has_to_pass_where_somebody_stays_is_cut_off() -> None:
    network, objective = game(CLINIC)
    assert cut_off_by_a_stay(network, objective) == LostToAStay(objective, "bed", "lift")
    assert not solve(network, objective, DEFAULT.reaction).won


def test_two_robots_hand_on_what_one_of_them_cannot_bring() -> None:
    """One picks and the other one hands it out: where both need the ward and the office, one of them is missing."""
    assert cut_off_by_a_stay(*game(two_robots(CLINIC))) is None
    more = CLINIC.replace('rule "medicine"', OFFICE + 'rule "paper": copy before file\nrule "medicine"')
    more = more.replace("can_do pick, hand", "can_do pick, hand, copy, file").replace("can_do ask", "can_do ask, call")
    network, objective = game(two_robots(more + "objective: if call then file within 90\n"))
    assert cut_off_by_a_stay(network, objective) == LostToAStay(objective, "bed", "lift")


def test_only_what_is_lost_to_it_is_named() -> None:
    network, objective = game(CLINIC + "objective: avoid r1 at office\nobjective: patrol store every 60 by r1\n")
    found = cut_off_by_a_stay(network, objective)
    assert found is not None and [name for name, _ in found.promises.bad] == ["obj", "obj2"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("connect lift and office", "connect store and ward distance 40\nconnect lift and office",
                     id="another way"),
        pytest.param("mobile 1 location office", "location office", id="the bed does not move"),
        pytest.param('"bed" mobile 1 location office',
                     '"bed" mobile 9 location office\nassume: bed leaves lift within 20', id="it leaves in time"),
        pytest.param("can_do ask", "can_do ask\nassume: doctor does ask at_most 1 times", id="one call"),
        pytest.param('rule "medicine": pick before hand', "", id="nothing has to come before"),
        pytest.param("never_with bed at lift", "never_with bed at office", id="elsewhere"),
    ],
)  # fmt: skip
def test_what_may_be_kept_is_not_cut_off(old: str, new: str) -> None:
    assert old in CLINIC
    assert cut_off_by_a_stay(*game(CLINIC.replace(old, new))) is None


def test_who_may_come_before_a_robot_is_gone_cuts_it_off_too() -> None:
    """A robot takes 3 to the lift at most and stays for 1; the bed needs more than 2 or 3 from the office."""
    leaves = CLINIC + "assume: bed leaves lift within 20\nassume: bed never at store\nassume: bed never at ward\n"
    for distance, lost in ((2, True), (3, True), (5, False)):
        network, objective = game(leaves.replace("lift and office distance 2", f"lift and office distance {distance}"))
        found = cut_off_by_a_stay(network, objective)
        assert found == (LostToAStay(objective, "bed", "office", comes=True) if lost else None)
        assert solve(network, objective, DEFAULT.reaction).won == (not lost)


def test_who_asks_for_something_rests_before_it_comes() -> None:
    """The bed sets off 1 after it has asked, at the soonest: a robot may be gone then."""
    leaves = CLINIC + "assume: bed leaves lift within 20\nassume: bed never at store\nassume: bed never at ward\n"
    asks = leaves.replace("location ward can_do ask", "location ward")
    asks = asks.replace("mobile 1 location office", "mobile 1 location office can_do ask")
    for distance, cut in ((2, True), (3, False)):
        network, objective = game(asks.replace("lift and office distance 2", f"lift and office distance {distance}"))
        assert (cut_off_by_a_stay(network, objective) is not None) == cut
        assert not (cut and solve(network, objective, DEFAULT.reaction).won)


def test_whom_a_robot_can_keep_busy_may_not_come_in_time() -> None:
    leaves = CLINIC + "assume: bed leaves lift within 20\nassume: bed never at store\nassume: bed never at ward\n"
    wash = 'event "wash" collaborative together duration 3\n'
    keeps = leaves.replace('event "ask"', f'{wash}event "ask"').replace("pick, hand", "pick, hand, wash")
    keeps = keeps.replace("mobile 1 location office", "mobile 1 location office reacts_to wash")
    assert cut_off_by_a_stay(*game(leaves)) is not None
    assert cut_off_by_a_stay(*game(keeps)) is None


def test_the_message_says_who_stays_where() -> None:
    with pytest.raises(Lost) as problem:
        solve_scenario(parse(CLINIC + "objective: avoid r1 at office\n", "clinic.pur", "clinic"), DEFAULT)
    assert "bed may stay at lift for ever" in problem.value.diagnostics[0].hint


WATCH = """
poi "dock"
poi "aisle"
poi "rack"
connect dock and aisle distance 1
connect aisle and rack distance 1
agent "ada" controllable mobile 2 location dock
agent "bob" controllable mobile 2 location dock
agent "tech" mobile {pace} location dock
objective: patrol rack every 20 by any robot
objective: avoid any robot at rack and tech at rack
assume: tech leaves rack within {stay}
"""
"""Whoever stands at the rack has to leave it when the technician comes."""


@pytest.mark.parametrize(
    ("pace", "stay", "cut"),
    [
        (1, 8, True),
        (1, 1, False),  # a robot may set off before he has to leave
        (2, 8, False),  # and is gone before he is back
    ],
)
def test_who_has_driven_robots_out_may_keep_them_from_a_place_that_is_patrolled(
    pace: int, stay: int, cut: bool
) -> None:
    network, objective = game(WATCH.format(pace=pace, stay=stay))
    found = cut_off_by_a_stay(network, objective)
    assert found == (LostToAStay(objective, "tech", "aisle", comes=True) if cut else None)
    assert not (cut and solve(network, objective, DEFAULT.reaction).won)
    if cut:
        with pytest.raises(Lost) as problem:
            solve_scenario(parse(WATCH.format(pace=pace, stay=stay), "watch.pur", "watch"), DEFAULT)
        assert "tech may wait at aisle for ever" in problem.value.diagnostics[0].hint


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.integers(1, 4), min_size=2, max_size=3),
    st.tuples(st.integers(1, 2), st.integers(1, 3), st.integers(4, 30), st.integers(20, 90)),
    st.tuples(st.sampled_from(["a", "b", "c"]), st.sampled_from(["a", "b", "c"]), st.sampled_from(["a", "b", "c"])),
    st.sampled_from(("r", "any robot")),
    st.sampled_from((DEFAULT, IDEAL)),
)
def test_a_patrol_that_is_cut_off_is_lost_in_the_exact_game(
    ways: Sequence[int], times: Tuple[int, int, int, int], places: Tuple[str, str, str], who: str, rules: Rules
) -> None:
    pace, slow, stay, every = times
    start, at, met = places
    ends = [("a", "b"), ("b", "c"), ("a", "c")]
    roads = "".join(f"connect {a} and {b} distance {far}\n" for (a, b), far in zip(ends, ways))
    network, objective = game(
        f'poi "a" poi "b" poi "c"\n{roads}agent "r" controllable mobile {pace} location {start}\n'
        f'agent "v" mobile {slow} location {at}\nobjective: avoid {who} at {met} and v at {met}\n'
        f"objective: patrol {met} every {every} by {who}\nassume: v leaves {met} within {stay}\n",
        rules,
    )
    cut = cut_off_by_a_stay(network, objective) is not None
    event("cut off" if cut else "not cut off")
    try:
        assert not (cut and solve(network, objective, rules.reaction, NATIVE, Limits(work=20_000_000)).won)
    except LimitHit:
        return


PLACES = ("store", "lift", "ward", "office")


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.sampled_from([(a, b) for a in PLACES for b in PLACES if a < b]), min_size=2, max_size=5, unique=True),
    st.sampled_from(PLACES),
    st.sampled_from(PLACES),
    st.sampled_from(PLACES),
    st.booleans(),
    st.sampled_from((DEFAULT, IDEAL)),
    st.booleans(),
)
def test_what_is_cut_off_is_lost_in_the_exact_game(
    ways: Sequence[Tuple[str, str]], picked: str, handed: str, met: str, rule: bool, rules: Rules, asks: bool
) -> None:
    roads = "".join(f"connect {a} and {b} distance 2\n" for a, b in ways)
    text = "".join(line for line in CLINIC.splitlines(keepends=True) if not line.startswith("connect"))
    text = text.replace('event "ask"', f'{roads}event "ask"').replace("bed at lift", f"bed at {met}")
    text = text.replace("location store duration", f"location {picked} duration")
    text = text.replace("location ward duration", f"location {handed} duration")
    text = text if rule else text.replace('rule "medicine": pick before hand', "")
    if asks:
        text = text.replace("location ward can_do ask", "location ward")
        text = text.replace("mobile 1 location office", "mobile 1 location office can_do ask")
    network, objective = game(text.replace("within 90", "within 40"), rules)
    try:
        won = solve(network, objective, rules.reaction, NATIVE, Limits(work=20_000_000)).won
    except LimitHit:
        return
    cut = cut_off_by_a_stay(network, objective) is not None
    event(f"{'cut off' if cut else 'not cut off'}, {'won' if won else 'lost'}")
    assert not (cut and won)
