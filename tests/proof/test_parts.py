"""Strategies for parts of a network, and for stages, that the checker must not take: each made by hand."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Dict, Tuple

import pytest

from pursue_gen.proof.checker import ProofReport, verify
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy, Zone
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
    Sync,
    Test,
)

ALWAYS: Zone = ()
REACH = Objective(Kind.REACH, goal=(("A", "done"),))
GO = Edge("start", "done", Guard((ClockBound("x", ">=", 7),)))
LOSS = Edge("start", "lost")
BOT = Automaton("A", (Location("start"), Location("done"), Location("lost")), "start", (GO, LOSS))


def block(state: Dict[str, object], wait: Tuple[Zone, ...], *commands: Tuple[Zone, str, Edge]) -> Block:
    """What is done in a state: commands by who takes which edge alone."""
    locations = tuple((name, place) for name, place in state.items() if isinstance(place, str))
    values = tuple((name, value) for name, value in state.items() if isinstance(value, int))
    given = tuple(Command((zone,), (Move(name, edge),)) for zone, name, edge in commands)
    return Block(DiscreteState(locations, values), wait, given)


def since(clock: str, bound: int) -> Zone:
    """The clock is at least that."""
    return (Constraint(None, clock, Fraction(-bound), False),)


def before(clock: str, bound: int) -> Zone:
    """The clock is less than that."""
    return (Constraint(clock, None, Fraction(bound), True),)


LATER = block({"A": "start"}, (before("x", 7),), (since("x", 7), "A", GO))


def beside(other: Automaton) -> ProofReport:
    """What the checker says of one who waits for 7 time units while the other is left out."""
    return verify(Network(("x", "z"), (), (), (BOT, other)), REACH, Strategy((LATER,)))


@pytest.mark.parametrize("op", ["<=", "<"])
def test_whoever_may_not_stay_and_cannot_leave_is_not_left_out(op: str) -> None:
    stay = Location("here", (ClockBound("z", op, 5),))
    assert beside(Automaton("O", (stay,), "here", ())).reason.startswith("left out: ")
    assert beside(Automaton("O", (Location("here"),), "here", ())).ok


def test_whoever_has_no_last_instant_to_leave_at_is_not_left_out() -> None:
    away = Edge("here", "there", Guard((ClockBound("z", ">=", 3),)), controllable=False)
    places = (Location("here", (ClockBound("z", "<=", 5),)), Location("there"))
    assert beside(Automaton("O", places, "here", (away,))).ok
    strict = (Location("here", (ClockBound("z", "<", 5),)), Location("there"))
    assert "no last instant" in beside(Automaton("O", strict, "here", (away,))).reason


def in_a_stay(rested: int, stayed: int, *edges: Edge) -> ProofReport:
    """The same of one who is in the middle of a stay of 3 to 5 time units: so many ago it came, and has it rested."""
    bounds = (ClockBound("rested", ">", 1), ClockBound("stayed", ">=", 3))
    away = Edge("here", "there", Guard(bounds), controllable=False)
    back = Edge("there", "here", controllable=False, resets=("rested", "stayed"))
    places = (Location("here", (ClockBound("stayed", "<=", 5),)), Location("there"))
    other = Automaton("O", places, "here", (away, back, *edges))
    values = (("x", 0), ("rested", rested), ("stayed", stayed))
    start = tuple(c for name, v in values for c in (Constraint(name, None, Fraction(v), False), *since(name, v)))
    return verify(Network(("x", "rested", "stayed"), (), (), (BOT, other), start), REACH, Strategy((LATER,)))


def test_whoever_is_in_the_middle_of_a_stay_is_left_out_if_it_can_leave_in_time() -> None:
    assert in_a_stay(0, 0).ok and in_a_stay(2, 4).ok and in_a_stay(0, 3).ok
    assert "may have to leave here and not be able to" in in_a_stay(0, 4).reason
    resting = Edge("here", "here", controllable=False, resets=("rested",))
    assert "may have to leave here and not be able to" in in_a_stay(2, 4, resting).reason


@pytest.mark.parametrize(
    "state",
    [{}, {"O": "here"}, {"A": "start", "O": "here"}, {"O": "here", "A": "start"}, {"A": "start", "v": 0}],
    ids=str,
)
def test_no_block_names_others_than_the_first(state: Dict[str, object]) -> None:
    # Where it holds its command would be given, though no play of the part shows it.
    other = Automaton("O", (Location("here"),), "here", ())
    network = Network(("x",), (("v", 0),), (), (BOT, other))
    assert verify(network, REACH, Strategy((LATER,))).ok
    spare = block(state, (), (ALWAYS, "A", LOSS))
    assert not verify(network, REACH, Strategy((LATER, spare))).ok


def test_blocks_name_automata_in_the_network_s_order() -> None:
    network = Network(("x",), (), (), (BOT, Automaton("O", (Location("here"),), "here", ())))
    whole = block({"A": "start", "O": "here"}, (before("x", 7),), (since("x", 7), "A", GO))
    assert verify(network, REACH, Strategy((whole,))).ok
    turned = block({"O": "here", "A": "start"}, (), (ALWAYS, "A", LOSS))
    assert verify(network, REACH, Strategy((whole, turned))).reason.startswith("other names")


def test_a_command_of_nobody_is_refused() -> None:
    network = Network(("x",), (), (), (BOT, Automaton("O", (Location("here"),), "here", ())))
    nothing = replace(LATER, commands=(Command((since("x", 7),), ()),))
    assert verify(network, REACH, Strategy((nothing,))).reason.startswith("not a joint move")


def test_a_clock_that_nobody_looks_at_any_more_may_say_how_others_start() -> None:
    edges = tuple(Edge("start", "lost", Guard((ClockBound(clock, "==", 3),))) for clock in ("x", "y"))
    bot = Automaton("A", (Location("start"), Location("lost")), "start", edges)
    started = (
        Constraint("x", None, Fraction(0), False),
        Constraint("x", "y", Fraction(0), True),
        Constraint("y", None, Fraction(2), False),
    )
    reader = Edge("here", "here", Guard((ClockBound("x", ">", 1),)), controllable=False)
    network = Network(("x", "y"), (), (), (bot, Automaton("O", (Location("here"),), "here", (reader,))), started)
    late = Strategy((block({"A": "start"}, ((Constraint(None, "y", Fraction(0), True),),)),))
    assert verify(network, Objective(Kind.SAFETY, bad=(("A", "lost"),)), late).ok


# Stages ---------------------------------------------------------------------------------------------------------------


def switched(needed: int) -> Network:
    """A robot that turns a switch, which sets v to 1; one that goes on where v is what is needed; and who listens."""
    turn = Edge("off", "on", sync=Sync("turn", True), assign=(("v", 1),))
    on = Edge("start", "done", Guard((), ((Test("v", needed),),)))
    return Network(
        (),
        (("v", 0),),
        ("turn",),
        (
            Automaton("R", (Location("off"), Location("on")), "off", (turn,)),
            Automaton("A", (Location("start"), Location("done")), "start", (on,)),
            Automaton("M", (Location("m0"), Location("m1")), "m0", (Edge("m0", "m1", sync=Sync("turn", False)),)),
        ),
    )


def in_two_stages(network: Network, value: int, **named: str) -> Strategy:
    """First the switch, then the robot that goes on while v has the value; `named`: whom that stage names as well."""
    turn, on, listening = (automaton.edges[0] for automaton in network.automata)
    first = block({"R": "off", "M": "m0", "v": 0}, ())
    first = replace(first, commands=(Command((ALWAYS,), (Move("R", turn), Move("M", listening))),))
    second = block({**named, "A": "start", "M": "m1", "v": value}, (), (ALWAYS, "A", on))
    return Strategy((first, second), stages=((("M", "m1"),), (("A", "done"),)))


@pytest.mark.parametrize("named", [{}, {"R": "on"}])
def test_a_stage_begins_with_the_values_that_variables_have_by_then_whoever_is_named(named: Dict[str, str]) -> None:
    assert verify(switched(1), REACH, in_two_stages(switched(1), 1, **named)).ok
    assert not verify(switched(0), REACH, in_two_stages(switched(0), 0, **named)).ok


@pytest.mark.parametrize(("edge", "why"), [
    (Edge("here", "here", sync=Sync("turn", False), controllable=False), "takes turn out of the controller's hands"),
    (Edge("here", "here", sync=Sync("turn", True), controllable=False), "sends turn"),
    (Edge("here", "here", sync=Sync("turn", False)), ""),
    (Edge("here", "here", sync=Sync("other", False), controllable=False), ""),
    (Edge("here", "here", assign=(("v", 1),), controllable=False), "sets v"),
])  # fmt: skip
def test_whoever_may_be_noticed_is_not_left_out(edge: Edge, why: str) -> None:
    turns = Strategy(in_two_stages(switched(1), 1).blocks[:1])
    other = Automaton("O", (Location("here"),), "here", (edge,))
    network = replace(switched(1), automata=(*switched(1).automata, other))
    report = verify(network, Objective(Kind.REACH, goal=(("M", "m1"),)), turns)
    assert report.ok == (not why) and why in report.reason


def until_it_is_on(network: Network) -> Strategy:
    """The same stages, where the first one ends when v is 1."""
    strategy = in_two_stages(network, 1)
    return replace(strategy, stages=((("v", "1"),), strategy.stages[1]))


def with_switch(network: Network, *edges: Edge, bound: int = 0) -> Network:
    """The network with another robot that turns the switch; it may stay so long where it is on."""
    on = Location("on", (ClockBound("x", "<=", bound),) if bound else ())
    robot = Automaton("R", (Location("off"), on), "off", edges)
    return replace(network, clocks=("x",), automata=(robot, *network.automata[1:]))


def test_a_stage_ends_with_a_value_that_the_variable_keeps() -> None:
    network = switched(1)
    assert verify(network, REACH, until_it_is_on(network)).ok
    turn = network.automata[0].edges[0]
    back = Edge("on", "off", assign=(("v", 0),), controllable=False)
    undone = with_switch(network, turn, back)
    assert not verify(undone, REACH, until_it_is_on(undone)).ok


def test_a_stage_whose_milestone_nobody_can_reach_is_lost() -> None:
    strategy = until_it_is_on(switched(1))
    idle = replace(strategy.blocks[0], wait=(ALWAYS,), commands=())
    report = verify(switched(1), REACH, replace(strategy, blocks=(idle, *strategy.blocks[1:])))
    assert report.reason.startswith("waits for ever")


def test_no_edge_gives_a_value_that_it_takes_back_at_once() -> None:
    network = switched(1)
    turn = replace(network.automata[0].edges[0], controllable=False)
    places = (Location("off", (ClockBound("x", "<=", 2),)), Location("on"))

    def waiting(*edges: Edge) -> ProofReport:
        game = with_switch(network, *edges)
        game = replace(game, automata=(replace(game.automata[0], locations=places), *game.automata[1:]))
        strategy = until_it_is_on(game)
        idle = replace(strategy.blocks[0], wait=(ALWAYS,), commands=())
        return verify(game, REACH, replace(strategy, blocks=(idle, *strategy.blocks[1:])))

    assert waiting(turn).ok
    assert not waiting(turn, replace(turn, assign=(("v", 1), ("v", 0)))).ok


def test_a_value_is_no_milestone_where_an_invariant_may_forbid_what_gives_it() -> None:
    network = switched(1)
    turn = network.automata[0].edges[0]
    away = Edge("on", "off", Guard((ClockBound("x", ">", 0),)), controllable=False)
    late = with_switch(network, replace(turn, guard=Guard((ClockBound("x", ">=", 5),))), away, bound=3)
    assert "there is no v.1" in verify(late, REACH, until_it_is_on(late)).reason


@pytest.mark.parametrize("name", ["_begin", "_begin0", "_reached"])
def test_no_location_has_the_name_of_those_in_which_stages_begin_and_end(name: str) -> None:
    network = switched(1)
    places = (Location("start"), Location("done"), Location(name))
    automata = tuple(replace(a, locations=places) if a.name == "A" else a for a in network.automata)
    report = verify(replace(network, automata=automata), REACH, in_two_stages(network, 1))
    assert "a name begins with _" in report.reason
