"""Scenarios from short texts, and random networks."""

from __future__ import annotations

from typing import List, Tuple

from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective, Sync, Test

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


def _guards(draw: st.DrawFn, with_clocks: bool) -> Guard:
    ops = st.sampled_from(("<", "<=", ">", ">=", "=="))
    bounds = st.builds(ClockBound, st.sampled_from(CLOCKS), ops, st.integers(0, 40))
    clauses = st.lists(st.builds(Test, st.sampled_from(VARIABLES), st.integers(-120, 20)), max_size=3).map(tuple)
    clocks: Tuple[ClockBound, ...] = draw(st.lists(bounds, max_size=2).map(tuple)) if with_clocks else ()
    return Guard(clocks, draw(st.lists(clauses, max_size=2).map(tuple)))


@st.composite
def _edges(draw: st.DrawFn, locations: List[str]) -> Edge:
    places = st.sampled_from(locations)
    sync = draw(st.none() | st.builds(Sync, st.sampled_from(CHANNELS), st.booleans()))
    return Edge(
        draw(places),
        draw(places),
        _guards(draw, with_clocks=sync is None or sync.sends),
        sync,
        draw(st.lists(st.tuples(st.sampled_from(VARIABLES), st.integers(-120, 20)), max_size=2).map(tuple)),
        draw(st.lists(st.sampled_from(CLOCKS), max_size=2, unique=True).map(tuple)),
        draw(st.booleans()),
    )


@st.composite
def _automata(draw: st.DrawFn, name: str) -> Automaton:
    names = draw(st.lists(st.sampled_from(NAMES), min_size=1, unique=True))
    invariants = st.builds(ClockBound, st.sampled_from(CLOCKS), st.sampled_from(("<", "<=")), st.integers(0, 40))
    locations = tuple(
        Location(location, draw(st.lists(invariants, max_size=2).map(tuple)), draw(st.booleans())) for location in names
    )
    edges = draw(st.lists(_edges(names), max_size=4).map(tuple))
    return Automaton(name, locations, draw(st.sampled_from(names)), edges)


@st.composite
def networks(draw: st.DrawFn) -> Network:
    """Small networks; nameless locations of different automata may have one name."""
    names = draw(st.lists(st.sampled_from(("one", "two", "three")), min_size=1, unique=True))
    values = st.integers(-120, 20)
    variables = tuple((variable, draw(values)) for variable in VARIABLES)
    return Network(CLOCKS, variables, CHANNELS, tuple(draw(_automata(name)) for name in names))
