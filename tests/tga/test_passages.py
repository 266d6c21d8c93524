"""The automata of orders of passage."""

from __future__ import annotations

from dataclasses import replace

import pytest

from pursue_gen.language import parse
from pursue_gen.tga import translate
from pursue_gen.tga.network import Network
from pursue_gen.tga.passages import Passage, passage_automaton, with_passages
from pursue_gen.vocabulary.statuses import statuses
from pursue_runtime.locations import Visit, place_passed, visit_at

TEXT = """
poi "a"
poi "b"
poi "c"
connect a and b distance 2
connect b and c distance 2
event "call"
agent "bot1" controllable mobile 1 location a can_do call
agent "bot2" controllable mobile 1 location c
agent "guest" location b can_do call
reach_objective: do call
"""


def network() -> Network:
    return translate(parse(TEXT, "passing.pur", "passing"))


def test_a_robot_has_the_place_from_when_it_sets_off_for_it_until_it_sets_off_from_there() -> None:
    automaton = passage_automaton(network(), Passage("b", ("bot1", "bot2")))
    assert automaton is not None
    assert automaton.name == "b_passage"
    assert automaton.initial == "awaits_bot1_1"
    visits = [visit_at(place.name) for place in automaton.locations[:2]]
    assert visits == [Visit("bot1", 1, False), Visit("bot1", 1, True)]
    assert place_passed(automaton.name) == "b"  # what people are told of it while a mission goes on
    received = ((edge, edge.sync) for edge in automaton.edges if edge.sync is not None and not edge.sync.sends)
    edges = [(edge.source, edge.target, sync.channel) for edge, sync in received]
    assert edges == [
        ("awaits_bot1_1", "has_bot1_1", "bot1_a2b"),
        ("awaits_bot1_1", "has_bot1_1", "bot1_c2b"),
        ("has_bot1_1", "awaits_bot2_2", "bot1_b2a"),
        ("has_bot1_1", "awaits_bot2_2", "bot1_b2c"),
        ("awaits_bot2_2", "has_bot2_2", "bot2_a2b"),
        ("awaits_bot2_2", "has_bot2_2", "bot2_c2b"),
        ("has_bot2_2", "awaits_nobody", "bot2_b2a"),
        ("has_bot2_2", "awaits_nobody", "bot2_b2c"),
    ]
    assert all(edge.controllable and not edge.assign and not edge.resets for edge in automaton.edges)


def test_who_starts_at_a_place_has_it() -> None:
    automaton = passage_automaton(network(), Passage("a", ("bot1", "bot2")))
    assert automaton is not None
    assert automaton.initial == "has_bot1_1"
    assert "awaits_bot1_1" not in [location.name for location in automaton.locations]


@pytest.mark.parametrize(
    "passage",
    [
        Passage("a", ("bot2", "bot1")),  # bot1 is there first
        Passage("b", ("bot1", "bot3")),
        Passage("b", ()),
    ],
)
def test_what_cannot_be_is_none(passage: Passage) -> None:
    assert passage_automaton(network(), passage) is None
    assert with_passages(network(), [passage]) == network()


def test_the_name_may_be_taken() -> None:
    taken = replace(network(), clocks=(*network().clocks, "b_passage"))
    assert passage_automaton(taken, Passage("b", ("bot1",) * 2 + ("bot2",))) is None


def test_one_that_is_there_is_left_as_it_is() -> None:
    once = with_passages(network(), [Passage("b", ("bot1", "bot2"))])
    assert with_passages(once, [Passage("b", ("bot1", "bot2"))]) == once
    assert len(once.automata) == len(network().automata) + 1


def test_visits_of_one_robot_have_an_automaton_of_their_own() -> None:
    assert Passage("b", ("bot1", "bot1")).name == "b_passage_of_bot1"
    assert Passage("b", ("bot1", "bot1")).awaits(2) == "awaits_nobody"


def test_words() -> None:
    passing = with_passages(network(), [Passage("b", ("bot1", "bot2"))])
    found = statuses(parse(TEXT, "passing.pur", "passing"), passing)
    (words,) = (each.texts for each in found if each.of == "b_passage")
    assert words["awaits_bot1_1"] == "next is bot1, visit 1"
    assert words["has_bot2_2"] == "taken by bot2, visit 2"
    assert words["awaits_nobody"] == "nobody comes any more"
