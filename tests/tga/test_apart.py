"""Pauses that objectives ask for: the automaton, and random courses against what the sentence says."""

from __future__ import annotations

import random
from typing import Dict, List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import ClockBound, Edge, Guard, Test
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_runtime.observer.automata import Automata
from tests.stories import free_model

FLOOR = """\
poi "hall"
event "look" location hall duration 2 to 5
event "ring" location hall
event "sing" duration 1 to 3
agent "bot1" controllable location hall can_do look, ring
agent "bot2" controllable location hall can_do look, sing
agent "guest" location hall can_do look, ring, sing
objective: {}
"""


def sent(objective: str, agent: str, word: str) -> List[Edge]:
    made = translate(parse(FLOOR.format(objective), "x.pur", "x"))
    return [edge for edge in made.automaton(agent).edges if edge.sent == word]


def test_robots_wait_and_who_is_not_controlled_may_begin_too_soon() -> None:
    pause, free, counts = "Pobj_pause", (Test("Pobj_pause", 0), Test("Pobj_pause", 2)), (Test("Pobj_pause", 1),)
    robots = sent("at_least 9 between look and ring", "bot1", "ring")
    own = ClockBound("Cbot1", ">", 1)
    assert [edge.guard for edge in robots] == [
        Guard((own,), (free,)), Guard((own, ClockBound("Cobj", ">=", 9)), (counts,)),
    ]  # fmt: skip
    guests = sent("at_least 9 between look and ring", "guest", "ring")
    assert guests[2].guard == Guard((ClockBound("Cguest", ">", 1), ClockBound("Cobj", "<", 9)), (counts,))
    assert [edge.assign for edge in guests] == [((pause, 0),), ((pause, 0),), ((pause, 2),)]
    (ends,) = sent("at_least 9 between look and ring", "bot2", "lookDONE")
    assert (pause, 1) in ends.assign and "Cobj" in ends.resets
    again = sent("at_least 9 between ring", "bot1", "ring")
    assert all(edge.assign == ((pause, 1),) and "Cobj" in edge.resets for edge in again)


def test_the_objective_is_lost_when_somebody_has_begun_too_soon() -> None:
    (lost,) = translate(parse(FLOOR.format("at_least 9 between ring"), "x.pur", "x")).automaton("obj").edges
    assert lost == Edge("idle", "lose", Guard(integers=((Test("Pobj_pause", 2),),)), controllable=False)


@pytest.mark.parametrize("objective", ["at_least 9 between ring", "at_least 2.5 between look and sing"])
def test_uppaal_reads_it_back(objective: str) -> None:
    story = parse(FLOOR.format(objective), "x.pur", "x")
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


PAIRS = [("look", "look"), ("ring", "ring"), ("look", "ring"), ("ring", "look"), ("sing", "look"), ("sing", "sing")]


ENDS: Dict[str, str] = {"look": "lookDONE", "sing": "singDONE", "ring": "ring"}


@given(st.sampled_from(PAIRS), st.integers(1, 9), st.integers(0, 10**6))
@settings(max_examples=150)
def test_in_random_courses_robots_keep_it_and_others_break_it(pair: Tuple[str, str], time: int, seed: int) -> None:
    """Beside the same course without the objective: what is possible there, and how long ago the first event ended."""
    first, following = pair
    kept = Automata(free_model(FLOOR.format(f"at_least {time} between {first} and {following}")), 1.0)
    plain = Automata(free_model(FLOOR.format("avoid no agent at hall")), 1.0)
    rng, now, last = random.Random(seed), 0.0, -1e9
    for each in (kept, plain):
        each.start(now)
    for _ in range(40):
        delay = rng.choice((0.05, 0.3, 1.1, 1.1, 2.5, 6.0)) * (0.5 + rng.random())
        now += min([delay, *(left for _, left in plain.bounds(plain.position(now), "robot", "agent"))])
        soon = now - last < time
        both = []
        for agent in ("bot1", "bot2", "guest"):
            for word in plain.model.possible(plain.position(now)):
                free = plain.model.joint_move(plain.position(now), word, agent)
                may = kept.model.joint_move(kept.position(now), word, agent)
                assert bool(may) == bool(free and not (soon and word == following and agent != "guest"))
                both += [(agent, word, may, free)] if may and free else []
        if not both:
            continue
        _, word, may, free = rng.choice(both)
        kept.take(may, now)
        plain.take(free, now)
        move = kept.internal_move(kept.position(now))
        assert bool(move) == (soon and word == following)
        if move:
            kept.take(move, now)
            assert kept.lost()
            break
        last = now if word == ENDS[first] else last
