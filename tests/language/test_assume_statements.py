"""Assumptions in the language: what they say, and what cannot be assumed."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.language.scenario import AtMost, Leaves, NeverAt, Waits
from tests.assumptions import APART, AWAY, GOODBYE, LEAVES, MUSEUM, PLAYROOM, ROOMS, SPACED, STAYS, TWICE, scenario


def findings(text: str) -> List[Tuple[str, int, str]]:
    return [(f.code, f.span.line if f.span else 0, f.message) for f in check(scenario(text))]


def test_each_form_is_read() -> None:
    twice, spaced = scenario(PLAYROOM.format(f"{TWICE}\n{SPACED}")).assumptions
    leaves, away = scenario(MUSEUM.format(f"{LEAVES}\n{AWAY}")).assumptions
    assert isinstance(twice, AtMost) and (twice.agent.name, twice.event.name, twice.times) == ("child", "spill", 2)
    assert isinstance(spaced, Waits) and (spaced.agent.name, spaced.event.name, spaced.time) == ("child", "spill", 20)
    assert isinstance(leaves, Leaves) and (leaves.place.name, leaves.time) == ("gallery", 30)
    assert isinstance(away, NeverAt) and (away.agent.name, away.place.name) == ("visitor", "store")
    assert [each.clause for each in (twice, spaced, leaves, away)] == [
        "child does spill at most 2 times",
        "child waits 20 units between one spill and the next",
        "visitor leaves gallery within 30 units",
        "visitor is never at store",
    ]
    assert check(scenario(PLAYROOM.format(f"{TWICE}\n{SPACED}"))) == ()


def test_each_time_of_a_stay_has_the_unit_that_it_is_written_with() -> None:
    text = "unit second\n" + ROOMS.format("assume: anna stays {} to 5 min at each place")
    for least, shown in (("30", "30 s"), ("0.5 min", "0.5 min")):
        (stays,) = parse(text.format(least), "rooms.pur", "rooms").assumptions
        assert stays.clause == f"anna stays {shown} to 5 min at each place"


def test_its_words_may_be_names_everywhere_else() -> None:
    text = (
        'poi "at" poi "never" poi "place" connect at and never distance 1 connect at and place distance 1 '
        'event "waits" location at event "times" '
        'agent "does" controllable mobile 1 location never can_do waits, times '
        'agent "leaves" mobile 1 location at can_do times agent "stays" mobile 1 location place\n'
        "assume: leaves leaves at within 5 assume: leaves never at never assume: stays stays 2 to 5 at each place\n"
        "reach_objective: do waits"
    )
    story = parse(text, "words.pur", "words")
    assert [f.code for f in check(story)] == []
    assert [each.clause for each in story.assumptions] == [
        "leaves leaves at within 5 units", "leaves is never at never", "stays stays 2 to 5 units at each place",
    ]


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        (PLAYROOM.format("assume: bot does clean at_most 2 times"), "PML250", "bot is controlled"),
        (PLAYROOM.format("assume: child does spill at_most 101 times"), "PML251", "100 or less"),
        (PLAYROOM.format("assume: child waits 0 between spill"), "PML251", "more than 0"),
        (MUSEUM.format("assume: visitor leaves gallery within 1\nreach_objective: do goodbye"), "PML251", "too short"),
        (MUSEUM.format("assume: visitor never at gallery\nreach_objective: do goodbye"), "PML252", "starts in gallery"),
        (PLAYROOM.format("assume: child leaves room within 5"), "PML252", "cannot leave it"),
        (PLAYROOM.format(f"{TWICE}\nassume: child does spill at_most 3 times"), "PML253", "line 9 assumes this"),
        (PLAYROOM.format("assume: child does clean at_most 2 times"), "PML254", "cannot do clean anyway"),
        (ROOMS.format("assume: anna stays 0 to 1 at each place"), "PML251", "too short"),
        (ROOMS.format("assume: anna stays 6 to 5 at each place"), "PML200", "the second number is smaller"),
        (PLAYROOM.format("assume: child stays 5 to 9 at each place"), "PML252", "child is not mobile"),
        (MUSEUM.replace("3\nevent", "3 one_way\nevent").format(f"{STAYS}\n{GOODBYE}"), "PML252",
         "no way leads away from store"),
        (ROOMS.format("assume: anna stays 5 to 9 at each place\nassume: anna stays 3 to 8 at each place"), "PML253",
         "line 10 assumes this of anna already"),
        (ROOMS.format("assume: anna stays 5 to 9 at each place\nassume: anna leaves west within 4"), "PML264",
         "anna stays 5 or longer, and is assumed to leave west sooner"),
        (ROOMS.format("assume: anna stays 5 to 9 at each place\nassume: anna never at east"), "PML264",
         "anna leaves west in time, and is assumed never to be where ways lead from there"),
        (MUSEUM.format(f"{AWAY}\n{AWAY.replace('store', 'hall')}\n{LEAVES}\nreach_objective: do goodbye"), "PML264",
         "visitor leaves gallery in time, and is assumed never to be where ways lead from there"),
        (ROOMS.format(f"assume: anna stays 5 to 9 at each place\n{APART}"), "PML264", "could be kept from setting off"),
        (ROOMS.format("assume: not cleaner at west"), "PML250", "cleaner is controlled"),
        (ROOMS.format("assume: not (any agent at west)"), "PML263", "any agent means controlled ones as well"),
        (PLAYROOM.format("assume: not tidy is_true"), "PML263", "bot is controlled, and its clean sets tidy"),
        (ROOMS.format("assume: not anna at west"), "PML252", "this holds at the start: anna is at west"),
        (ROOMS.format(f"{APART}\n{APART}"), "PML253", "line 10 assumes this already"),
        (ROOMS.format(f"assume: anna leaves east within 9\n{APART}"), "PML264", "anna is assumed to leave a place"),
    ],
)
def test_what_cannot_be_assumed_is_reported_once(text: str, code: str, words: str) -> None:
    ((found, _, message),) = findings(text)
    assert found == code and words in message


def test_an_unknown_name_is_reported_and_nothing_else() -> None:
    assert [code for code, *_ in findings(PLAYROOM.format("assume: cat does spill at_most 2 times"))] == ["PML110"]
    assert [code for code, *_ in findings(PLAYROOM.format("assume: child does spil at_most 2 times"))] == ["PML110"]
