"""Patrols of many places beside other promises, for robots of their own."""

from __future__ import annotations

from dataclasses import replace

from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.options import DEFAULT as OPTIONS
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT, Rules
from pursue_gen.solving.solvers import solved
from pursue_gen.solving.tours_beside import won_beside_tours
from pursue_gen.synthesis.strategy import with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case
from tests.patrols import corridor, game_of

LATE = Rules().reaction

CALL = "objective: if call then answer within 40\n"


def with_a_porter(rooms: int, every: str, more: str = CALL) -> str:
    """Two robots that can do nothing but walk, a third one that answers calls, and a guest who calls."""
    text = corridor(rooms, 2, every)
    place = text.index("agent")
    events = 'event "call"\nevent "answer" location room3 duration 1\n'
    agents, patrol = text[place:].split("objective", 1)
    agents += 'agent "porter" controllable mobile 1 location hall3 can_do answer\n'
    agents += 'agent "guest" mobile 3 location hall2 can_do call\n'
    return f"{text[:place]}{events}{agents}objective{patrol}{more}"


def test_two_robots_patrol_and_a_third_one_answers_calls() -> None:
    text = with_a_porter(12, " every 300")
    scenario = parse(text, "patrol.pur", "patrol")
    won = solved(translate(scenario), scenario_objective(scenario), DEFAULT, OPTIONS)
    assert [tour.robot for tour in won.strategy.tours] == ["bot1", "bot2"]
    assert len(won.strategy.shares) == 3
    assert verify(won.network, won.objective, won.strategy, LATE).ok
    stage = MissionRunner(make_case(scenario, won, SolveRequest(), "random", (), None)[0]).stage
    for seed in range(3):
        mission = simulate_mission(stage, Settings("random", until=400.0), seed)
        assert mission.end == SAFE, mission


def test_whoever_answers_calls_is_not_relied_on_where_it_comes_by_on_a_patrol() -> None:
    network, objective = game_of(with_a_porter(6, " every 162"))
    found = won_beside_tours(network, objective, LATE, OPTIONS)
    assert found is not None and found.strategy.watchers
    first = found.strategy.watchers[0]
    blind = replace(found.strategy, watchers=found.strategy.watchers[1:])
    report = verify(with_automata_of(network, found.strategy), objective, blind, LATE)
    assert not report.ok and first.name in report.reason


def test_who_alone_can_go_on_a_patrol_goes_though_it_could_answer_calls() -> None:
    text = with_a_porter(4, " every 162").replace("by any robot", "by bot1")
    network, objective = game_of(text.replace("mobile 1 location hall1\n", "mobile 1 location hall1 can_do answer\n"))
    found = won_beside_tours(network, objective, LATE, OPTIONS)
    assert found is not None
    assert [tour.robot for tour in found.strategy.tours] == ["bot1"]


def test_who_is_needed_elsewhere_has_no_tour() -> None:
    near = "objective: if guest at room3 then any robot at room3 within 40\n"
    for text in (
        with_a_porter(6, " every 162", near),
        with_a_porter(6, " every 162", ""),
        with_a_porter(3, " every 162"),
    ):
        network, objective = game_of(text)
        assert won_beside_tours(network, objective, LATE, OPTIONS) is None
