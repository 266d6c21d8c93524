"""Which clocks only say how soon the environment may act again, and the network without them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from pursue_gen.language import parse
from pursue_gen.tga import translate
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Constraint,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
    Sync,
)
from pursue_gen.tga.pauses import acting_at_most, pauses, with_calls_that_are_heard, without_clocks

STORY = """
poi "desk"
poi "room"
connect desk and room distance 2
event "call" location room
event "nap" location room duration 3
event "serve" location room duration 1
agent "bot" controllable mobile 1 location desk can_do serve
agent "guest" {guest}
objective: if call then serve within 20
"""

CALL = Edge("here", "here", Guard((ClockBound("y", ">", 1),)), Sync("call", sends=True), (), ("y",), False)
HEARD = Sync("call", sends=True, heard=True)
NOTHING = Objective(Kind.SAFETY)
PLACES = (Location("here"), Location("there", (ClockBound("x", "<=", 2),)))


def network(*edges: Edge) -> Network:
    """One agent with these edges, and a call."""
    caller = Automaton("guest", PLACES, "here", (CALL, *edges))
    return Network(("x", "y"), (), ("call",), (caller,), ())


@pytest.mark.parametrize(
    ("guest", "expected"),
    [
        ("location room can_do call", ("Cguest",)),
        ("location room can_do call, nap", ()),
        ("mobile 2 location room can_do call", ()),
        ("controllable location room can_do call", ()),
    ],
)
def test_who_calls_and_does_nothing_else_has_a_clock_for_its_pauses_alone(guest: str, expected: tuple) -> None:
    assert pauses(translate(parse(STORY.format(guest=guest), "story.pur"))) == expected


@pytest.mark.parametrize(
    "other",
    [
        Edge("here", "here", Guard((ClockBound("y", ">", 1),)), controllable=True),
        Edge("here", "there", resets=("y",), controllable=True),
        Edge("here", "here", Guard((ClockBound("y", "<", 9),)), controllable=False),
        Edge("here", "here", Guard((ClockBound("y", "==", 9),)), controllable=False),
        Edge("there", "here", Guard((ClockBound("y", ">", 1),)), controllable=False),
    ],
    ids=["a command", "a reset by a command", "an upper bound", "a moment", "an obligation"],
)
def test_a_clock_that_is_compared_in_another_way_is_no_pause(other: Edge) -> None:
    assert pauses(network()) == ("y",)
    assert pauses(network(other)) == ()


def test_a_clock_that_bounds_a_stay_is_no_pause() -> None:
    stays = network()
    bounded = replace(stays.automata[0], locations=(Location("here", (ClockBound("y", "<=", 7),)), PLACES[1]))
    assert pauses(replace(stays, automata=(bounded,))) == ()


def test_without_them_no_edge_names_them_and_all_others_stay() -> None:
    late = ClockBound("x", ">", 1)
    going = Edge("here", "there", Guard((late, ClockBound("y", ">=", 2))), resets=("x", "y"), controllable=False)
    less = without_clocks(network(going), ("y",))
    assert less.clocks == ("x",) and less.automata[0].clocks == {"x"}
    assert less.automata[0].edges[1] == replace(going, guard=Guard((late,)), resets=("x",))
    assert less.automata[0].edges[0].sync == CALL.sync


def test_what_is_known_of_the_others_at_the_start_stays_known() -> None:
    known = (Constraint("x", None, Fraction(3), False), Constraint("x", "y", Fraction(1), False))
    assert without_clocks(replace(network(), start=known), ("y",)).start == known[:1]
    # Without any bound all clocks would be 0.
    assert without_clocks(replace(network(), start=known[1:]), ("y",)).start == (
        Constraint(None, "x", Fraction(0), False),
    )


def test_a_network_without_clocks_to_leave_out_is_itself() -> None:
    same = network()
    assert without_clocks(same, ()) is same


def test_a_call_that_only_begins_a_pause_is_a_move_where_somebody_hears_it() -> None:
    going = Edge("here", "there", Guard((ClockBound("y", ">", 1),)), controllable=False)
    silent = replace(CALL, sync=None)
    less = with_calls_that_are_heard(network(going, silent))
    assert less.automata[0].edges == (replace(CALL, sync=HEARD), going)
    assert with_calls_that_are_heard(less) is less


@pytest.mark.parametrize(
    "edge", [replace(CALL, resets=("x", "y")), replace(CALL, assign=(("v", 1),)), replace(CALL, target="there")]
)
def test_a_call_that_does_more_is_a_move(edge: Edge) -> None:
    more = Network(("x", "y"), (("v", 0),), ("call",), (Automaton("guest", PLACES, "here", (edge,)),), ())
    assert pauses(more) == ("y",) and with_calls_that_are_heard(more) is more


def test_with_few_calls_every_location_knows_how_many_there_were() -> None:
    going = Edge("here", "there", resets=("x",), controllable=False)
    less = acting_at_most(network(going), NOTHING, 1).automata[0]
    assert [(location.name, location.invariant) for location in less.locations] == [
        ("here", ()), ("there", PLACES[1].invariant), ("here 1", ()), ("there 1", PLACES[1].invariant)
    ]  # fmt: skip
    assert [(edge.source, edge.target, edge.sync) for edge in less.edges] == [
        ("here", "here 1", HEARD), ("here", "there", None), ("here 1", "there 1", None)
    ]  # fmt: skip


def test_who_needs_no_rest_acts_as_before() -> None:
    busy = network(Edge("here", "here", Guard((ClockBound("y", ">", 1),)), controllable=True))
    assert acting_at_most(busy, NOTHING, 1).automata == busy.automata


def test_places_that_the_objective_names_stay_what_they_are() -> None:
    met = Objective(Kind.REACH, goal=(("guest", "there"),))
    assert acting_at_most(network(), met, 1) == with_calls_that_are_heard(network())
