"""Scenarios from short texts, and random networks."""

from __future__ import annotations

from typing import List, Tuple

from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective, Sync, Test
from tests.choices import member_of

REFERENCES = ("CT1", "CT2a", "CT3a", "CT3b", "CT4", "CT5", "EB1", "EB2", "EB2x", "EB3", "EB4", "WC1", "WC2a")
"""The published scenarios."""

REACH = Objective(Kind.REACH, goal=(("reachObj", "win"),))
SAFETY = Objective(Kind.SAFETY, bad=(("obj", "lose"),))
BOTH = Objective(Kind.REACH_WHILE_SAFE, goal=(("reachObj", "win"),), bad=(("obj", "lose"),))

CLOCKS = ("x", "y")
VARIABLES = ("p", "q")
CHANNELS = ("go", "stop")
NAMES = ("idle", "busy", "base", "A1")


def scenario(text: str) -> Scenario:
    """The scenario of a text."""
    return parse(text, "test.pur", "test")


_BOUNDS = st.lists(
    st.builds(ClockBound, st.sampled_from(CLOCKS), st.sampled_from(("<", "<=", ">", ">=", "==")), st.integers(0, 40)),
    max_size=2,
).map(tuple)
_CLAUSE = st.lists(st.builds(Test, st.sampled_from(VARIABLES), st.integers(-120, 20)), max_size=3).map(tuple)
_CLAUSES = st.lists(_CLAUSE, max_size=2).map(tuple)
_SYNCS = st.none() | st.builds(Sync, st.sampled_from(CHANNELS), st.booleans())
_ASSIGNMENTS = st.lists(st.tuples(st.sampled_from(VARIABLES), st.integers(-120, 20)), max_size=2).map(tuple)
_RESETS = st.lists(st.sampled_from(CLOCKS), max_size=2, unique=True).map(tuple)
_INVARIANTS = st.lists(
    st.builds(ClockBound, st.sampled_from(CLOCKS), st.sampled_from(("<", "<=")), st.integers(0, 40)), max_size=2
).map(tuple)
"""Parts of networks, made but once: see tests/choices.py."""


def _guards(draw: st.DrawFn, with_clocks: bool) -> Guard:
    clocks: Tuple[ClockBound, ...] = draw(_BOUNDS) if with_clocks else ()
    return Guard(clocks, draw(_CLAUSES))


@st.composite
def _edges(draw: st.DrawFn, locations: List[str]) -> Edge:
    places = member_of(locations)
    sync = draw(_SYNCS)
    return Edge(
        draw(places),
        draw(places),
        _guards(draw, with_clocks=sync is None or sync.sends),
        sync,
        draw(_ASSIGNMENTS),
        draw(_RESETS),
        draw(st.booleans()),
    )


@st.composite
def _automata(draw: st.DrawFn, name: str) -> Automaton:
    names = draw(st.lists(member_of(NAMES), min_size=1, unique=True))
    locations = tuple(Location(location, draw(_INVARIANTS), draw(st.booleans())) for location in names)
    edges = draw(st.lists(_edges(names), max_size=4).map(tuple))
    return Automaton(name, locations, draw(member_of(names)), edges)


@st.composite
def networks(draw: st.DrawFn) -> Network:
    """Small networks; nameless locations of different automata may have one name."""
    names = draw(st.lists(member_of(("one", "two", "three")), min_size=1, unique=True))
    values = st.integers(-120, 20)
    variables = tuple((variable, draw(values)) for variable in VARIABLES)
    return Network(CLOCKS, variables, CHANNELS, tuple(draw(_automata(name)) for name in names))
