"""`together`: whoever takes part in an event is busy until it ends; without the word nothing changes."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Network, Sync, Test
from pursue_gen.tga.uppaal import read_network, write_network
from tests.tga.test_agents import HOUSE
from tests.together import CARRY, HOTEL, TWO_PORTERS, scenario

AT, GOING, DOING = 2, -21, -22
"""The lift's numbers: there, on the way to the lobby, at work there."""


def network(text: str) -> Network:
    return translate(scenario(text))


def of(automaton: Automaton, channel: str) -> "list[Edge]":
    return [edge for edge in automaton.edges if edge.sync and edge.sync.channel == channel]


def test_the_partner_has_a_place_of_work_that_others_end() -> None:
    waiter = network(HOTEL).automaton("waiter")
    assert waiter.locations[-1] == Location("doing_ride_in_lift"), "the invariant is that of the one who does it"
    assert of(waiter, "ride") == [
        Edge("lift", "doing_ride_in_lift", Guard(), Sync("ride", False), (("Pwaiter", DOING),), ("Cwaiter",))
    ]
    assert of(waiter, "rideDONE") == [
        Edge("doing_ride_in_lift", "lift", Guard(), Sync("rideDONE", False), (("Pwaiter", AT),), ("Cwaiter",))
    ]


def test_the_one_who_does_it_is_as_without_the_word() -> None:
    with_it, without = network(HOTEL), network(HOTEL.replace(" together", ""))
    assert [a.name for a in with_it.automata] == [a.name for a in without.automata]
    for one, other in zip(with_it.automata, without.automata):
        assert one == other or one.name == "waiter"
    assert replace(with_it, automata=()) == replace(without, automata=())


def test_where_it_has_no_place_only_those_take_part_who_are_where_it_is_done() -> None:
    bot2, bot1 = network(CARRY).automaton("bot2"), network(CARRY).automaton("bot1")
    assert [(e.source, e.guard) for e in of(bot2, "lift")] == [
        (poi, Guard(integers=((Test("Pbot1", number),),))) for number, poi in enumerate(("store", "ramp", "van"), 1)
    ]
    assert all(edge.guard == Guard() for edge in of(bot2, "liftDONE")), "it is one's own that ends"
    assert len(of(bot1, "lift")) == len(of(bot2, "lift")) == 3


def test_nobody_takes_part_where_those_who_do_it_never_get() -> None:
    text = CARRY.replace('"bot1" controllable mobile 1', '"bot1" controllable')
    assert [edge.source for edge in of(network(text).automaton("bot2"), "lift")] == ["store"]


def test_what_several_can_do_happens_once_at_a_time() -> None:
    made = network(TWO_PORTERS)
    assert ("Bride", 0) in made.variables
    for name in ("porter", "porter2"):
        (start,), (end,) = of(made.automaton(name), "ride"), of(made.automaton(name), "rideDONE")
        assert (Test("Bride", 0),) in start.guard.integers and ("Bride", 1) in start.assign
        assert ("Bride", 0) in end.assign
    assert "Bride" not in dict(network(HOTEL).variables)


def test_a_partner_that_may_be_late_makes_the_end_late() -> None:
    def bound(**slack: int) -> int:
        porter = ends_reported(network(HOTEL), slack).automaton("porter")
        (invariant,) = next(place.invariant for place in porter.locations if place.name == "doing_ride_in_lift")
        return invariant.bound

    assert (bound(), bound(porter=2), bound(waiter=3), bound(porter=2, waiter=3)) == (5, 7, 8, 8)
    waiter = ends_reported(network(HOTEL), {"waiter": 3}).automaton("waiter")
    assert next(place.invariant for place in waiter.locations if place.name == "going_lobby_to_lift") == (
        ClockBound("Cwaiter", "<=", 6),
    )


@pytest.mark.parametrize("text", [HOTEL, TWO_PORTERS, CARRY])
def test_uppaal_reads_it(text: str) -> None:
    made = network(text)
    receiving = [e for a in made.automata for e in a.edges if e.sync is not None and not e.sync.sends]
    assert not any(edge.guard.clocks for edge in receiving), "receivers of broadcasts have no clock guards"
    assert read_network(write_network(made, scenario_objective(scenario(text))), "TGA.xml") == made


def test_without_the_word_no_network_has_anything_new() -> None:
    made = translate(scenario(HOUSE))
    assert not any(re.match("B", name) for name, _ in made.variables)
    receiving = {a.name for a in made.automata for e in a.edges if e.sync is not None and not e.sync.sends}
    assert receiving.isdisjoint({"bot", "guard", "dog"})
