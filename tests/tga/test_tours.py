"""The automata of tours."""

from __future__ import annotations

from dataclasses import replace

import pytest

from pursue_gen.language import parse
from pursue_gen.tga import translate
from pursue_gen.tga.network import Network
from pursue_gen.tga.tours import Tour, tour_automaton, with_tours
from pursue_gen.vocabulary.statuses import statuses

TEXT = """
poi "a"
poi "b"
poi "c"
connect a and b distance 2
connect b and c distance 2
event "call"
agent "bot1" controllable mobile 1 location a can_do call
agent "guest" location b can_do call
objective: patrol a, c every 40 by bot1
"""
ROUND = Tour("bot1", ("a", "b", "c", "b"))


def network() -> Network:
    return translate(parse(TEXT, "round.pur", "round"))


def test_it_follows_the_commanded_movements_and_is_lost_by_any_other() -> None:
    automaton = tour_automaton(network(), ROUND)
    assert automaton is not None
    assert (automaton.name, automaton.initial) == ("bot1_tour", "stop_1")
    received = ((edge, edge.sync) for edge in automaton.edges if edge.sync is not None and not edge.sync.sends)
    assert [(edge.source, edge.target, sync.channel) for edge, sync in received] == [
        ("stop_1", "stop_2", "bot1_a2b"),
        ("stop_2", "lose", "bot1_b2a"),
        ("stop_2", "stop_3", "bot1_b2c"),
        ("stop_3", "stop_4", "bot1_c2b"),
        ("stop_4", "stop_1", "bot1_b2a"),
        ("stop_4", "lose", "bot1_b2c"),
    ]
    assert all(edge.controllable and not edge.assign and not edge.resets for edge in automaton.edges)


def test_it_may_begin_with_a_way_to_the_round_or_end_where_the_robot_stays() -> None:
    later, stays = (tour_automaton(network(), Tour("bot1", ("a", "b", "c"), again)) for again in (1, 3))
    assert later is not None and stays is not None
    assert ("stop_3", "stop_2") in [(edge.source, edge.target) for edge in later.edges]
    assert {edge.target for edge in stays.edges if edge.source == "stop_3"} == {"lose"}


@pytest.mark.parametrize(
    "tour",
    [
        Tour("bot1", ("b", "c")),  # it starts at a
        Tour("bot1", ("a", "c")),  # there is no such way
        Tour("bot1", ("a", "b", "c")),  # nor one from c to a
        Tour("bot1", ("a", "b"), 3),
        Tour("bot1", ("a", "b"), -1),
        Tour("bot1", ()),
        Tour("guest", ("b", "b")),
        Tour("bot2", ("a", "b")),
    ],
)
def test_what_cannot_be_is_none(tour: Tour) -> None:
    assert tour_automaton(network(), tour) is None
    assert with_tours(network(), [tour]) == network()


def test_the_name_may_be_taken() -> None:
    taken = replace(network(), clocks=(*network().clocks, "bot1_tour"))
    assert tour_automaton(taken, ROUND) is None


def test_one_that_is_there_is_left_as_it_is() -> None:
    once = with_tours(network(), [ROUND])
    assert with_tours(once, [ROUND]) == once
    assert len(once.automata) == len(network().automata) + 1


def test_its_locations_have_words() -> None:
    toured = with_tours(network(), [ROUND])
    (status,) = (each for each in statuses(parse(TEXT, "round.pur", "round"), toured) if each.of == "bot1_tour")
    assert status.label == "tour of bot1"
    assert (status.texts["stop_2"], status.texts["lose"]) == ("stop 2 of 4", "off the tour")
