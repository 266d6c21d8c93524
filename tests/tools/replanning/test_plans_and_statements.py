"""New plans keep to conditions, own turns and limits, and rely on no assumption that has been broken."""

from __future__ import annotations

import functools
from typing import Any, Dict, List, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.tga import translate
from pursue_gen.tga.network import Network
from pursue_gen.tools.replanning import replan
from tests.assumptions import AWAY, CAFE, MUSEUM, ONCE, PLAYROOM, TWICE, UNTOUCHED
from tests.tools.replanning.plays import game_of

CARTS = """\
poi "hall"
poi "plane"
connect hall and plane distance 2 only_if gate is_true
event "open" at_most 1 times
event "close" at_most 1 times
event "load" location hall duration 1 only_if no robot at plane
event "unload" location plane
state "gate": initially false, true_if open false_if close
rule "bag" for each robot: load before unload
agent "cart1" controllable mobile 1 location hall can_do load, unload
agent "cart2" controllable mobile 1 location hall can_do load, unload, open
agent "wind" location hall can_do close
assume: wind does close at_most 0 times
reach_objective: do unload
"""
"""Each cart unloads what it has loaded itself; a gate has to be open when one sets off."""

AT_HALL, AT_PLANE = 1, 2


@functools.lru_cache(maxsize=None)
def made(text: str) -> Tuple[Scenario, Network]:
    scenario = parse(text, "story.pur", "story")
    return scenario, played(translate(scenario), DEFAULT)


def asked(text: str, where: Dict[str, str], values: Dict[str, int], excused: List[str]) -> Dict[str, Any]:
    """The answer to a request from there; everything else is as at the start, five time units ago."""
    scenario, network = made(text)
    return replan({
        "format": 1, "game": game_of(scenario), "ahead": 0.0, "excused": excused, "limit": 1200.0,
        "locations": {each.name: where.get(each.name, each.initial) for each in network.automata},
        "values": {**dict(network.variables), **values}, "clocks": dict.fromkeys(network.clocks, 5.0),
    })  # fmt: skip


def events(answer: Dict[str, Any], agent: str) -> List[str]:
    """What the agent is ever commanded to do."""
    assert answer["won"], answer
    parts = (entry for part in answer["strategies"].values() for entry in part["strategy"])
    return sorted({command["do"] for entry in parts for command in entry["commands"] if command["agent"] == agent})


GATE_OPEN = {"Sgate": 1, "Popen_count": 1}


def opened() -> Dict[str, str]:
    """The gate has been opened, which can happen once."""
    return {"open_count": "open_count_1"}


def test_who_has_loaded_unloads_and_nobody_for_him() -> None:
    answer = asked(CARTS, opened(), {**GATE_OPEN, "Pbag_cart1": 2}, [])
    assert answer["won"]
    lost = asked(CARTS, opened(), {**GATE_OPEN, "Pbag_cart1": 2}, ["cart1"])
    assert events(lost, "cart2") == ["cart2_hall2plane", "load", "unload"] and events(lost, "cart1") == []


def test_who_carries_a_thing_gives_it_and_nobody_for_him() -> None:
    boxes = CARTS.replace('rule "bag" for each robot: load before unload\n', 'thing "box"\n')
    boxes = boxes.replace("hall duration 1", "hall duration 1 takes box")
    boxes = boxes.replace("location plane", "location plane gives box")
    assert "load" not in events(asked(boxes, opened(), {**GATE_OPEN, "Hcart1": 1, "Hcart2": 1}, []), "cart1")
    lost = asked(boxes, opened(), {**GATE_OPEN, "Hcart1": 1}, ["cart1"])
    assert events(lost, "cart2") == ["cart2_hall2plane", "load", "unload"] and events(lost, "cart1") == []


def test_what_a_lost_robot_keeps_from_happening_is_no_part_of_a_plan() -> None:
    there = {**opened(), "cart1": "plane"}
    values = {**GATE_OPEN, "Pcart1": AT_PLANE}
    assert not asked(CARTS, there, values, ["cart1"])["won"], "cart2 cannot load while it stands at the plane"
    assert asked(CARTS, there, values, [])["won"], "it goes away"
    answer = asked(CARTS, there, {**values, "Pbag_cart2": 2}, ["cart1"])
    assert events(answer, "cart2") == ["cart2_hall2plane", "unload"], "and does not matter once cart2 has loaded"


def test_what_has_happened_as_often_as_it_can_is_no_part_of_a_plan() -> None:
    answer = asked(CARTS, opened(), {"Popen_count": 1}, [])
    assert not answer["won"], "the gate is shut, and has been opened before"
    assert asked(CARTS, {}, {}, [])["won"]


@pytest.mark.parametrize(
    ("text", "wins"),
    [
        (CARTS, False),  # the wind may shut the gate as soon as it is open
        (CAFE.format(ONCE), True),
        (PLAYROOM.format(TWICE), False),
        (MUSEUM.format(f"{AWAY}\n{UNTOUCHED}"), False),
    ],
)
def test_a_plan_relies_on_no_assumption_that_is_broken(text: str, wins: bool) -> None:
    assert asked(text, {}, {}, [])["won"]
    answer = asked(text, {}, {"assume1": 0}, [])
    assert answer["won"] is wins, answer
