"""Patrols with tours when a mission does not go as planned: robots go on with their tours from where they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Dict, Optional, Sequence, Tuple

import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.network_names import LOSE, going
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.checker import verify
from pursue_gen.solving.options import DEFAULT as OPTIONS
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.tours import won_by_tours
from pursue_gen.solving.tours_again import is_too_much
from pursue_gen.solving.tours_beside import won_beside_tours
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.plan_parts import follower_lines
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.tours import Tour
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from, start_clocks
from pursue_gen.tools.replanning.tours import tours_from_here
from pursue_gen.tools.simulation.faults import Crash
from pursue_gen.tools.simulation.mission import START, SimulatedMission
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.model import Model, Position
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import read_cover
from tests.patrols import corridor, game_of, small_patrols, tours_of
from tests.solving.test_tours_beside import with_a_porter
from tests.tools.replanning.plays import game_of as game_data

LATE = Rules().reaction
NONE = 1
"""So few states that the game in one piece decides nothing."""

LITTLE = Limits(states=600, work=300_000)


def there(text: str, own: Strategy, position: Position, **changed: Any) -> Dict[str, Any]:
    """A request from this position."""
    request = {
        "format": 1,
        "game": game_data(parse(text, "patrol.pur", "patrol"), follows=follower_lines(own)),
        **position._asdict(),
        "ahead": 1.0,
        "excused": [],
    }
    return {**request, **changed}


def model_of(text: str, network: Network, objective: Objective, own: Strategy) -> Model:
    """The model of a workspace with this strategy."""
    scenario = parse(text, "patrol.pur", "patrol")
    return Model(model_data(with_automata_of(network, own), objective, scenario, LATE))


def walked(model: Model, own: Strategy, robot: str, steps: int, takes: float, position: Position) -> Position:
    """Where this robot comes to when it has begun and ended its next movements in turn, each after so much time."""
    tour = next(tour for tour in own.tours if tour.robot == robot)
    for _ in range(steps):
        position = position.aged(takes)
        here, stop = position.locations[robot], position.locations[tour.name]
        if here.startswith("going_"):
            (edge,) = model.automaton(robot).edges_from(here)
        else:
            following = tour.after([tour.at(k) for k in range(len(tour.stops))].index(stop))
            if following is None:
                return position
            target = going(here, tour.stops[following])
            (edge,) = (each for each in model.automaton(robot).edges_from(here) if each.target == target)
        moves = model.joint_move(position, edge.word, robot, timed=False)
        assert moves is not None
        position = model.after(moves, position)
    return position


CORRIDOR = corridor(6, 2, " every 81")


def test_a_robot_that_was_not_commanded_in_time_goes_on_with_its_tour() -> None:
    network, objective, own = tours_of(CORRIDOR)
    model = model_of(CORRIDOR, network, objective, own)
    for steps, late in ((0, 20.0), (1, 0.5), (2, 6.0), (5, 0.5)):
        position = walked(model, own, "bot1", steps, 3.0, model.initial()).aged(late)
        answer = replan(there(CORRIDOR, own, position), NONE)
        assert answer["won"], answer
        cover = read_cover(answer["cover"])
        for passed in (0.0, 1.0, 5.9):  # it may come into force before it is expected, or after that
            now = position.aged(passed)
            state = SystemState(5, 0.0, now.locations, now.values, now.clocks)
            assert len(cover.find(state)) == 2, "each robot has a block of its own"


def test_whoever_passes_the_place_of_another_is_not_relied_on_either() -> None:
    text = corridor(6, 2, " every 120", "hall1, room1, hall2, room2, hall3, room3, hall5, room5, hall6, room6")
    text = text.replace("location hall4", "location hall1")
    network, objective, own = tours_of(text)
    assert own.watchers
    model = model_of(text, network, objective, own)
    position = walked(model, own, "bot1", 4, 3.0, walked(model, own, "bot2", 4, 3.0, model.initial())).aged(5.0)
    assert replan(there(text, own, position), NONE)["won"]


def test_robots_go_on_with_their_tours_beside_one_that_answers_calls() -> None:
    text = with_a_porter(12, " every 400")
    network, objective = game_of(text)
    found = won_beside_tours(network, objective, LATE, OPTIONS)
    assert found is not None
    own, model = found.strategy, model_of(text, network, objective, found.strategy)
    for steps, late in ((0, 20.0), (1, 0.5), (2, 6.0)):
        position = walked(model, own, "bot1", steps, 3.0, model.initial()).aged(late)
        request = read_request(there(text, own, position))
        on = tours_from_here(network, objective, own, request, OPTIONS)
        assert on is not None, (steps, late)
        strategy, here = on
        assert {tour.robot for tour in strategy.tours} == {"bot1", "bot2"} and "porter" in strategy.commanded
        assert verify(with_automata_of(here, strategy), objective, strategy, LATE).ok
    gone = read_request(there(text, own, model.initial().aged(20.0), excused=["bot1"]))
    assert tours_from_here(network, objective, own, gone, OPTIONS) is None
    gone = read_request(there(text, own, model.initial().aged(20.0), excused=["porter"]))
    assert tours_from_here(network, objective, own, gone, OPTIONS) is None


def test_what_is_too_late_for_all_robots_is_known_at_once() -> None:
    network, objective, own = tours_of(CORRIDOR)
    model = model_of(CORRIDOR, network, objective, own)
    answer = replan(there(CORRIDOR, own, model.initial().aged(70.0)), NONE)
    assert not answer["won"] and answer["why"].endswith("cannot be guaranteed from here")


def test_one_robot_alone_cannot_do_what_takes_two() -> None:
    network, objective, own = tours_of(CORRIDOR)
    model = model_of(CORRIDOR, network, objective, own)
    position = walked(model, own, "bot1", 1, 3.0, model.initial()).aged(20.0)
    answer = replan(there(CORRIDOR, own, position, excused=["bot1"]), NONE)
    assert not answer["won"] and answer["why"].endswith("cannot be guaranteed from here without relying on {bot1}")


def test_who_is_off_its_tour_does_not_go_on_with_it() -> None:
    network, objective, own = tours_of(CORRIDOR)
    model = model_of(CORRIDOR, network, objective, own)
    astray = replace(own, tours=(Tour("bot1", ("hall1", "hall2")), *own.tours[1:]))
    position = walked(model, astray, "bot1", 1, 3.0, model.initial())
    assert position.locations["bot1_tour"] == LOSE
    answer = replan(there(CORRIDOR, own, position), NONE)
    assert not answer["won"] and "no plan was found" in answer["why"]


@pytest.mark.parametrize(
    "follows", [7, [3], [" -- Tour: bot1 0 hall1 room1"], [" -- Watcher: obj7 bot1"], ["Tour"]]
)
def test_tours_that_the_game_cannot_have_are_refused(follows: Any) -> None:
    network, objective, own = tours_of(CORRIDOR)
    request = there(CORRIDOR, own, model_of(CORRIDOR, network, objective, own).initial())
    request["game"]["follows"] = follows
    if follows == ["Tour"]:  # a line that says nothing of tours
        assert not replan(request, NONE)["won"]
        return
    with pytest.raises(PursueError, match="follows") as caught:
        replan(request, NONE)
    assert caught.value.exit_status == 2


def test_a_watcher_that_has_begun_later_than_its_objective_is_refused() -> None:
    text = corridor(6, 2, " every 120", "hall1, room1, hall2, room2, hall3, room3, hall5, room5, hall6, room6")
    text = text.replace("location hall4", "location hall1")
    network, objective, own = tours_of(text)
    model = model_of(text, network, objective, own)
    position = model.initial().aged(4.0)
    watcher = next(w for w in own.watchers if position.locations[w.name] == position.locations[w.objective] != "idle")
    found = _on(text, own, position)
    assert found is not None and verify(found[1], objective, found[0], LATE).ok
    behind = replace_clock(position, watcher.clock, 3.0)
    request = read_request(there(text, own, behind))
    network = network_from(with_automata_of(game_of(text)[0], own), request, told_apart=True)
    report = verify(network, objective, found[0], LATE)
    assert not report.ok and "longer" in report.reason


def replace_clock(position: Position, clock: str, value: float) -> Position:
    """The position with another value of a clock."""
    return position._replace(clocks={**position.clocks, clock: value})


def _on(text: str, own: Strategy, position: Position) -> Optional[Tuple[Strategy, Network]]:
    game, objective = game_of(text)
    return tours_from_here(game, objective, own, read_request(there(text, own, position)), OPTIONS)


@given(small_patrols(), st.lists(st.tuples(st.integers(0, 1), st.floats(1.0, 4.0)), max_size=5), st.floats(0.0, 9.0))
@settings(max_examples=15, suppress_health_check=list(HealthCheck))
def test_the_game_in_one_piece_agrees(text: str, walks: Sequence[Tuple[int, float]], late: float) -> None:
    network, objective = game_of(text)
    found = won_by_tours(network, objective, LATE, OPTIONS)
    assume(found is not None)
    assert found is not None
    own = found.strategy
    model = model_of(text, network, objective, own)
    position = model.initial()
    for which, takes in walks:
        position = walked(model, own, own.tours[which % len(own.tours)].robot, 1, takes, position)
    position = position.aged(late)
    request = read_request(there(text, own, position, ahead=0.0))
    there_ = network_from(network, request)
    clocks = start_clocks(network, request)
    goes_on = tours_from_here(network, objective, own, request, OPTIONS)
    hopeless = is_too_much(there_, objective, LATE, clocks, frozenset())
    event(f"on: {goes_on is not None}, hopeless: {hopeless}")
    if goes_on is None and not hopeless:
        return
    assert goes_on is None or not hopeless
    try:
        verdict = solve(there_, objective, LATE, limits=LITTLE)
    except LimitHit:
        return
    except PursueError:  # its time is over
        assert goes_on is None
        return
    assert verdict.won == (goes_on is not None)


@pytest.mark.parametrize("away", [4.0, 9.0])
def test_a_mission_goes_on_whose_controller_was_away_when_its_command_was_due(away: float) -> None:
    text = corridor(6, 2, " every 160")
    network, objective, own = tours_of(text)
    won = Solution(with_automata_of(network, own), objective, own, LATE)
    scenario = parse(text, "patrol.pur", "patrol")
    stage = MissionRunner(make_case(scenario, won, SolveRequest(), "still", (), None)[0]).stage
    (first,) = (block for block in own.blocks if ("bot1_tour", "stop_1") in block.state.locations)
    due = max(float(bound.bound) for zone in first.wait for bound in zone)
    mission = SimulatedMission(stage, Settings("still", ("restart",), until=500.0), 1, None)
    mission.events.schedule(START + due - 1.0, lambda: mission._crash(Crash(0.0, "controller_bot1", away)))
    outcome = mission.run()
    assert outcome.plan > 0 and outcome.end == SAFE, outcome
