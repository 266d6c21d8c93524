"""Ways and places that are for some agents only: read, checked, told, and changed on the page of draw."""

from __future__ import annotations

from typing import Dict, List, Tuple

import pytest

from pursue_gen.language import check, parse
from pursue_gen.language.behaviour import places_of
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.writer import scenario_text
from pursue_gen.tga import translate
from pursue_gen.tga.network import Network
from pursue_gen.tools.draw.operations import change
from pursue_gen.tools.draw.view import view
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.hover import hover

FLOOR = """\
group "carts": cart1, cart2
poi "hall"
poi "lift" label "the lift" for robots except cart2 //[1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0] cart1 [1, 3, 0, 0, 0, 0, 1]
poi "attic"{attic}
connect hall and lift distance 2{hall}
connect lift and attic distance 3 one_way except carts only_if agv at lift
event "bring" location attic
agent "agv" label "Porter" controllable mobile 1 location hall can_do bring
agent "cart1" controllable mobile 1 location hall
agent "cart2" controllable mobile 1 location hall
agent "gerda" human controllable mobile 1 location hall
agent "visitor" mobile 1 location hall
{more}reach_objective: do bring
"""


def floor(attic: str = "", hall: str = "", more: str = "") -> str:
    return FLOOR.format(attic=attic, hall=hall, more=more)


def scenario(text: str) -> Scenario:
    return parse(text, "x.pur", "x")


def errors(text: str) -> List[Tuple[str, str]]:
    return [(one.code, one.message) for one in check(scenario(text)) if one.code not in ("PML190", "PML124")]


def where(text: str) -> Dict[str, str]:
    return {name: " ".join(sorted(places)) for name, places in places_of(scenario(text)).items()}


def test_it_is_read_written_and_laid_out() -> None:
    story = scenario(floor())
    lift, attic = story.pois[1:]
    up = story.connections[1]
    assert [ref.name for ref in lift.only_for] == ["agv", "cart1", "cart2"] and lift.not_for[0].name == "cart2"
    assert lift.pose is not None and [spot.robot.name for spot in lift.spots] == ["cart1"] and not attic.only_for
    assert lift.whom_words == "only for Porter, cart1 and cart2, not for cart2"
    assert up.text == "connect lift and attic distance 3 one_way except cart1, cart2 only_if agv at lift"
    assert scenario(scenario_text(story)).connections[1].text == up.text
    assert format_text(floor(), "x.pur").count("except carts only_if") == 1
    assert errors(floor()) == []


def test_for_all_others_the_way_does_not_exist() -> None:
    assert where(floor()) == {
        "agv": "attic hall lift", "cart1": "hall lift", "cart2": "hall", "gerda": "hall", "visitor": "hall",
    }  # fmt: skip
    network = translate(scenario(floor()))
    assert _ways(network, "agv") == ["going_hall_to_lift", "going_lift_to_hall", "going_lift_to_attic"]
    assert _ways(network, "cart1") == ["going_hall_to_lift", "going_lift_to_hall"] and not _ways(network, "visitor")
    assert not [channel for channel in network.channels if channel.startswith(("cart2", "visitor"))]


def _ways(network: Network, agent: str) -> List[str]:
    (found,) = (each for each in network.automata if each.name.endswith(agent))
    return [location.name for location in found.locations if location.name.startswith("going")]


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        (floor(" except agv"), "PML153", "agv can never do bring: no way that it may take leads from hall to attic"),
        (floor(" for agv, agv"), "PML164", "agv stands twice behind for"),
        (floor(hall=" except gerda, gerda"), "PML164", "gerda stands twice behind except"),
        (floor(hall=" for carts except cart1, cart2"), "PML164", "the way between hall and lift is for nobody"),
        (floor(hall=" for agw"), "PML110", "agw"),
        (floor(hall=" for hall"), "PML110", "hall is a POI, but an agent is needed here"),
        (floor().replace('poi "hall"', 'poi "hall" except gerda'), "PML149", "gerda starts in hall"),
        (floor(more="travel gerda from hall to lift takes 3\n"), "PML201", "gerda never goes from hall to lift"),
        (floor(more="assume: visitor never at lift\n"), "PML254", "no way leads visitor from hall to lift anyway"),
        (floor(more="objective: avoid gerda at lift\n"), "PML230", "gerda is never at lift"),
    ],
)
def test_what_is_wrong_with_it(text: str, code: str, message: str) -> None:
    assert any(found == code and message in said for found, said in errors(text)), errors(text)


def test_its_word_may_be_a_name() -> None:
    text = """\
poi "except" for except2, other except other
connect except and b distance 1 except other
poi "b"
agent "except2" location b
agent "other" controllable mobile 1 location b
"""
    (way,) = read(text, "x.pur").partial.connections
    assert (way.a, [ref.name for ref in way.not_for]) == ("except", ["other"])


def test_a_statement_for_each_of_a_group_may_follow_a_place_or_a_way() -> None:
    text = floor().replace('poi "hall"\n', 'poi "hall"\nfor each c in carts: event "ring" of c location hall\n')
    assert [event.name for event in scenario(text).events[:2]] == ["ring_cart1", "ring_cart2"]
    (finding,) = read(floor().replace('poi "hall"\n', 'poi "hall"\nfor c in carts: poi "x" of c\n'), "x").diagnostics
    assert "`each`" in finding.message
    (finding,) = read('poi the hall except gerda\npoi "b"', "x").diagnostics
    assert 'poi "the_hall" label "the hall"' in finding.hint


def told(before: str) -> str:
    found = hover(Draft.of(floor(), "x.pur"), floor().index(before) + len(before))
    return "" if found is None else found.markdown.replace("\\", "")


def test_editors_complete_and_tell_it() -> None:
    at = floor().index(" except carts") + len(" except ")
    names = {one.label for one in complete(Draft.of(floor(), "x.pur"), at)}
    assert {"carts", "robots", "agv", "cart1", "visitor"} <= names and "lift" not in names
    assert "only for Porter, cart1 and cart2, not for cart2" in told('poi "li')
    assert "not for cart1 and cart2, only while" in told('poi "li')
    assert "never is at lift" in told('agent "ge') and "never goes" not in told('agent "ge')
    assert "never takes the way between lift and attic at distance 3" in told('agent "cart')


def test_the_page_of_draw_shows_and_changes_it() -> None:
    shown = view(floor(), "x.pur")
    lift, way = shown["places"][1], shown["ways"][1]
    assert (lift["only_for"], lift["not_for"], way["not_for"]) == ("robots", "cart2", "carts")
    fields = {"not_for": "", "only_for": "agv, gerda"}
    changed = change(floor(), {"do": "set", "statement": way["statement"], "fields": fields}).text
    assert "connect lift and attic distance 3 one_way for agv, gerda only_if agv at lift\n" in changed
    changed = change(changed, {"do": "set", "statement": lift["statement"], "fields": {"only_for": ""}}).text
    assert 'poi "lift" label "the lift" except cart2 //[1.0,' in changed
