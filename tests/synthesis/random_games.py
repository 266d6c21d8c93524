"""Random small games, for engines to agree on."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from math import ceil
from typing import List, Tuple

from hypothesis import strategies as st

from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game
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
    Test,
)
from tests.choices import member_of

PLACES = ("l0", "l1", "l2")


@st.composite
def networks(draw: st.DrawFn, kinds: Tuple[Kind, ...], most_clocks: int = 2) -> Tuple[Network, Objective]:
    """Two automata over one or two clocks, a channel and a variable; small constants.

    The first automaton has most of the controller's edges, the second most of the environment's; so that a fair part of
    the games is won.
    """
    clocks = ("x", "y")[: draw(st.integers(1, most_clocks))]
    network = Network(clocks, (("v", 0),), ("a",), tuple(_automaton(draw, clocks, number) for number in range(2)))
    kind = draw(member_of(kinds))
    return network, draw(objectives(kind))


@st.composite
def objectives(draw: st.DrawFn, kind: Kind) -> Objective:
    """What is wanted of two automata: for a good part of the games several locations to reach at once, or to avoid."""
    goal, bad = (("A0", "l2"),), (("A0" if kind is Kind.SAFETY else "A1", "l2"),)
    more = draw(member_of(("", "", "", "goal", "bad", "both")))
    if more in ("goal", "both"):
        goal += (("A1", draw(member_of(("l0", "l1")))),)
    if more in ("bad", "both"):
        bad += ((("A1" if kind is Kind.SAFETY else "A0"), "l1"),)
    return Objective(kind, goal, bad)


@st.composite
def started(draw: st.DrawFn, kinds: Tuple[Kind, ...], most_clocks: int = 2) -> Tuple[Network, Objective]:
    """The same, started somewhere in the middle: any locations, a zone of clocks."""
    network, objective = draw(networks(kinds, most_clocks))
    automata = tuple(
        replace(automaton, initial=draw(member_of(PLACES[:2])), home="l0") for automaton in network.automata
    )
    bounds = _start(draw, network.clocks)
    return replace(network, variables=(("v", draw(st.integers(0, 1))),), automata=automata, start=bounds), objective


def _start(draw: st.DrawFn, clocks: Tuple[str, ...]) -> Tuple[Constraint, ...]:
    """Bounds that are around one of a few points, some of them beyond the constants of the games."""
    point = {clock: Fraction(draw(member_of((0, 1, 2, 3, 4, 5, 7, 8, 9, 10, 13))), 4) for clock in clocks}
    bounds: List[Constraint] = []
    for left, right in permutations((None, *clocks), 2):
        value = point.get(left or "", Fraction(0)) - point.get(right or "", Fraction(0))
        room = draw(st.integers(0, 3))
        if room < 3:
            top = Fraction(ceil(value)) + max(0, room - 1)
            bounds.append(Constraint(left, right, top, strict=value < top and draw(st.booleans())))
    return tuple(bounds) or (Constraint(None, clocks[0], Fraction(0), False),)


@st.composite
def games(draw: st.DrawFn, kinds: Tuple[Kind, ...], delays: Tuple[int, ...]) -> Game:
    """The same, with a delay of so many units, as tables."""
    network, objective = draw(networks(kinds))
    return compile_game(network, objective, Fraction(draw(member_of(delays))))


def _automaton(draw: st.DrawFn, clocks: Tuple[str, ...], number: int) -> Automaton:
    locations = []
    for place in PLACES:
        bounded = draw(st.integers(0, 2)) == 0
        bound = ClockBound(draw(member_of(clocks)), "<=", draw(st.integers(1, 4)))
        locations.append(Location(place, (bound,) if bounded else ()))
    count = draw(st.integers(3, 6) if number == 0 else st.integers(1, 4))
    edges = tuple(_edge(draw, clocks, mostly=number == 0, source=PLACES[k % 2]) for k in range(count))
    return Automaton(f"A{number}", tuple(locations), "l0", edges)


def _edge(draw: st.DrawFn, clocks: Tuple[str, ...], mostly: bool, source: str) -> Edge:
    role = draw(member_of(("tau", "a!", "a?", "tau")))
    bounds: List[ClockBound] = []
    if role != "a?":
        if draw(st.booleans()):
            lower = draw(member_of((">", ">=")))
            bounds.append(ClockBound(draw(member_of(clocks)), lower, draw(st.integers(0, 2))))
        if draw(st.integers(0, 2)) == 0:
            upper = draw(member_of(("<", "<=", "==")))
            bounds.append(ClockBound(draw(member_of(clocks)), upper, draw(st.integers(1, 4))))
    clauses = ((Test("v", draw(st.integers(0, 1))),),) if draw(st.integers(0, 3)) == 0 else ()
    return Edge(
        source=source,
        target=draw(member_of(PLACES)),
        guard=Guard(tuple(bounds), clauses),
        sync=None if role == "tau" else Sync("a", role == "a!"),
        assign=(("v", draw(st.integers(0, 1))),) if draw(st.integers(0, 3)) == 0 else (),
        resets=tuple(clock for clock in clocks if draw(st.integers(0, 2)) == 0),
        controllable=draw(st.integers(0, 3)) > 0 if mostly else draw(st.integers(0, 3)) == 0,
    )
