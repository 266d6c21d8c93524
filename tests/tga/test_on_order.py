"""What people order: an automaton whose events no game has, and one for each order that is taken."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network

TEA = """\
poi "kitchen"
poi "room"
connect kitchen and room distance 5
event "tea" on_order{}
event "serve" location room duration 3
agent "bot" controllable mobile 1 location kitchen can_do serve
objective: if tea then serve within {}{}
"""


def test_nothing_is_ordered_in_a_game_so_whatever_is_asked_for_is_kept() -> None:
    won = solve_scenario(parse(TEA.format("", 0.5, ""), "x.pur", "x"), DEFAULT)
    assert not any(block.commands for block in won.strategy.blocks)


def test_the_desk_is_the_environments_and_opens_for_one_event() -> None:
    network = translate(parse(TEA.format(" at_most 2 times", 60, ", at_most 3 open"), "x.pur", "x"))
    (edge,) = network.automaton("order_desk").edges
    tests = [sorted((test.variable, test.value) for test in clause) for clause in edge.guard.integers]
    assert tests == [[("order_desk_open", 1)], [("Ptea_count", 0), ("Ptea_count", 1)],
                     [("Pobj", 0), ("Pobj", 1), ("Pobj", 2)]]  # fmt: skip
    assert not edge.controllable and edge.assign == (("order_desk_open", 0),)
    assert dict(network.variables)["order_desk_open"] == 0


@pytest.mark.parametrize(("more", "idle"), [("", ["obj"]), (", at_most 2 open", ["obj", "obj2"])])
def test_where_something_is_to_be_achieved_what_was_ordered_is_answered_first(more: str, idle: List[str]) -> None:
    story = parse(TEA.format("", 60, more) + 'event "call"\nreach_objective: do serve\n', "x.pur", "x")
    goal = scenario_objective(story).goal
    assert goal == (("reachObj", "win"), *((name, "idle") for name in idle))
    assert solve_scenario(story, DEFAULT).strategy.blocks
    asked = parse(TEA.format("", 60, more).replace(" on_order", ""), "x.pur", "x")
    assert scenario_objective(asked).goal == ()


def test_a_scenario_without_orders_has_no_desk() -> None:
    text = TEA.format("", 60, "").replace(" on_order", "").replace("can_do serve", "can_do serve, tea")
    assert "order_desk" not in {automaton.name for automaton in translate(parse(text, "x.pur", "x")).automata}


@pytest.mark.parametrize("more", ["", " at_most 2 times"])
def test_uppaal_reads_it_back(more: str) -> None:
    story = parse(TEA.format(more, 60, ""), "x.pur", "x")
    network = translate(story)
    assert read_network(write_network(network, scenario_objective(story)), "x.xml") == network
