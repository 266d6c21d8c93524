"""Networks that begin in the middle of a play, in any of several states."""

from __future__ import annotations

from fractions import Fraction

from pursue_gen.tga.begin import BEGIN, BEGUN, beginning_in
from pursue_gen.tga.network import Automaton, ClockBound, Constraint, Location, Network

ROBOT = Automaton("bot", (Location("a"), Location("on_way", (ClockBound("c", "<=", 4),))), "a", ())
CART = Automaton("cart", (Location("b"), Location("at_work", (ClockBound("d", "<", 7),))), "b", ())
NETWORK = Network(("c", "d"), (("v", 0),), (), (ROBOT, CART))


def late(clock: str, bound: int, strict: bool) -> Constraint:
    """How much a clock may be at first."""
    return Constraint(clock, None, Fraction(bound), strict)


def test_it_begins_in_one_of_the_states_with_the_values_of_variables() -> None:
    begun = beginning_in(NETWORK, [(("a", "b"), (1,)), (("on_way", "b"), (2,))])
    first = begun.automaton(BEGIN)
    assert [(edge.target, edge.assign, edge.controllable) for edge in first.edges] == [
        (BEGUN, (("v", 1),), False), (BEGUN, (("v", 2),), False)
    ]  # fmt: skip
    channels = [edge.sync.channel for edge in first.edges if edge.sync is not None]
    led = {edge.sync.channel: edge.target for edge in begun.automaton("bot").edges if edge.sync is not None}
    assert [led[channel] for channel in channels] == ["a", "on_way"]


def test_no_clock_is_later_than_all_states_allow() -> None:
    """Else no state could be begun in, and time would stand still for ever."""
    begun = beginning_in(NETWORK, [(("on_way", "at_work"), (0,)), (("on_way", "b"), (0,))])
    assert begun.start == (late(BEGIN, 0, False), late("c", 4, False))
    busy = beginning_in(NETWORK, [(("on_way", "at_work"), (0,))])
    assert busy.start == (late(BEGIN, 0, False), late("c", 4, False), late("d", 7, True))
    assert beginning_in(NETWORK, [(("a", "b"), (0,)), (("on_way", "b"), (0,))]).start == (late(BEGIN, 0, False),)
