"""What places and ways hold: read, told, written again, and with what robots need no spot of their own."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_gen.language import check, parse
from pursue_gen.language.conditions import condition_text
from pursue_gen.language.formatter import format_text
from pursue_gen.language.objectives.holds import Holds
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import NeverWith
from pursue_gen.language.writer import scenario_text
from pursue_gen.workspace.spots import spots_in_one

FLOOR = """\
poi "mouth" label "the mouth"
poi "shelf"
poi "end"
connect mouth and shelf distance 2
connect shelf and end distance 2
event "pick" location shelf duration 1
agent "bot1" label "Porter" controllable mobile 1 location mouth can_do pick
agent "bot2" controllable mobile 1 location mouth
agent "bot3" controllable mobile 1 location mouth
agent "anna" mobile 1 location mouth
"""
GOAL = "reach_objective: do pick\n"


@pytest.mark.parametrize(
    ("words", "told", "broken"),
    [
        ("place shelf holds 1 robot", "for 1 robot at shelf", "more than 1 robot is at shelf"),
        ("place shelf holds 2 robots", "for 2 robots at shelf", "more than 2 robots are at shelf"),
        ("place shelf holds 2 agents", "for 2 agents at shelf", "more than 2 agents are at shelf"),
        ("place shelf holds 1 of bot1, anna", "for 1 of Porter and anna at shelf", "more than 1 of Porter and anna is"),
        ("place shelf, end holds 1 robot", "for 1 robot at or between shelf and end", "1 robot is at or between shelf"),
        ("every way holds 1 robot", "for 1 robot on every way", "more than 1 robot is on one way"),
        ("every way holds 3 agents", "for 3 agents on every way", "more than 3 agents are on one way"),
        ("way mouth to shelf holds 1 robot", "1 robot between the mouth and shelf", "is between the mouth and shelf"),
    ],
)
def test_each_form_is_read_and_told(words: str, told: str, broken: str) -> None:
    scenario = parse(FLOOR + f"objective: {words}\n" + GOAL, "x.pur")
    (safety,) = scenario.safety
    assert isinstance(safety, Holds) and safety.text == words
    assert told in safety.sentence(scenario.shown) and broken in safety.broken(str)
    assert [finding for finding in check(scenario) if finding.code != "PML190"] == []
    assert f"objective: {words}\n" in scenario_text(scenario)
    assert f"objective: {words}\n" in format_text(scenario.text, "x.pur")


def test_a_group_of_places_holds_so_many_together_and_each_of_it_by_itself() -> None:
    aisle = FLOOR + 'group "aisle": shelf, end\n'
    (together,) = parse(aisle + "objective: place aisle holds 2 robots\n" + GOAL, "x.pur").safety
    assert together.text == "place shelf, end holds 2 robots"
    each = parse(aisle + "for each p in aisle: objective: place p holds 1 of robots\n" + GOAL, "x.pur").safety
    assert [one.text for one in each] == [f"place {p} holds 1 of bot1, bot2, bot3" for p in ("shelf", "end")]


def test_every_place_and_every_way_are_those_of_the_building() -> None:
    both = "objective: every place holds 1 robot\nobjective: every way holds 1 robot\n"
    places, ways = parse(FLOOR + both + GOAL, "x.pur").safety
    one_by_one = "".join(f"objective: place {name} holds 1 robot\n" for name in ("mouth", "shelf", "end"))
    one_by_one += "objective: way mouth to shelf holds 1 robot\nobjective: way shelf to end holds 1 robot\n"
    alone = parse(FLOOR + one_by_one + GOAL, "x.pur").safety
    assert isinstance(places, Holds) and isinstance(ways, Holds)
    all_of_them = [condition_text(room) for each in (places, ways) for room in each.rooms]
    assert all_of_them == [condition_text(room) for each in alone for room in each.rooms]  # type: ignore[attr-defined]


def test_what_is_wrong_with_every_place_is_said_of_the_place() -> None:
    def found(words: str) -> List[Tuple[str, str]]:
        scenario = parse(FLOOR + f"objective: {words}\n" + GOAL, "x.pur")
        return [(each.code, each.message) for each in check(scenario) if each.code != "PML190"]

    ((code, message),) = found("every place holds 1 robot")
    assert (code, "more than 1 robot is at the mouth" in message) == ("PML234", True)
    ((code, message),) = found("every way holds 3 robots")
    assert (code, "never are more than 3 on one way" in message) == ("PML232", True)
    assert found("every way holds 1 robot") == []
    bots = "".join(f'agent "r{k}" controllable mobile 1 location mouth\n' for k in range(13))
    crowd = parse(FLOOR + bots + "objective: every way holds 3 robots\n" + GOAL, "x.pur")
    assert [each.code for each in check(crowd) if each.code != "PML190"] == ["PML233"]


def test_its_words_may_be_names() -> None:
    text = """\
poi "place" poi "way" poi "holds" poi "every"
connect place and way distance 1
agent "robots" controllable mobile 1 location place
agent "place1" mobile 1 location way
objective: place place, holds holds 1 robot
objective: way place to way holds 1 of robots, place1
objective: robots never_with place1
"""
    one, other, third = parse(text, "x.pur").safety
    assert (one.text, other.text) == ("place place, holds holds 1 robot", "way place to way holds 1 of robots, place1")
    assert isinstance(third, NeverWith)
    as_agent = 'poi "a" agent "way" location a agent "place" location a objective: place never_with way'
    (safety,) = parse(as_agent, "x.pur").safety
    assert isinstance(safety, NeverWith)


def test_a_misspelled_statement_below_is_one_of_its_own() -> None:
    for some in ("1 robot", "2 robots", "2 agents"):
        text = FLOOR + f"objective: place shelf holds {some}\nconect end and mouth distance 1\n"
        (finding,) = read(text, "x").diagnostics
        assert (finding.code, finding.span and finding.span.line) == ("PML011", 12) and "mean connect?" in finding.hint


def test_very_many_ways_in_which_it_is_full_are_refused() -> None:
    bots = "".join(f'agent "r{k}" controllable mobile 1 location mouth\n' for k in range(13))
    crowd = parse(FLOOR + bots + "objective: place shelf holds 7 robots\n" + GOAL, "x.pur")
    assert [finding.code for finding in check(crowd) if finding.code != "PML190"] == ["PML233"]
    single = parse(FLOOR + bots + "objective: place shelf holds 1 robot\n" + GOAL, "x.pur")
    assert [finding.code for finding in check(single) if finding.code != "PML190"] == []


def test_robots_of_which_a_place_holds_one_share_its_pose() -> None:
    alone = parse(FLOOR + "objective: place shelf holds 1 robot\n" + GOAL, "x.pur")
    (finding,) = spots_in_one(alone, 0)
    assert "at mouth" in finding.message and "more place" in finding.message  # the end of the aisle holds all
    for words in ("place shelf holds 2 robots", "place shelf holds 1 of bot1, bot2"):
        several = parse(FLOOR + f"objective: {words}\n" + GOAL, "x.pur")
        assert "2 more places" in spots_in_one(several, 0)[0].message
