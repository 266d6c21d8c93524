"""Two places that are connected by a way of its own for each of several agents."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.drawing.layout import drawable, poses
from pursue_gen.drawing.map_svg import draw
from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import check, parse
from pursue_gen.language.draft import Draft
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.writer import scenario_text
from pursue_gen.solving.rules import Rules
from pursue_gen.tga import translate
from pursue_gen.tools.draw.view import view
from pursue_gen.tools.lsp.hover import hover
from pursue_gen.tools.simulation.recorder import Driven

FLOOR = """\
poi "a"
poi "b"
connect a and b distance 3 for agv
connect b and a distance 5 except agv only_if open is_true
event "press"
event "work" location b
state "open": initially false, true_if press
agent "agv" controllable mobile 1 location a can_do work
agent "cart" controllable mobile 2 location a can_do work
agent "gate" location a can_do press
objective: avoid agv at b
reach_objective: do work
"""


def floor(old: str = "", new: str = "") -> Scenario:
    return parse(FLOOR.replace(old, new) if old else FLOOR, "floor.pur", "floor")


def twice(text: str) -> List[str]:
    return [f"{one.message}; {one.hint}" for one in check(parse(text, "x.pur", "x")) if one.code == "PML146"]


def test_each_agent_has_its_own_distance_and_condition() -> None:
    story = floor()
    assert not check(story) and [way.text for way in floor().connections] == [
        way.text for way in parse(scenario_text(story), "x.pur").connections
    ]
    agv, cart, _ = story.agents
    assert story.movements(agv)["a", "b"] == (3, 4) and story.movements(cart)["a", "b"] == (10, 11)
    network = translate(story)
    (free, held) = (
        next(edge for edge in automaton.edges if edge.sent and edge.target == "going_a_to_b")
        for automaton in network.automata
        if any(location.name == "going_a_to_b" for location in automaton.locations)
    )
    assert "open" not in repr(free) and "open" in repr(held), "the door is on the way of the cart alone"
    assert Driven(story)._lengths == {
        ("agv", "going_a_to_b"): 3.0, ("agv", "going_b_to_a"): 3.0,
        ("cart", "going_a_to_b"): 5.0, ("cart", "going_b_to_a"): 5.0,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (" except agv", "", "b and a are connected twice for agv; line 3 does it already; delete one"),
        (" except agv", "", "or write behind one for whom it is, and behind the other except agv"),
        (" except agv", " for cart, agv", "connected twice for agv"),
        (" for agv", " except gate", "connected twice for cart"),
        (" for agv", " one_way", "connected twice for cart and gate"),
    ],
)
def test_an_agent_has_one_way_between_two_places(old: str, new: str, said: str) -> None:
    (found,) = twice(FLOOR.replace(old, new))
    assert said in found


def test_two_that_are_for_all_are_one_too_many() -> None:
    plain = FLOOR.replace(" for agv", "").replace(" except agv", "")
    assert twice(plain) == [
        "b and a are connected twice; line 3 does it already; "
        "delete one: a connection goes both ways; or write one_way behind both"
    ]
    assert not twice(FLOOR.replace(" for agv", " one_way for agv, cart").replace(" except", " one_way except"))


def test_changes_are_of_one_of_them() -> None:
    said = [each.say(each.values[0]) for each in repairs(floor(), Rules()) if each.what in ("distance", "whom")]
    assert said == [
        "a and b (only for agv) at distance 2 instead of 3",
        "b and a (not for agv) at distance 4 instead of 5",
    ]


def test_maps_and_editors_show_both() -> None:
    story = floor()
    where, computed = poses(drawable(story))
    picture = draw(drawable(story), where, computed)
    assert picture.count('class="pg-way"') == 1 and "3, 5 ?" in picture
    assert "Between a and b at distance 3 only for agv" in picture
    document = Draft(FLOOR, "floor.pur")
    found = hover(document, FLOOR.index('"a"') + 1)
    assert found is not None and "distance 3 (agv 3 to 4 units of time), only for agv" in found.markdown
    assert "distance 5 (cart 10 to 11 units of time), not for agv" in found.markdown
    found = hover(document, FLOOR.index("distance 5") + 9)
    assert found is not None and "cart needs" in found.markdown and "agv needs" not in found.markdown
    assert [(way["distance"], way["only_for"], way["not_for"]) for way in view(FLOOR)["ways"]] == [
        ("3", "agv", ""), ("5", "", "agv"),
    ]  # fmt: skip
