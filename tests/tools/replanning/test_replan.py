"""A new plan from wherever a mission has come to: won where it can be, else a sentence says what cannot be met."""

from __future__ import annotations

import importlib
import json
import sys
from typing import Any, Dict, List, Optional

import pytest
import yaml

from pursue_gen.partition import partition
from pursue_gen.partition.strategy_data import render
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import played
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Strategy, read_cover
from pursue_runtime.zones import holds
from tests.tools.replanning.plays import asked, beginning, busy, ended, game_of, solved, walk

THESIS = [f"thesis/{name}" for name in ("scenario_1", "scenario_2", "scenario_3", "scenario_4", "catch_the_thief")]
WON = [*THESIS, "work_cell/work_cell", "warehouse/goods_lift", "warehouse/traffic_light"]


def won(request: Dict[str, Any]) -> Dict[str, Any]:
    answer = replan(request)
    assert answer["won"], (answer, request["locations"], request["clocks"])
    return answer


def why(request: Dict[str, Any]) -> str:
    answer = replan(request)
    assert answer["format"] == 1 and answer["won"] is False and set(answer) == {"format", "won", "why"}
    text: str = answer["why"]
    assert "\n" not in text
    return text


@pytest.mark.parametrize("name", WON)
def test_from_every_place_of_a_play_there_is_a_plan(name: str) -> None:
    places = 0
    for seed in range(2):
        for state, clocks in walk(name, seed, 30):
            won(asked(name, state, clocks))
            places += 1
    assert places >= 10


@pytest.mark.parametrize("name", THESIS)
def test_from_every_place_where_somebody_was_early_or_late_there_is_a_plan(name: str) -> None:
    places = 0
    for state, clocks in walk(name, 7, 30):
        request = asked(name, state, clocks)
        for agent in busy(request["locations"]) if len(busy(request["locations"])) == 1 else ():
            now = request["clocks"][f"C{agent}"]
            for at in (now + 0.5, now + 5, now + 400):
                won(ended(name, request, agent, at))
                places += 1
    assert places > 2


@pytest.mark.parametrize("name", THESIS)
def test_the_plan_knows_what_to_do_where_it_begins(name: str) -> None:
    for state, clocks in walk(name, 3, 8):
        request = asked(name, state, clocks, ahead=0.0)
        answer = won(request)
        there = SystemState(5, 0.0, request["locations"], request["values"], request["clocks"])
        zones = [zone for covered in read_cover(answer["cover"]).find(there) for zone in covered.zones]
        at_goal = request["locations"].get("reachObj") == "win"
        assert at_goal or any(holds(zone, request["clocks"], 1e-6) for zone in zones)
        for data in answer["strategies"].values():
            Strategy(data)


def test_the_answer_holds_what_the_files_of_a_workspace_hold() -> None:
    answer = won(beginning("thesis/scenario_1"))
    assert answer == json.loads(json.dumps(answer))
    assert list(answer) == ["format", "won", "strategies", "people", "cover", "takes"]
    assert list(answer["strategies"]) == ["controller_bot1", "controller_bot2", "controllerObj"]
    assert answer["people"] is None
    for name, data in answer["strategies"].items():
        assert (data["format"], data["controller"], data["reaction"]) == (1, name, 0.1)
    assert answer["cover"]["format"] == 3 and answer["cover"]["cover"]


@pytest.mark.parametrize("name", ["thesis/scenario_1", "thesis/scenario_3", "thesis/catch_the_thief"])
def test_the_time_of_a_plan_holds_from_wherever_it_may_come_into_force(name: str) -> None:
    known = 0
    for state, clocks in list(walk(name, 3, 30))[::4]:
        request = asked(name, state, clocks, ahead=1.0)
        answer = replan(request)
        takes = answer.get("takes")
        if takes is None:
            continue
        known += 1
        assert takes["early"] in (0.0, 1.0) and takes["late"] > 0.0
        for delay in (-takes["early"], 0.0, takes["late"]):
            later = {clock: value + 1.0 + delay for clock, value in request["clocks"].items()}
            most = latest({**request, "clocks": later, "ahead": 0.0}, request)
            assert most is None or most <= takes["most"] + 1e-9, (delay, state, clocks)
    assert known > 0
    assert "takes" not in replan(beginning(name), states=100_000), "simulated missions need none"


def latest(now: Dict[str, Any], planned: Dict[str, Any]) -> Optional[float]:
    """In how many time units the plan of one request comes to the goal at worst from the place of another; None where
    it does not win from there."""
    request = read_request(planned)
    objective = scenario_objective(request.scenario)
    game = played(translate(request.scenario), request.rules)
    network = network_from(game, request)
    verdict = solve(network, objective, request.rules.reaction)
    assert verdict.strategy is not None
    strategy = prove(network, objective, verdict.strategy, request.rules.reaction, verdict.ranks)
    there = network_from(game, read_request(now))
    found = worst_case(there, objective, strategy, request.rules.reaction, 500)
    return None if found is None else float(found)


def test_people_get_their_part() -> None:
    scenario, _ = solved("thesis/scenario_1")
    text = scenario.text.replace('"bot2" controllable', '"bot2" human controllable')
    request = beginning("thesis/scenario_1")
    answer = won({**request, "game": {**request["game"], "scenario": text}})
    assert list(answer["strategies"]) == ["controller_bot1", "controllerObj"]
    assert answer["people"]["commands_agents"] == ["bot2"]


@pytest.mark.parametrize(
    ("shape", "reach_obj", "names"),
    [("centralized", "dedicated", ["controller"]), ("distributed", "bot1", ["controller_bot1", "controller_bot2"])],
)
def test_controllers_are_shaped_as_in_the_workspace(shape: str, reach_obj: str, names: List[str]) -> None:
    scenario, _ = solved("thesis/scenario_1")
    request = beginning("thesis/scenario_1", game=game_of(scenario, controllers=shape, reach_obj=reach_obj))
    assert list(won(request)["strategies"]) == names


def test_the_original_s_game_is_planned_again_as_well() -> None:
    scenario, _ = solved("thesis/scenario_1")
    rules = {"ends": "controllable", "reaction": 0, "slack": {}}
    answer = won(beginning("thesis/scenario_1", game=game_of(scenario, rules=rules, controllers="general")))
    (data,) = answer["strategies"].values()
    assert any("_going_" in command["do"] for entry in data["strategy"] for command in entry["commands"])


def test_the_same_request_gives_the_same_answer() -> None:
    request = beginning("thesis/scenario_2")
    assert json.dumps(replan(request)) == json.dumps(replan(request))


# Who cannot be counted on.


def test_without_a_robot_that_is_needed_there_is_no_plan() -> None:
    text = why(beginning("thesis/scenario_1", excused=["bot1"]))
    assert text == "'reach_objective: do bot2_ina after 0' cannot be guaranteed from here without relying on {bot1}"
    assert "without relying on {bot1} and {bot2}" in why(beginning("thesis/scenario_1", excused=["bot2", "bot1"]))


def test_without_a_robot_that_is_not_needed_there_is_a_plan_that_leaves_it_alone() -> None:
    answer = won(beginning("thesis/catch_the_thief", excused=["polBot1"]))
    assert not answer["strategies"]["controller_polBot1"]["strategy"]
    assert answer["strategies"]["controller_polBot2"]["strategy"]


def test_a_robot_that_failed_on_its_way_may_come_at_any_time_or_never() -> None:
    name = "thesis/scenario_1"
    places = [asked(name, *place) for place in walk(name, 1, 12)]
    on_its_way = next(request for request in places if request["locations"]["bot1"].startswith("going_"))
    won(on_its_way)
    assert "without relying on {bot1}" in why({**on_its_way, "excused": ["bot1"]})


def test_who_is_excused_but_no_longer_needed_does_not_matter() -> None:
    name = "thesis/scenario_1"
    done = [asked(name, *place) for place in walk(name, 1, 40)]
    later = [r for r in done if r["values"]["Prule1"] != 0 and r["locations"]["bot1"] == "b"]
    assert later, "rule1 is past bot1's part"
    won({**later[0], "excused": ["bot1"]})


def test_a_robot_that_is_late_may_stay_for_ever() -> None:
    name = "thesis/scenario_1"
    places = [asked(name, *place) for place in walk(name, 1, 12)]
    request = next(r for r in places if busy(r["locations"]) == ("bot1",))
    text = why({**request, "ahead": 100.0})
    assert text.endswith("cannot be guaranteed from here without relying on {bot1}")


# What is over, and what takes too long.


def test_a_mission_that_is_won_needs_nothing() -> None:
    request = beginning("thesis/scenario_1")
    answer = won({**request, "locations": {**request["locations"], "reachObj": "win"}})
    assert not any(data["strategy"] for data in answer["strategies"].values())


def test_a_mission_that_is_lost_is_said_to_be() -> None:
    request = beginning("work_cell/work_cell")
    assert why({**request, "locations": {**request["locations"], "obj": "lose"}}) == (
        "the mission is lost already: 'objective: if newBox then putDownBox within 30' is broken"
    )


def test_a_deadline_that_has_passed_is_named() -> None:
    request = beginning("work_cell/work_cell")
    locations = {**request["locations"], "obj": "atRisk"}
    text = why({**request, "locations": locations, "clocks": {**request["clocks"], "Cobj": 5000.0}})
    assert text.startswith("'objective: ") and text.endswith("' cannot be met any more: its time is over")


def test_of_several_objectives_the_one_whose_deadline_has_passed_is_named() -> None:
    request = beginning("hotel/two_bells")
    locations = {**request["locations"], "obj2": "atRisk"}
    text = why({**request, "locations": locations, "clocks": {**request["clocks"], "Cobj2": 5000.0}})
    assert text == "'objective: if ringWest then serveWest within 20' cannot be met any more: its time is over"


def test_a_plan_that_takes_too_long_is_none() -> None:
    assert why(beginning("thesis/scenario_4", limit=1e-5)) == "no plan was found within 1e-05 s"


def test_a_plan_that_takes_too_much_memory_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules[replan.__module__], "careful_memory", lambda: 1)
    text = why(beginning("thesis/scenario_4"))
    assert text.startswith("no plan was found: no verdict within the limit of 1 MiB of memory")


def test_what_the_file_of_the_game_says_is_what_is_asked_with() -> None:
    from tests.workspace.worlds import files

    game = yaml.safe_load(files("thesis/scenario_2")["src/observer/config/game.yaml"])
    scenario, _ = solved("thesis/scenario_2")
    played = game.pop("plan")
    assert game == game_of(scenario) and set(played) == {"sha256"}
    game["plan"] = played
    assert won(beginning("thesis/scenario_2", game=game))


def test_the_data_of_an_answer_is_what_render_writes() -> None:
    scenario, solution = solved("thesis/scenario_1")
    network: Network = solution.network
    state = tuple(a.initial for a in network.automata), tuple(value for _, value in network.variables)
    answer = won(asked("thesis/scenario_1", state, [0] * len(network.clocks)))
    for sub in partition(solution.strategy, network, scenario.agents):
        assert yaml.safe_load(render(sub, "s", "0", solution.reaction)) == answer["strategies"][sub.controller]


def test_with_a_limit_on_states_neither_time_nor_memory_of_the_machine_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    request = beginning("thesis/scenario_4", limit=1e-5)
    monkeypatch.setattr(importlib.import_module("pursue_gen.tools.replanning.replan"), "careful_memory", lambda: 1)
    assert replan(request, states=12_000) == replan(beginning("thesis/scenario_4"), states=12_000)
    assert replan(request, states=12_000)["won"]
    assert replan(request, states=10)["why"] == "no plan was found within the limits of a search"
    assert not replan(request)["won"]


@pytest.mark.parametrize(("since", "in_time"), [(2.2, True), (2.4, False)])
def test_plans_know_the_decimals_of_a_scenario(since: float, in_time: bool) -> None:
    """The porter is a time unit on its way, and the parcel is due 13.6 after the call."""
    request = beginning("hotel/parcel", ahead=0.0)
    request["locations"].update(porter="going_desk_to_door2", obj="atRisk", order="order1s", call_count="call_count_1")
    request["values"].update(Porder=2, Pporter=-12, Pcall_count=1)
    request["clocks"].update(Cporter=1.0, Cguest=since, Cobj=since)
    assert replan(request)["won"] == in_time
