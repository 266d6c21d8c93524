"""A new plan for several robots with promises of their own: in shares, where the game in one piece is far too large."""

from __future__ import annotations

from typing import Any, Dict

from benchmarks.lab_scenarios import lab_scenario
from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import translate
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replanning.replan import _objectives
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Strategy, read_cover
from tests.tools.replanning.plays import game_of

LAB = lab_scenario(17)
"""Three robots: one answers orders, one patrols, all of them are to be where a person comes to."""

STATES = 20_000
"""The game in one piece has more than 500,000."""


def request(text: str, since: float) -> Dict[str, Any]:
    """From where everybody began, when somebody has ordered; so many time units later, as the robot has not set off."""
    scenario = parse(text, "lab.pur", "lab")
    network = played(translate(scenario), Rules())
    locations = {automaton.name: automaton.initial for automaton in network.automata}
    ordered = network.automaton("obj5")
    (at_risk,) = (edge for edge in ordered.edges if edge.source == ordered.initial and edge.target != ordered.initial)
    clocks = {**dict.fromkeys(network.clocks, since + 2.0), **dict.fromkeys(at_risk.resets, since)}
    return {
        "format": 1,
        "game": game_of(scenario),
        "locations": {**locations, "obj5": at_risk.target},
        "values": dict(network.variables),
        "clocks": clocks,
        "ahead": 1.0,
        "excused": [],
        "limit": 1200.0,
    }


def test_the_plan_is_in_shares_and_knows_what_to_do_where_it_begins() -> None:
    asked = request(LAB, 5.0)
    answer = replan(asked, STATES)
    assert answer["won"], answer
    cover = read_cover(answer["cover"])
    there = SystemState(5, 0.0, asked["locations"], asked["values"], {c: t + 1.0 for c, t in asked["clocks"].items()})
    assert len(cover.find(there)) >= 3, "each share has a block of its own"
    assert sum(len(Strategy(data)) > 0 for data in answer["strategies"].values()) == 3


def test_what_is_too_late_is_named_once() -> None:
    answer = replan(request(LAB, 60.0), STATES)
    assert not answer["won"]
    assert answer["why"] == "'objective: if order3 then drop3 within 47' cannot be met any more: its time is over"


def test_a_statement_with_several_places_is_named_once() -> None:
    scenario = parse(LAB, "lab.pur", "lab")
    assert len(scenario.safety) == 6
    assert _objectives(scenario).count("patrol room4, room2, hall2") == 1
