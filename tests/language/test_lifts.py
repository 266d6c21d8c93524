"""Lifts: how long rides take, how many robots ride at once, who calls them, what is wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.lifts import driven, rides_of
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import LiftHolds, Scenario
from pursue_gen.language.writer import scenario_text, written
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario

LIFT = 'lift "lift1" at hall0, hall1, hall2 comes within 40 takes 10 to 20'


def hotel(lift: str = LIFT, by: str = " by lift1", more: str = "", within: int = 150) -> str:
    return f"""\
poi "hall0"
poi "hall1"
poi "hall2"
{lift}
connect hall0 and hall1 distance 4{by}
connect hall0 and hall2 distance 4{by}
event "fetch" location hall1
event "bring" location hall0
agent "bot1" controllable mobile 1 location hall0 can_do fetch
agent "bot2" controllable mobile 1 location hall2 can_do bring
agent "guest" mobile 2 location hall0
{more}
reach_objective: do fetch and bring within {within}
"""


def scenario(text: str) -> Scenario:
    return parse(text, "hotel.pur", "hotel")


def found(text: str) -> List[Tuple[str, str]]:
    return [(finding.code, finding.message) for finding in check_reading(read(text, "hotel.pur"))]


def held(text: str) -> List[Tuple[int, int]]:
    """Of each objective on what a lift holds, how many, and on how many ways."""
    return [(each.most, len(each.building)) for each in scenario(text).safety if isinstance(each, LiftHolds)]


@given(st.integers(1, 90), st.integers(0, 30), st.integers(1, 30))
def test_a_ride_takes_what_is_driven_and_what_the_lift_takes(comes: int, low: int, more: int) -> None:
    lift = f'lift "lift1" at hall0, hall1, hall2 comes within {comes} takes {low} to {low + more}'
    made = scenario(hotel(lift))
    assert made.movements(made.agents[0])["hall0", "hall1"] == (4 + low, 5 + comes + low + more)
    assert made.movements(made.agents[2])["hall1", "hall0"] == (8 + low, 9 + comes + low + more), "people wait, too"


def test_a_time_of_its_own_is_that_without_the_lift() -> None:
    made = scenario(hotel(more="travel bot1 from hall0 to hall1 takes 2 to 3"))
    assert made.movements(made.agents[0])["hall0", "hall1"] == (12, 63)


def test_rides_are_not_measured_as_ways_are() -> None:
    made = scenario(hotel(by="").replace("hall2 distance 4", "hall2 distance 4 by lift1"))
    assert set(driven(made, made.agents[0])) == {("hall0", "hall1"), ("hall1", "hall0")}
    assert driven(scenario(hotel()), made.agents[2]) == {}


def test_robots_call_it_and_people_do_so_themselves() -> None:
    made = scenario(hotel())
    ways = {("hall0", "hall1"), ("hall1", "hall0"), ("hall0", "hall2"), ("hall2", "hall0")}
    assert rides_of(made, made.agents[0]) == {way: made.lifts[0] for way in ways}
    assert rides_of(made, made.agents[2]) == {} == rides_of(scenario(hotel(by="")), made.agents[0])


def test_it_holds_one_robot_on_all_its_ways_unless_the_scenario_says_more() -> None:
    assert held(hotel()) == [(1, 2)]
    assert held(hotel(more="objective: lift lift1 holds 2 robots")) == [(2, 2)]
    assert held(hotel(by="")) == []
    assert held(hotel().replace('agent "bot2" controllable', 'agent "bot2"')) == [], "one robot shares it with none"


@pytest.mark.parametrize(("within", "more", "wins"), [(140, "", True), (130, "", False)])
def test_robots_ride_one_after_the_other(within: int, more: str, wins: bool) -> None:
    made = scenario(hotel(within=within, more=more))
    if wins:
        assert solve_scenario(made, DEFAULT).strategy is not None
    else:
        with pytest.raises(Lost):
            solve_scenario(made, DEFAULT)


def test_two_that_ride_at_once_take_as_long_as_one() -> None:
    more = "objective: lift lift1 holds 3 agents"
    assert solve_scenario(scenario(hotel(within=75, more=more)), DEFAULT).strategy is not None


def test_what_it_holds_is_in_a_scenario_that_is_built_in_python_too() -> None:
    made = scenario(hotel())
    built = replace(made, safety=(), text="")
    assert "objective: lift lift1 holds 1 robot" in scenario_text(built)
    assert written(made) is made and len(written(built).safety) == 1


def test_changes_are_tried_that_would_do() -> None:
    tried = {each.what: each for each in repairs(scenario(hotel()), DEFAULT)}
    assert tried["lift"].say(30) == "lift1 coming within 30 instead of 40"
    changed = tried["lift"].make(30)
    assert isinstance(changed, Scenario) and changed.lifts[0].comes_within == 30
    assert tried["room"].say(2) == "room for 2 robots in lift1 instead of 1 robot"


POSED = hotel().replace('poi "hall0"', 'poi "hall0" //[0, 0, 0, 0, 0, 0, 1]')
POSED = POSED.replace('poi "hall1"', 'poi "hall1" //[0, 0, 4, 0, 0, 0, 1]')
POSED = POSED.replace('poi "hall2"', 'poi "hall2" //[20, 0, 0, 0, 0, 0, 1]')


@pytest.mark.parametrize(
    ("text", "finding"),
    [
        (hotel('lift "lift1" at hall0 comes within 40 takes 9 to 20'), ("PML470", "lift1 has one floor only")),
        (hotel(LIFT.replace("hall2", "hall1")), ("PML470", "hall1 stands twice behind at")),
        (hotel(LIFT.replace("40", "0")), ("PML470", "lift1 would be there at once, always")),
        (
            hotel(LIFT.replace("to 20", "to 5")),
            ("PML200", "a ride in lift1 ends later than 10 and at 5 at the latest: there is no such time"),
        ),
        (
            hotel(more="optional 1 objective: lift lift1 holds 1 robot"),
            ("PML470", "what lift1 holds is kept in any case"),
        ),
        (hotel(LIFT.replace(", hall2", "")), ("PML471", "hall2 is no floor of lift1")),
        (
            hotel(f'door "d1" opens within 5\n{LIFT}', " through d1 by lift1"),
            ("PML471", "a way by lift1 leads through no door but that of the lift"),
        ),
        (hotel(LIFT.replace("hall2", "roof")), ("PML110", "there is no POI roof")),
        (hotel(by=" by lift2"), ("PML110", "there is no lift lift2")),
        (hotel(by=" by hall0"), ("PML110", "hall0 is a POI, but a lift is needed here")),
        (hotel(by=""), ("PML472", "no way goes by lift1")),
        (POSED, ("PML473", "lift1 has no pose, but places do: robots would not know where to stand in it")),
        (
            POSED.replace("to 20", "to 20 //[2.5, 0, 0, 0, 0, 0, 1]"),
            ("PML474", "hall0 and hall1 are less than 2.7 m from the middle of lift1, where robots wait for it"),
        ),
        (
            POSED.replace("to 20", "to 20 //[2, 0, 0, 0, 0, 0, 1] roof [2, 0, 0, 0, 0, 0, 1]"),
            ("PML470", "the cabin of lift1 has a pose at roof, which is none of its floors"),
        ),
        (
            hotel(more="objective: lift lift1 holds 3 robots"),
            ("PML232", "this changes nothing: never are more than 2 in lift1"),
        ),
    ],
)
def test_what_is_wrong_is_said(text: str, finding: Tuple[str, str]) -> None:
    assert finding in found(text)


def test_a_sound_lift_is_no_finding() -> None:
    assert [each for each in found(hotel()) if each[0] != "PML190"] == []
    posed = scenario(POSED.replace("to 20", "to 20 //[2, 0, 0, 0, 0, 0, 1] hall2 [22, 0, 0, 0, 0, 0, 1]"))
    places = [posed.lifts[0].cabin_at(floor) for floor in ("hall0", "hall1", "hall2")]
    assert [place.x for place in places if place is not None] == [2, 2, 22]


def test_its_words_may_be_names() -> None:
    text = hotel().replace("hall1", "lift").replace("bot1", "comes").replace("bot2", "by")
    assert [each for each in found(text) if each[0] != "PML190"] == []
