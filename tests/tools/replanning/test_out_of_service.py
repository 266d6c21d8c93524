"""Plans that send nothing to robots that are out of service."""

from __future__ import annotations

from typing import Any, Dict, List

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.replanning import replan
from tests.tools.replanning.plays import game_of

TWO = """\
poi "hall"
poi "east"
connect hall and east distance 10
event "ring" location hall
event "answer" location hall duration 3
agent "nurse" location hall can_do ring
agent "bot1" controllable mobile 1 location hall can_do answer
agent "bot2" controllable mobile 1 location east can_do answer
objective: if ring then answer within 60
"""

GOAL = """\
poi "hall"
event "greet" location hall
event "wave" location hall
agent "bot1" controllable mobile 1 location hall can_do greet
agent "bot2" controllable mobile 1 location hall can_do wave
reach_objective: do greet
objective: avoid wave
"""

HANDING = """\
poi "hall"
poi "east"
connect hall and east distance 10
event "ring" location hall
event "hand_over" collaborative location hall
agent "nurse" location hall can_do ring
agent "bot1" controllable mobile 1 location hall can_do hand_over
agent "bot2" controllable mobile 1 location east reacts_to hand_over
agent "bot3" controllable mobile 1 location hall reacts_to hand_over
objective: if ring then hand_over within 60
"""


def asked(text: str, out: List[str], **places: str) -> Dict[str, Any]:
    """The planner's answer to a request from the start, where agents are elsewhere."""
    scenario = parse(text, "two.pur", "two")
    return replan({**request_of(scenario), **moved(scenario, places), "out_of_service": out, "window": 2.0}, 20_000)


def request_of(scenario: Scenario) -> Dict[str, Any]:
    network = solve_scenario(scenario, Rules()).network
    return {
        "format": 1, "game": game_of(scenario), "values": dict(network.variables),
        "locations": {automaton.name: automaton.initial for automaton in network.automata},
        "clocks": dict.fromkeys(network.clocks, 1.0), "ahead": 0.0, "excused": [],
    }  # fmt: skip


def moved(scenario: Scenario, places: Dict[str, str]) -> Dict[str, Any]:
    request, network = request_of(scenario), solve_scenario(scenario, Rules()).network
    values = dict(request["values"])
    for name, place in places.items():
        codes = {edge.target: dict(edge.assign).get(f"P{name}") for edge in network.automaton(name).edges}
        values[f"P{name}"] = codes[place]
    return {"locations": {**request["locations"], **places}, "values": values}


def commands(answer: Dict[str, Any]) -> Dict[str, List[str]]:
    """What the plan commands whom, anywhere."""
    assert answer["won"], answer["why"]
    found: Dict[str, List[str]] = {}
    for each in answer["strategies"].values():
        for block in each["strategy"]:
            for command in block["commands"]:
                found.setdefault(command["agent"], []).append(command["do"])
    return found


def test_the_others_keep_what_is_promised() -> None:
    assert set(commands(asked(TWO, ["bot2"]))) == {"bot1"}
    assert set(commands(asked(TWO, ["bot1"]))) == {"bot2"}


def test_who_is_under_way_ends_that_and_gets_no_command() -> None:
    assert set(commands(asked(TWO, ["bot2"], bot2="going_east_to_hall"))) == {"bot1"}
    assert set(commands(asked(TWO, ["bot2"], bot2="doing_answer_in_hall"))) == {"bot1"}


def test_a_refusal_says_what_can_be_kept_no_more() -> None:
    answer = asked(TWO, ["bot1", "bot2"])
    assert not answer["won"]
    assert answer["why"] == (
        "'objective: if ring then answer within 60' cannot be kept while {bot1} is out of service and while {bot2} is "
        "out of service"
    )


def test_a_refusal_names_what_is_to_be_reached_where_that_is_lost_by_itself() -> None:
    answer = asked(GOAL, ["bot1"])
    assert answer["why"] == "'reach_objective: do greet' cannot be kept while {bot1} is out of service"


def test_nobody_begins_what_a_robot_out_of_service_would_take_part_in() -> None:
    found = commands(asked(HANDING, ["bot2"]))
    assert "hand_over" in found["bot1"] and "bot2" not in found  # with bot3
    answer = asked(HANDING, ["bot3"])
    assert not answer["won"] and "if ring then hand_over within 60" in answer["why"]  # bot3 would be there, too
    assert "bot2" in commands(asked(HANDING, ["bot3"], bot3="east"))


def test_a_robot_cannot_leave_where_somebody_may_do_something_with_it() -> None:
    text = HANDING.replace("can_do ring", "can_do ring, hand_over")
    answer = asked(text, ["bot3"])
    assert answer["why"] == "{nurse} may do {hand_over} with {bot3} where it stands"
    assert asked(text, ["bot2"])["won"]  # it is elsewhere


def test_only_agents_are_out_of_service() -> None:
    with pytest.raises(PursueError, match="bot7 is out_of_service"):
        asked(TWO, ["bot7"])


ROUNDS = """\
poi "c"
poi "d"
connect c and d distance 2
agent "bot3" controllable mobile 1 location c
agent "bot4" controllable mobile 1 location d
objective: patrol c, d every 40 by bot3 or bot4
"""


def test_at_the_limit_of_a_search_a_refusal_names_what_is_lost_by_itself() -> None:
    request = {**request_of(parse(TWO + ROUNDS, "two.pur", "two")), "window": 2.0}
    why = replan({**request, "out_of_service": ["bot1", "bot2"]}, 1)["why"]
    assert why.startswith("'objective: if ring then answer within 60' cannot be kept while {bot1} is out of service")


def test_at_the_limit_of_a_search_a_refusal_says_that_no_plan_was_found() -> None:
    request = {**request_of(parse(TWO, "two.pur", "two")), "window": 2.0}
    why = replan({**request, "out_of_service": ["bot2"]}, 1)["why"]
    assert why == "no plan was found within the limits of a search while {bot2} is out of service"
