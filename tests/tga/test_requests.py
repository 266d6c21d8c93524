"""Requests that come again while others wait: the automata, and random courses against what the sentence says."""

from __future__ import annotations

import random
from typing import List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_runtime.observer.automata import Automata
from tests.plays import Play
from tests.stories import free_model, scenario

SHOP = """\
poi "desk"
poi "shelf"
connect desk and shelf distance 1
event "order"
event "pack" location shelf
agent "bot" controllable mobile 1 location shelf can_do pack
agent "shop" location desk can_do order
agent "phone" location desk can_do order
objective: if order then pack within {}, at_most {} open
"""


def made(within: float, most: int) -> Network:
    return translate(parse(SHOP.format(within, most), "x.pur", "x"))


def test_each_that_may_be_open_has_an_automaton_with_a_clock() -> None:
    network = made(9, 3)
    watching = [network.automaton(name) for name in ("obj", "obj2", "obj3")]
    assert [each.clocks for each in watching] == [{"Cobj"}, {"Cobj2"}, {"Cobj3"}]
    assert {name: value for name, value in network.variables if "obj" in name} == {"Pobj": 0, "Pobj_oldest": 0}
    assert scenario_objective(parse(SHOP.format(9, 3), "x.pur", "x")).bad == tuple((a.name, "lose") for a in watching)


def test_nobody_asks_while_as_many_are_open_as_may_be() -> None:
    for agent in ("shop", "phone"):
        edges = [edge for edge in made(9, 2).automaton(agent).edges if edge.sent == "order"]
        asked = [[(test.variable, test.value) for test in clause] for edge in edges for clause in edge.guard.integers]
        assert asked == [[("Pobj", 0), ("Pobj", 1)], [("assume1", 0)]]


@pytest.mark.parametrize("most", [1, 2, 3, 5])
def test_uppaal_reads_it_back(most: int) -> None:
    story = parse(SHOP.format(2.5, most), "x.pur", "x")
    network = translate(story)
    assert read_network(write_network(network, scenario_objective(story)), "x.xml") == network


@given(st.integers(1, 5), st.integers(1, 12), st.integers(0, 10**6))
@settings(max_examples=150)
def test_in_random_courses_the_oldest_is_answered_and_each_in_time(most: int, within: int, seed: int) -> None:
    model, rng, now = free_model(SHOP.format(within, most)), random.Random(seed), 0.0
    watched = Automata(model, 1.0)
    waiting: List[float] = []
    watched.start(now)
    names = ["obj", *(f"obj{number}" for number in range(2, most + 1))]
    for _ in range(60):
        now += rng.choice((0.1, 0.6, 1.1, 1.1, 2.5)) * (0.5 + rng.random())
        if waiting and now - waiting[0] > within:
            limits = [left for name, left in watched.bounds(watched.position(now), "safety") if name in names]
            assert min(limits) < 0, "the oldest has waited too long"
            break
        here = watched.position(now)
        assert sorted(round(now - since, 6) for since in waiting) == sorted(
            round(here.clocks[f"C{name}"], 6) for name in names if here.locations[name] == "atRisk"
        )
        possible: List[Tuple[str, str]] = [
            (agent, word)
            for agent, word in (("shop", "order"), ("phone", "order"), ("bot", "pack"))
            if model.joint_move(here, word, agent)
        ]
        asks = [agent for agent in ("shop", "phone") if here.clocks[f"C{agent}"] > 1 and len(waiting) < most]
        assert [agent for agent, word in possible if word == "order"] == asks
        if not possible:
            continue
        agent, word = rng.choice(possible)
        move = model.joint_move(here, word, agent)
        assert move is not None
        watched.take(move, now)
        if word == "order":
            waiting.append(now)
        else:
            waiting = waiting[1:]


@given(st.integers(1, 4), st.integers(0, 10**6))
@settings(max_examples=60)
def test_in_random_plays_no_more_are_open(most: int, seed: int) -> None:
    Play(scenario(SHOP.format(50, most))).run(40, seed)  # tests.course says how many are open
