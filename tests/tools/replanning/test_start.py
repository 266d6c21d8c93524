"""Where a plan begins: the clock values that nothing tells from the measured ones; and what nobody counts on."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Dict

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import start_zone
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga.network import Automaton, Location, Network
from pursue_gen.tga.scale import common_denominator, scaled
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from, region
from tests.oracle import ENGINES
from tests.synthesis.test_start import GOAL
from tests.tools.replanning.plays import asked, beginning, solved, walk

CLOCKS = ("x", "y", "z")
BEYOND = {clock: Fraction(5) for clock in CLOCKS}
TIMES = st.integers(0, 7_000_000).map(lambda n: Fraction(n, 1_000_000))
POINTS = st.tuples(*[TIMES | st.integers(0, 70).map(lambda n: Fraction(n, 10)) for _ in CLOCKS])


def zone(point, grid: int):
    bounds = region(dict(zip(CLOCKS, point)), BEYOND, grid)
    spot = Automaton("A", (Location("there"),), "there", ())
    game = compile_game(Network(CLOCKS, (), (), (spot,), bounds), replace(GOAL, goal=(("A", "there"),)))
    return game.scale, start_zone(game)


@given(POINTS, st.sampled_from((1, 10, 30)))
def test_the_measured_values_are_in_the_zone(point, grid: int) -> None:
    scale, found = zone(point, grid)
    assert found.contains([value * scale for value in point])


@given(POINTS, POINTS, st.sampled_from((1, 10)))
def test_no_bound_on_the_grid_tells_values_of_the_zone_apart(point, other, grid: int) -> None:
    scale, found = zone(point, grid)
    if not found.contains([value * scale for value in other]):
        return
    for a, b in zip(point, other):
        assert (a > 5) == (b > 5)
        if a <= 5:
            assert (a * grid // 1, (a * grid) % 1 == 0) == (b * grid // 1, (b * grid) % 1 == 0)


@given(POINTS, st.sampled_from((1, 10)))
def test_all_that_is_alike_is_in_the_zone(point, grid: int) -> None:
    """Time that is too short to reach a bound, and values beyond all bounds."""
    scale, found = zone(point, grid)
    far = [value + 1000 if value > 5 else value for value in point]
    assert found.contains([value * scale for value in far])
    if all((value * grid) % 1 for value in point):
        room = min(1 - (value * grid) % 1 for value in point) / 2
        assert found.contains([(value + room / grid) * scale for value in point])


def network_at(**changed) -> Network:
    _, won = solved("thesis/scenario_1")
    return network_from(won.network, read_request(beginning("thesis/scenario_1", **changed)))


def test_the_grid_has_the_decimals_of_the_scenario() -> None:
    _, won = solved("thesis/scenario_1")
    request = read_request(beginning("thesis/scenario_1", clocks=dict.fromkeys(won.network.clocks, 0.26)))
    for network, parts in ((won.network, 10), (scaled(won.network, Fraction(1, 4)), 20)):
        found = network_from(network, request)
        grid = common_denominator(bound.bound for bound in found.start)
        assert grid == parts


def place(network: Network, agent: str) -> Location:
    automaton = network.automaton(agent)
    return next(location for location in automaton.locations if location.name == automaton.initial)


WAY: Dict[str, str] = {"bot1": "going_c_to_b"}


def on_the_way(clock: float, **changed) -> Network:
    request = beginning("thesis/scenario_1", ahead=0.0)
    locations, clocks = {**request["locations"], **WAY}, {**request["clocks"], "Cbot1": clock}
    return network_at(**{"ahead": 0.0, "locations": locations, "clocks": clocks, **changed})


@pytest.mark.parametrize("name", ["thesis/scenario_1", "thesis/scenario_3", "work_cell/work_cell"])
@pytest.mark.parametrize("lost", [False, True])
def test_both_engines_agree_in_the_middle_of_plays(name: str, lost: bool) -> None:
    scenario, won = solved(name)
    excused = [agent.name for agent in scenario.agents[:1]] if lost else []
    for state, clocks in list(walk(name, 5, 18))[::5]:
        network = network_from(won.network, read_request(asked(name, state, clocks, excused=excused)))
        native_, python = (solve(network, won.objective, won.reaction, engine=e).won for e in ENGINES.values())
        assert native_ is python


def test_the_network_starts_at_the_place_and_knows_its_home() -> None:
    bot1 = on_the_way(3.0).automaton("bot1")
    assert (bot1.initial, bot1.home) == ("going_c_to_b", "c")
    assert place(on_the_way(3.0), "bot1").invariant


@pytest.mark.parametrize(("clock", "ahead", "bounded"), [(10.0, 0.0, True), (10.01, 0.0, False), (9.9, 0.2, False)])
def test_a_late_agent_may_stay(clock: float, ahead: float, bounded: bool) -> None:
    network = on_the_way(clock, ahead=ahead)
    assert bool(place(network, "bot1").invariant) is bounded
    assert place(network, "bot2").invariant == ()
    (end,) = (edge for edge in network.automaton("bot1").edges if edge.source == "going_c_to_b" and edge.is_end)
    assert end.guard.clocks and not end.controllable


def test_an_excused_agent_may_end_at_any_time_or_never_and_gets_no_command() -> None:
    bot1 = on_the_way(3.0, excused=["bot1"]).automaton("bot1")
    assert place(on_the_way(3.0, excused=["bot1"]), "bot1").invariant == ()
    (end,) = (edge for edge in bot1.edges if edge.source == "going_c_to_b")
    assert not end.guard.clocks and not end.controllable
    standing = network_at(excused=["bot1"]).automaton("bot1")
    assert not [edge for edge in standing.edges if edge.source == "c" and edge.controllable]
    assert [edge for edge in standing.edges if edge.source == "b" and edge.controllable], "once it is back"
