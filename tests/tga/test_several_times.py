"""`do e 3 times at_least 9 apart`: the automaton, and random courses against what the sentence says."""

from __future__ import annotations

import random
from typing import List

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import ClockBound, Edge, Guard, Sync
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_runtime.observer.automata import Automata
from tests.stories import free_model

FLOOR = """\
poi "hall"
event "look" location hall duration 1 to 3
event "ring" location hall
agent "bot1" controllable location hall can_do look, ring
agent "bot2" controllable location hall can_do look
reach_objective: do {}
"""


def edges(words: str) -> List[Edge]:
    return list(translate(parse(FLOOR.format(words), "x.pur", "x")).automaton("reachObj").edges)


def test_each_time_has_a_place_and_one_where_it_is_too_soon() -> None:
    ring = Sync("ring", False)
    start = Edge("initial_location", "unlocked", Guard((ClockBound("Creach", ">", 0),)))
    assert edges("ring twice") == [
        start, Edge("unlocked", "did_1_times", sync=ring), Edge("did_1_times", "win", sync=ring),
    ]  # fmt: skip
    assert edges("ring twice at_least 9 apart") == [
        start,
        Edge("unlocked", "did_1_times_apart", sync=ring, resets=("Capart",)),
        Edge("did_1_times_apart", "did_1_times", Guard((ClockBound("Capart", ">=", 9),))),
        Edge("did_1_times", "win", sync=ring),
    ]
    assert sum(edge.target == "late" for edge in edges("ring twice at_least 9 apart within 30")) == 4


@pytest.mark.parametrize("words", ["look 3 times", "look twice at_least 9 apart after 2 within 30"])
def test_uppaal_reads_it_back(words: str) -> None:
    story = parse(FLOOR.format(words), "x.pur", "x")
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


@given(st.sampled_from(("look", "ring")), st.integers(1, 4), st.sampled_from((0, 1, 3, 8)), st.integers(0, 10**6))
@settings(max_examples=100)
def test_it_is_reached_with_the_last_time_that_counts(event: str, times: int, apart: int, seed: int) -> None:
    """Where the controller makes its step as soon as it can."""
    words = f"{event} {times} times" + f" at_least {apart} apart" * (apart > 0 and times > 1) + " after 2"
    automata, rng, now, counted = Automata(free_model(FLOOR.format(words)), 1.0), random.Random(seed), 0.0, [-1e9]
    model = automata.model
    automata.start(now)
    for _ in range(40):
        delay = rng.choice((0.3, 1.1, 1.1, 2.5, 6.0)) * (0.5 + rng.random())
        now += min([delay, *(left for _, left in automata.bounds(automata.position(now), "robot"))])
        possible = model.possible(automata.position(now))
        for step in (word for word in possible if word.startswith("reachObj")):
            moves = model.joint_move(automata.position(now), step)
            assert moves
            automata.take(moves, now)
        others = [word for word in possible if not word.startswith("reachObj")]
        if not others:
            continue
        word = rng.choice(others)
        doers = [name for name in ("bot1", "bot2") if model.joint_move(automata.position(now), word, name)]
        moves = model.joint_move(automata.position(now), word, rng.choice(doers))
        assert moves
        automata.take(moves, now)
        happens = word == {"look": "lookDONE", "ring": "ring"}[event]
        counted += [now] if happens and now > 2 and now - counted[-1] >= apart else []
        assert automata.is_won() == (len(counted) > times)
        if automata.is_won():
            break
