"""Assumptions in the network: who is assumed to do less has no edges for the rest, and nothing else changes."""

from __future__ import annotations

import random
from typing import List

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import NeverHolds
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.assumptions import without_broken
from pursue_gen.tga.network import ClockBound, Network, Test
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.meaning import holds
from pursue_runtime.model import Position
from pursue_runtime.zones import EPSILON
from tests.assumptions import (
    APART,
    AWAY,
    GOODBYE,
    LEAVES,
    MUSEUM,
    PLAYROOM,
    ROOMS,
    SPACED,
    TWICE,
    UNTOUCHED,
    free_model,
    scenario,
    solved,
)


def network(text: str) -> Network:
    return translate(scenario(text))


def won(text: str) -> bool:
    try:
        return bool(solved(text).strategy.blocks)
    except PursueError as problem:
        assert problem.exit_status == 4
        return False


@pytest.mark.parametrize(
    ("story", "strong", "weak"),
    [
        (PLAYROOM, TWICE, ""),
        (PLAYROOM, SPACED, SPACED.replace("20", "6")),
        (MUSEUM, f"{LEAVES}\n{AWAY}\n{GOODBYE}", f"{LEAVES}\n{GOODBYE}"),
        (MUSEUM, f"{AWAY}\n{LEAVES}\n{GOODBYE}", f"{AWAY}\n{GOODBYE}"),
        (MUSEUM, f"{AWAY}\n{UNTOUCHED}", f"{LEAVES}\n{UNTOUCHED}"),
    ],
)
def test_it_is_won_because_of_the_assumption(story: str, strong: str, weak: str) -> None:
    assert won(story.format(strong)) and not won(story.format(weak))


def test_nothing_changes_but_the_agent_that_it_is_about() -> None:
    with_it, without = network(PLAYROOM.format(TWICE)), network(PLAYROOM.format(""))
    assert [a for a in with_it.automata if a.name != "child"] == [a for a in without.automata if a.name != "child"]
    assert with_it.variables == (*without.variables, ("assume1", 1), ("assume1count", 0))
    assert with_it.clocks == without.clocks and with_it.channels == without.channels


def test_each_time_is_counted_and_one_edge_is_for_missions_in_which_it_is_broken() -> None:
    edges = network(PLAYROOM.format(TWICE)).automaton("child").edges
    assert [(edge.guard.integers, edge.assign) for edge in edges] == [
        (((Test("assume1count", 0),),), (("assume1count", 1),)),
        (((Test("assume1count", 1),),), (("assume1count", 2),)),
        (((Test("assume1", 0),),), ()),
    ]


def test_a_stay_has_an_invariant_and_what_would_last_beyond_it_does_not_begin() -> None:
    visitor = network(MUSEUM.format(f"{LEAVES}\n{GOODBYE}")).automaton("visitor")
    invariants = {location.name: location.invariant for location in visitor.locations}
    assert invariants["gallery"] == (ClockBound("Cassume1", "<=", 30),) and invariants["hall"] == ()
    into = [edge for edge in visitor.edges if edge.target == "gallery" and edge.source.startswith("going_")]
    assert len(into) == 2 and all(edge.resets[-1] == "Cassume1" for edge in into)
    looks = [edge for edge in visitor.edges if edge.sync and edge.sync.channel == "look"]
    assert [edge.guard.clocks[1:] for edge in looks] == [(ClockBound("Cassume1", "<", 24),), ()]
    assert looks[1].guard.integers[-1] == (Test("assume1", 0),)


def test_a_broken_stay_has_no_invariant() -> None:
    visitor = network(MUSEUM.format(f"{LEAVES}\n{GOODBYE}")).automaton("visitor")
    assert without_broken(visitor, {"assume1": 1, "Pvisitor": 2}) is visitor
    free = without_broken(visitor, {"assume1": 0, "Pvisitor": 2})
    assert all(location.invariant == () for location in free.locations if location.name == "gallery")
    assert [place.invariant for place in free.locations[3:]] == [place.invariant for place in visitor.locations[3:]]


def test_uppaal_reads_it_back() -> None:
    text = MUSEUM.format(f"{LEAVES}\n{AWAY}\nassume: visitor waits 5 between look\n{GOODBYE}")
    made = network(text)
    assert read_network(write_network(made, scenario_objective(scenario(text))), "x.xml") == made


ABOUT = {
    "assume: child does spill at_most 2 times": lambda times, ends: len(times) <= 2,
    "assume: child waits 7 between spill": lambda times, ends: all(b - a >= 7 for a, b in zip(times, times[1:])),
}


@given(st.sampled_from(sorted(ABOUT)), st.integers(0, 10**6))
def test_the_network_allows_exactly_the_plays_of_which_it_holds(said: str, seed: int) -> None:
    """Random plays of the network without the assumption, followed in the one with it."""
    kept, free = free_model(PLAYROOM.format(said)), free_model(PLAYROOM.format(""))
    rng, here = random.Random(seed), kept.initial()
    times: List[float] = []
    now = 0.0
    for _ in range(12):
        delay = rng.choice((0.5, 1.25, 3.0, 6.0))
        now, here = now + delay, here.aged(delay)
        plain = Position(here.locations, {v: here.values[v] for v in free.variables}, here.clocks)
        if not free.joint_move(plain, "spill", "child"):
            continue
        moves = kept.joint_move(here, "spill", "child")
        holds_still = ABOUT[said]([*times, now], [])
        assert bool(moves) == holds_still
        if moves:
            times.append(now)
            here = kept.after(moves, here)


@given(st.integers(0, 10**6))
def test_whoever_leaves_in_time_always_can(seed: int) -> None:
    """Random plays of the visitor: he is never in the gallery for longer than assumed, and never stuck there."""
    soon = LEAVES.replace("30", "9")
    model = free_model(MUSEUM.format(f"{soon}\n{AWAY}\n{GOODBYE}"))
    rng, here, inside = random.Random(seed), model.initial(), 0.0
    visitor = model.automaton("visitor")
    for _ in range(25):
        bounds = visitor.invariants[here.locations["visitor"]]
        most = min((bound.bound - here.clocks[bound.left] for bound in bounds), default=5.0)
        delay = rng.choice((0.0, 0.5, 1.0)) * most
        here, inside = here.aged(delay), inside + delay
        words = [w for w in model.possible(here) if w.startswith(("visitor", "look"))]
        if not words and delay >= most - EPSILON and bounds:
            raise AssertionError(f"stuck at {here}")
        if not words:
            continue
        before = here.locations["visitor"]
        moves = model.joint_move(here, rng.choice(words))
        assert moves
        here = model.after(moves, here)
        now = here.locations["visitor"]
        assert now != "store" and "store" not in now
        if "gallery" in before and before in ("gallery", "doing_look_in_gallery"):
            assert inside <= 9 + EPSILON
        if now == "gallery" and before.startswith("going_"):
            inside = 0.0


def test_nobody_sets_off_to_where_a_condition_could_come_to_hold() -> None:
    edges = [e for e in network(ROOMS.format(APART)).automaton("anna").edges if e.target == "going_west_to_east"]
    kept, free = edges
    assert {test.value for test in kept.guard.integers[-1]} == {1, -21}, "ben is at east, or on his way there"
    assert {test.variable for test in kept.guard.integers[-1]} == {"Pben"}
    assert free.guard.integers[-1] == (Test("assume1", 0),)
    assert won(ROOMS.format(APART)) and not won(ROOMS.format(""))


NEVER_HELD = [
    APART,
    "assume: not (anna at east and ben on_way)",
    "assume: not (anna doing sing and ben at west)",
    "assume: not (loud is_true and ben at west)",
    "assume: not (ben at west or (anna at east and loud is_true))",
    "assume: not (not anna at west and not ben at east)",
]


@pytest.mark.parametrize("said", NEVER_HELD)
@given(seed=st.integers(0, 10**6))
@settings(max_examples=15)
def test_a_condition_that_is_assumed_never_to_hold_never_does_and_nobody_is_stuck(said: str, seed: int) -> None:
    """Random plays of all agents, with times."""
    story, model = scenario(ROOMS.format(said)), free_model(ROOMS.format(said))
    (assumption,) = story.assumptions
    assert isinstance(assumption, NeverHolds)
    rng, here = random.Random(seed), model.initial()
    for _ in range(40):
        assert not holds(assumption.condition, story, here.locations, here.values), here
        agents = [model.automaton(agent.name) for agent in story.agents]
        most = min(
            (b.bound - here.clocks[b.left] for a in agents for b in a.invariants[here.locations[a.name]]), default=5.0
        )
        here = here.aged(rng.choice((0.5, 1.0)) * most)
        words = [word for word in model.possible(here) if not word.startswith("obj")]
        if not words:
            assert most > EPSILON, f"stuck at {here}"
            continue
        moves = model.joint_move(here, rng.choice(words))
        assert moves
        here = model.after(moves, here)
