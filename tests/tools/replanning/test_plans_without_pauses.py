"""A new plan where guests may call at any time: it leaves out the same clocks as the first one, and is found soon."""

from __future__ import annotations

from typing import Any, Dict

from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import translate
from pursue_gen.tools.replanning import replan
from pursue_runtime.strategy import Strategy, read_cover
from tests.solving.test_callers import CLOCKS, HOTEL
from tests.tools.replanning.plays import game_of


def request(text: str, **changed: Any) -> Dict[str, Any]:
    """From the beginning, a time unit later, when a guest has called."""
    scenario = parse(text, "hotel.pur", "hotel")
    network = played(translate(scenario), Rules())
    return {
        "format": 1,
        "game": game_of(scenario),
        "locations": {**{a.name: a.initial for a in network.automata}, "obj": "atRisk"},
        "values": dict(network.variables),
        "clocks": {**dict.fromkeys(network.clocks, 2.0), "CguestOne": 0.5, "Cobj": 0.5},
        "ahead": 0.5,
        "excused": [],
        "limit": 1200.0,
        **changed,
    }


def test_the_plan_and_all_of_its_files_leave_the_pauses_out() -> None:
    answer = replan(request(HOTEL))
    assert answer["won"], answer
    for data in (answer["cover"], *answer["strategies"].values()):
        assert tuple(data["left_out_clocks"]) == CLOCKS
    read_cover(answer["cover"])
    assert any(len(Strategy(data)) for data in answer["strategies"].values())


def test_what_can_be_served_no_more_is_said_to_be_so() -> None:
    answer = replan(request(HOTEL.replace("callOne then serveOne within 20", "callOne then serveOne within 3")))
    assert not answer["won"] and "cannot be guaranteed from here" in answer["why"]
