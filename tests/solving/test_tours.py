"""Patrols of many places: tours that are shared out, proven, and calm."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from typing import List

import pytest
from hypothesis import HealthCheck, assume, event, given, settings

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.options import DEFAULT as OPTIONS
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT, Rules
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.solvers import solved
from pursue_gen.solving.still_play import driven_while_still
from pursue_gen.solving.tours import least_period_of_patrols, period_of_tours, won_by_tours
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case
from tests.patrols import corridor, game_of, small_patrols, tours_of

LATE = Rules().reaction
LITTLE = Limits(states=20_000, work=30_000_000)
"""What the solver of the game in one piece may take."""


def test_each_robot_goes_round_rooms_of_its_own_and_knows_of_nothing_else() -> None:
    network, objective, strategy = tours_of(corridor(12, 2, " every 162"))
    assert [tour.robot for tour in strategy.tours] == ["bot1", "bot2"]
    visited = [{stop for stop in tour.stops if stop.startswith("room")} for tour in strategy.tours]
    assert visited == [{f"room{n}" for n in range(1, 7)}, {f"room{n}" for n in range(7, 13)}]
    assert {block.state.names[0] for block in strategy.blocks} == {
        frozenset(("bot1", "bot1_tour")), frozenset(("bot2", "bot2_tour")),
    }  # fmt: skip
    assert len(strategy.blocks) < 120
    assert verify(network, objective, strategy, LATE).ok


def test_a_patrol_of_many_rooms_is_decided_by_solve() -> None:
    read = parse(corridor(15, 1, " every 400"), "patrol.pur", "patrol")
    won = solved(translate(read), scenario_objective(read), DEFAULT, OPTIONS)
    assert [tour.robot for tour in won.strategy.tours] == ["bot1"]
    assert verify(won.network, won.objective, won.strategy, LATE).ok


def test_a_plan_with_tours_is_read_as_it_was_written() -> None:
    network, objective, strategy = tours_of(corridor(6, 2, " every 81"))
    text = write_plan(strategy, network, objective)
    assert " -- Tour: bot1 2 hall1 room1 hall1 " in text
    assert read_plan(text, network, "plan.txt") == strategy
    for wrong in ("2 hall1 hall3", "0 hall1 room1", "x hall1 room1", "2", ""):
        damaged = text.replace("-- Tour: bot1 2 hall1 room1", f"-- Tour: bot1 {wrong}").splitlines()
        with pytest.raises(PursueError, match="tour"):
            read_plan("\n".join(damaged), network, "plan.txt")


def test_a_robot_may_start_at_a_place_of_its_round() -> None:
    """It waits there before it sets off, and not in each round again."""
    rooms = [f"room{n}" for n in range(1, 6)]
    lines = [f'poi "{place}"' for place in ("dock", "hall", *rooms)] + ["connect dock and hall distance 4"]
    lines += [f"connect hall and {room} distance {2 + n % 3}" for n, room in enumerate(rooms)]
    lines += ['agent "bot1" controllable mobile 1 location dock']
    lines += [f"objective: patrol {', '.join(rooms)}, dock every 80 by bot1"]
    network, objective, strategy = tours_of("\n".join(lines))
    (tour,) = strategy.tours
    assert (tour.stops[0], tour.stops[-1], tour.again) == ("dock", "dock", 1)
    assert verify(network, objective, strategy, LATE).ok


def test_a_robot_may_stay_at_its_only_place() -> None:
    network, objective, strategy = tours_of(corridor(3, 1, " every 9", "hall1"))
    (tour,) = strategy.tours
    assert (tour.stops, tour.again) == (("hall1",), 1)
    assert not any(block.commands for block in strategy.blocks)
    assert verify(network, objective, strategy, LATE).ok


def test_who_passes_the_place_of_another_is_not_relied_on() -> None:
    """bot2 has to go through the rooms of bot1 to its own; what it does there changes nothing for bot1."""
    text = corridor(6, 2, " every 120", "hall1, room1, hall2, room2, hall3, room3, hall5, room5, hall6, room6")
    network, objective, strategy = tours_of(text.replace("location hall4", "location hall1"))
    assert strategy.watchers
    assert verify(network, objective, strategy, LATE).ok
    first = strategy.watchers[0]
    blind = replace(strategy, watchers=strategy.watchers[1:])
    assert first.name in verify(network, objective, blind, LATE).reason


def test_people_who_walk_about_and_patrols_of_one_robot_change_nothing() -> None:
    text = corridor(6, 2, " every 162") + "objective: patrol hall6, room6 every 120 by bot2\n"
    place = text.index("objective")
    people = 'agent "guest" mobile 2 location room1\nagent "nurse" human controllable location hall1\n'
    network, objective, strategy = tours_of(text[:place] + people + text[place:])
    assert {"hall6", "room6"} <= set(next(tour.stops for tour in strategy.tours if tour.robot == "bot2"))
    assert verify(network, objective, strategy, LATE).ok


def test_between_two_rounds_a_robot_stays_as_long_as_the_period_allows() -> None:
    short, long = (tours_of(corridor(8, 1, f" every {every}"))[2] for every in (170, 500))
    assert short.tours == long.tours
    waits = [max(waits_of(each)) for each in (short, long)]
    assert waits[0] < 50 < 300 < waits[1]


def test_of_few_places_a_robot_waits_at_each() -> None:
    network, objective, some = tours_of(corridor(3, 1, " every 200"))
    assert verify(network, objective, some, LATE).ok
    # While it waits at one of three, two others wait for it: each for half of what is left beside the ways.
    assert len([time for time in waits_of(some) if time > 40]) == 3
    # Its ways, ten of 24 in all, and at most one longer each: less often than once in each period.
    driven = driven_while_still(with_automata_of(network, some), some, 2000)
    assert driven is not None and driven < 0.85 * (2000 / 200) * (24 + 10)


def waits_of(some: Strategy) -> List[Fraction]:
    """How long a robot waits until a command is due."""
    return [bound.bound for block in some.blocks for zone in block.wait for bound in zone]


def test_the_period_of_tours_is_kept_and_one_below_it_by_other_tours_alone() -> None:
    for rooms, robots in ((6, 2), (7, 3)):
        network, objective = game_of(corridor(rooms, robots, " every 1000"))
        every = period_of_tours(network, objective, LATE)
        assert every is not None
        for asked, won in ((every, True), (every - 1, False)):
            game = game_of(corridor(rooms, robots, f" every {asked}"))
            assert (won_by_tours(*game, LATE, OPTIONS) is not None) == won


@pytest.mark.parametrize(
    "more",
    [
        "objective: avoid bot1 at hall2\n",
        "objective: bot1 never_with bot2\n",
        "objective: patrol hall1, room1 in order every 90 by bot1\n",
        'agent "guest" mobile 2 location hall1\nobjective: avoid any robot at hall1 and guest at hall1\n',
    ],
)
def test_what_asks_for_more_than_patrols_is_left_to_others(more: str) -> None:
    text = corridor(3, 2, " every 81")
    place = text.index("objective")
    agents, _, rest = more.rpartition("\nobjective")
    text = f"{text[:place]}{agents}\n{text[place:]}objective{rest}" if agents else text + more
    network, objective = game_of(text)
    assert won_by_tours(network, objective, LATE, OPTIONS) is None
    assert period_of_tours(network, objective, LATE) is None


@pytest.mark.parametrize("reaction", [Fraction(0), LATE])
def test_the_controller_may_decide_when_robots_arrive(reaction: Fraction) -> None:
    read = parse(corridor(6, 2, " every 81"), "patrol.pur", "patrol")
    network, objective = translate(read), scenario_objective(read)
    found = won_by_tours(network, objective, reaction, OPTIONS)
    assert found is not None
    assert verify(network, objective, found.strategy, reaction).ok


@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=small_patrols())
def test_what_tours_win_is_not_lost(text: str) -> None:
    network, objective = game_of(text)
    found = won_by_tours(network, objective, LATE, OPTIONS)
    event("won" if found else "not found")
    assume(found is not None)
    assert found is not None
    assert verify(network, objective, found.strategy, LATE).ok
    try:
        assert solve(network, objective, LATE, limits=LITTLE).won
    except PursueError:
        event("too large to judge")


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=small_patrols(least=2))
def test_nothing_below_the_least_period_is_won(text: str) -> None:
    network, objective = game_of(text)
    least, tours = (found(network, objective, LATE) for found in (least_period_of_patrols, period_of_tours))
    assert tours is not None and least <= tours
    assume(least > 1)
    shorter = game_of(re.sub(r"every \d+", f"every {least - 1}", text))
    try:
        assert not solve(*shorter, LATE, limits=LITTLE).won
        event("judged")
    except PursueError:
        event("too large to judge")


@pytest.mark.parametrize("rooms, robots, every", [(6, 2, 81), (6, 2, 45), (5, 1, 150)])
def test_missions_keep_the_patrol(rooms: int, robots: int, every: int) -> None:
    text = corridor(rooms, robots, f" every {every}")
    scenario = parse(text, "patrol.pur", "patrol")
    network, objective, strategy = tours_of(text)
    won = Solution(with_automata_of(network, strategy), objective, strategy, LATE, rules=Rules())
    stage = MissionRunner(make_case(scenario, won, SolveRequest(), "random", (), None)[0]).stage
    for opponent in ("random", "still"):
        for seed in range(3):
            mission = simulate_mission(stage, Settings(opponent, until=400.0), seed)
            assert mission.end == SAFE, mission
