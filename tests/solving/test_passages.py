"""Robots that change places: whole scenarios, from the text to what is played."""

from __future__ import annotations

import functools
import re
from fractions import Fraction

import pytest

from benchmarks.ordinary_families import pass_in_a_corridor, pass_in_a_square
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.partition.strategy_data import cover_data
from pursue_gen.proof.checker import verify
from pursue_gen.proof.worst_case import answer_times
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.passages import crowd_of, won_by_passages
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT, IDEAL, played
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.solvers import solved
from pursue_gen.solving.verdict import verdict_json
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.replay.game import Source, game_of
from pursue_gen.tools.report.strategy_data import size, strategy_data_of
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import read_cover


@functools.lru_cache(maxsize=None)
def won(text: str, ideal: bool = False) -> Solution:
    scenario = parse(text, "passing.pur", "passing")
    return solved(translate(scenario), scenario_objective(scenario), IDEAL if ideal else DEFAULT)


@pytest.mark.parametrize("robots", [4, 5, 8, 12])
def test_robots_that_pass_each_other_in_a_corridor(robots: int) -> None:
    found = won(pass_in_a_corridor(robots))
    assert found.strategy.passages
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok


def test_places_and_ways_that_hold_one_robot_are_passed_like_robots_that_never_meet() -> None:
    apart = pass_in_a_corridor(5)
    lines = [line for line in apart.split("\n") if "never_with" not in line]
    every = won("\n".join([*lines, "objective: every place holds 1 robot", "objective: every way holds 1 robot"]))
    room = list(lines)
    room += [f"objective: place {place} holds 1 robot" for place in re.findall(r'poi "(\w+)"', apart)]
    room += [f"objective: way {a} to {b} holds 1 robot" for a, b in re.findall(r"connect (\w+) and (\w+)", apart)]
    one, other = won(apart), won("\n".join(room))
    assert other.strategy.passages == one.strategy.passages
    assert other.guarantee == one.guarantee
    assert every.strategy.passages == one.strategy.passages and every.guarantee == one.guarantee


def test_robots_go_to_and_fro_on_shared_lanes() -> None:
    lines = [line for line in pass_in_a_corridor(4).split("\n") if "never_with" not in line and "reach" not in line]
    lines = [re.sub(r"(can_do work(\d))", r"\1, home\2", line) for line in lines]
    agents = next(number for number, line in enumerate(lines) if line.startswith("agent"))
    homes = [f'event "home{n}" location room{n} duration 4' for n in range(1, 5)]
    turns = [f'rule "turn{n}": work{n} before home{n}' for n in range(1, 5)]
    lines[agents:agents] = [*homes, *turns]
    lines += ["objective: every place holds 1 robot", "objective: every way holds 1 robot"]
    lines += [f"reach_objective: do home{n} 5 times" for n in range(1, 5)]
    found = won("\n".join(lines))
    assert found.strategy.passages and found.guarantee is not None and found.guarantee.worst is not None
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok


def test_who_is_there_already_does_its_work_first_and_makes_way() -> None:
    text = """
poi "a"
poi "b"
poi "c"
connect a and b distance 2
connect b and c distance 2
event "first" location b duration 2
event "second" location a duration 2
agent "bot1" controllable mobile 1 location b can_do first
agent "bot2" controllable mobile 1 location c can_do second
objective: every place holds 1 robot
objective: every way holds 1 robot
reach_objective: do first
reach_objective: do second
"""
    scenario = parse(text, "line.pur", "line")
    network, objective = played(translate(scenario), DEFAULT), scenario_objective(scenario)
    crowd = crowd_of(network, objective)
    assert crowd is not None
    assert won_by_passages(network, objective, crowd, DEFAULT.reaction, SolveOptions()) is None  # no room to pass
    wider = text.replace("connect b and c", 'poi "d"\nconnect b and d distance 2\nconnect b and c')
    scenario = parse(wider, "line.pur", "line")
    network, objective = played(translate(scenario), DEFAULT), scenario_objective(scenario)
    crowd = crowd_of(network, objective)
    assert crowd is not None
    assert won_by_passages(network, objective, crowd, DEFAULT.reaction, SolveOptions()) is not None


PATROL = """
poi "room1"
poi "room2"
poi "room3"
poi "hall1"
poi "hall2"
poi "hall3"
poi "nook"
connect hall1 and hall2 distance 4
connect hall2 and hall3 distance 4
connect room1 and hall1 distance 4
connect room2 and hall3 distance 4
connect room3 and hall2 distance 4
connect nook and hall2 distance 4
agent "bot1" controllable mobile 1 location room1
agent "bot2" controllable mobile 1 location room2
agent "bot3" controllable mobile 1 location room3
agent "bot4" controllable mobile 1 location hall2
objective: every place holds 1 robot
objective: every way holds 1 robot
objective: patrol room1, room2 EVERY by bot4
objective: patrol room1, room2, room3, nook EVERY by any robot
"""


def test_robots_on_patrols_make_way_for_each_other_for_ever() -> None:
    found = won(PATROL.replace("EVERY", "every 400"))
    assert found.strategy.passages
    assert all(passage.again for passage in found.strategy.passages)
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok
    answers = answer_times(found.network, found.objective, found.strategy, found.reaction)
    assert max(answers.values()) < 400
    network = played(translate(parse(PATROL.replace("EVERY", "every 400"), "p.pur", "p")), DEFAULT)
    text = write_plan(found.strategy, network, found.objective)
    assert " -- Passage again: room1 " in text
    assert read_plan(text, network, "plan.txt") == found.strategy


def test_the_period_of_a_patrol_where_robots_make_way_is_found() -> None:
    scenario = settled(parse(PATROL.replace("EVERY", ""), "patrol.pur", "patrol"), SolveRequest())
    (every,) = {patrol.every for patrol in scenario.patrols}
    found = solved(translate(scenario), scenario_objective(scenario), DEFAULT)
    assert every is not None
    assert max(answer_times(found.network, found.objective, found.strategy, found.reaction).values()) < every


def test_missions_of_patrols_where_robots_make_way() -> None:
    scenario = parse(PATROL.replace("EVERY", "every 400"), "patrol.pur", "patrol")
    case = make_case(scenario, won(scenario.text), SolveRequest(), "random", (), None)[0]
    stage = MissionRunner(case).stage
    missions = [simulate_mission(stage, Settings("random", until=900), number) for number in range(1, 6)]
    assert not [mission for mission in missions if mission.problems]
    assert {mission.end for mission in missions} == {"safe"}, missions


def test_on_a_square_robots_move_at_the_same_time() -> None:
    found = won(pass_in_a_square(8))
    assert found.guarantee is not None
    # The longest single way: six legs of at most 6, a rest and a reaction each, and the work.
    assert found.guarantee.worst is not None
    assert found.guarantee.worst <= Fraction(3, 2) * (6 * Fraction(71, 10) + Fraction(61, 10))


def test_the_ideal_game_is_won_as_well() -> None:
    found = won(pass_in_a_corridor(4), ideal=True)
    assert found.strategy.passages
    assert found.guarantee is not None
    default = won(pass_in_a_corridor(4)).guarantee
    assert default is not None
    assert default.worst is not None
    assert found.guarantee.worst is not None
    assert found.guarantee.worst < default.worst


def test_the_plan_is_read_as_it_was_written() -> None:
    found = won(pass_in_a_corridor(4))
    scenario = parse(pass_in_a_corridor(4), "passing.pur", "passing")
    network = played(translate(scenario), DEFAULT)
    text = write_plan(found.strategy, network, found.objective)
    assert " -- Passage: hall1 bot1 " in text
    again = read_plan(text, network, "plan.txt")
    assert again == found.strategy
    assert read_plan(text, found.network, "plan.txt") == found.strategy
    assert verify(network, found.objective, again, found.reaction).ok


def test_the_network_with_the_orders_is_written_and_read() -> None:
    found = won(pass_in_a_corridor(4))
    again = read_network(write_network(found.network, found.objective), "TGA.xml")
    assert again.automata[-1].name.endswith("_passage")
    plan = write_plan(found.strategy, found.network, found.objective)
    assert verify(again, found.objective, read_plan(plan, again, "plan.txt"), found.reaction).ok


@pytest.mark.parametrize(
    "line, why",
    [("hall1", "which the network cannot have"), ("hall1 bot9", "cannot have"), ("room1 bot2 bot1", "cannot have")],
)
def test_a_plan_with_another_passage_is_refused(line: str, why: str) -> None:
    found = won(pass_in_a_corridor(4))
    network = played(translate(parse(pass_in_a_corridor(4), "p.pur", "p")), DEFAULT)
    text = write_plan(found.strategy, network, found.objective)
    broken = text.replace(text[text.index(" -- Passage:") :].split("\n")[0], f" -- Passage: {line}")
    with pytest.raises(PursueError, match=why):
        read_plan(broken, network, "plan.txt")


def test_missions_reach_the_goal_within_the_guarantee() -> None:
    scenario = parse(pass_in_a_corridor(4), "passing.pur", "passing")
    found = won(pass_in_a_corridor(4))
    runner = MissionRunner(make_case(scenario, found, SolveRequest(), "random", (), None)[0])
    missions = [simulate_mission(runner.stage, Settings("random"), number) for number in range(1, 11)]
    assert [mission.end for mission in missions] == ["goal"] * 10, missions


def test_a_recorded_mission_is_replayed_with_its_plan() -> None:
    text = pass_in_a_corridor(4)
    game = game_of(Source("passing", text, "passing.pur", DEFAULT))
    assert game.orders is not None
    assert game.network.automata[-1].name.endswith("_passage")


def test_each_agent_has_an_entry_in_every_state() -> None:
    found = won(pass_in_a_corridor(4))
    cover = read_cover(cover_data(found.strategy))
    locations = {automaton.name: automaton.initial for automaton in found.network.automata}
    state = SystemState(0, 0.0, locations, dict(found.network.variables), dict.fromkeys(found.network.clocks, 0.0))
    assert cover.zones(state)
    assert not cover.zones(replace_location(state, "bot1", "nowhere"))


def replace_location(state: SystemState, name: str, location: str) -> SystemState:
    return SystemState(0, 0.0, {**state.locations, name: location}, state.values, state.clocks)


def test_the_report_shows_the_steps_of_each_agent() -> None:
    scenario = parse(pass_in_a_corridor(4), "passing.pur", "passing")
    found = won(pass_in_a_corridor(4))
    data = strategy_data_of(scenario, found, "dedicated")
    assert data.ordered
    assert sorted(part.who for part in data.parts) == [("bot1",), ("bot2",), ("bot3",), ("bot4",), ("reachObj",)]
    assert size(data)[1] == sum(len(block.commands) for block in found.strategy.blocks)


def test_who_walks_about_in_the_corridor_is_not_passed_so() -> None:
    text = pass_in_a_corridor(4) + '\nagent "guest" mobile 2 location hall5\nobjective: bot1 never_with guest\n'
    scenario = parse(text, "passing.pur", "passing")
    network, objective = played(translate(scenario), DEFAULT), scenario_objective(scenario)
    crowd = crowd_of(network, objective)
    assert crowd is not None
    assert len(crowd.robots) == 4
    assert won_by_passages(network, objective, crowd, DEFAULT.reaction, SolveOptions()) is None


def test_somebody_who_does_not_matter_may_walk_about() -> None:
    text = pass_in_a_corridor(4) + '\nagent "guest" mobile 2 location hall5\n'
    found = won(text)
    assert found.strategy.passages
    assert all(name != "guest" for block in found.strategy.blocks for name, _ in block.state.locations)


def test_robots_with_rules_that_come_round_again() -> None:
    text = """
poi "yard"
poi "dock"
poi "rack"
poi "bay1"
poi "bay2"
connect yard and dock distance 2
connect yard and rack distance 3
connect yard and bay1 distance 1
connect yard and bay2 distance 1
event "fetch" location rack duration 2
event "hand" location dock duration 2
rule "order": fetch before hand
agent "bot1" controllable mobile 1 location rack can_do hand
agent "bot2" controllable mobile 1 location dock can_do fetch
objective: bot1 never_with bot2
reach_objective: do hand
"""
    scenario = parse(text, "passing.pur", "passing")
    network, objective = played(translate(scenario), DEFAULT), scenario_objective(scenario)
    crowd = crowd_of(network, objective)
    assert crowd is not None
    found = won_by_passages(network, objective, crowd, DEFAULT.reaction, SolveOptions())
    assert found is not None
    assert verify(network, objective, found, DEFAULT.reaction).ok


def test_objectives_that_orders_of_passage_keep_do_matter() -> None:
    text = pass_in_a_corridor(4) + '\nagent "guest" mobile 2 location hall5\n'
    found = won(text)
    assert verdict_json(DEFAULT, found)["left_out"] == ["guest"]
    assert strategy_data_of(parse(text, "passing.pur", "passing"), found, "dedicated").left_out == ("guest",)


ON_CALL = """unit second
poi "n1" poi "n2" poi "n3" poi "n4" poi "roomA" poi "roomB" poi "roomC" poi "dockA" poi "dockB" poi "dockC"
connect n1 and n2 distance 8 m connect n2 and n3 distance 8 m
connect n3 and n4 distance 8 m connect n4 and n1 distance 8 m
connect n1 and roomA distance 5 m connect n2 and roomB distance 5 m
connect n3 and roomC distance 5 m connect n4 and dockA distance 4 m
connect n4 and dockB distance 4 m connect n1 and dockC distance 4 m
event "call" location roomA
event "bring" location roomA duration 10 s
event "load" location roomC duration 10 s
rule "order": load before bring
agent "r1" controllable speed 0.5 location dockA
agent "r2" controllable speed 0.5 location dockB can_do load, bring
agent "nurse" speed 1 location roomA can_do call
objective: patrol roomA, roomB every 10 min by r1
objective: if call then bring within 10 min
objective: every place holds 1 robot
objective: every way holds 1 robot
"""


def test_a_robot_on_call_makes_way_for_one_on_patrol_but_not_to_where_that_one_goes() -> None:
    """It went aside into the room that the other one was on its way to, and neither could go on."""
    found = won(ON_CALL)
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok
