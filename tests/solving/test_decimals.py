"""Games with decimals: what is true of a game is true of the same one in other units of time."""

from __future__ import annotations

from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain, render
from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.solving.given_plan import trials
from pursue_gen.solving.least_time import fastest
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.scale import common_denominator, scaled
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, case_of
from pursue_gen.workspace import Options, generate
from pursue_runtime.data import parse_data
from tests.oracle import ENGINES
from tests.synthesis.random_games import networks

FEW = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))

TEXT = """\
poi "desk"
poi "shelf"
connect desk and shelf distance 2.5
event "fetch" location shelf duration 0.75 to 2.5
event "sign" location desk
event "ring"
rule "order": fetch before sign
agent "bot" controllable mobile 0.5 location desk can_do fetch, sign
agent "guest" mobile 1.25 location desk can_do ring
reach_objective: do sign after 2.5 within {}
"""
WON, LOST = TEXT.format("16.5"), TEXT.format("9.5")


def solved(text: str) -> Solution:
    scenario = parse(text, "decimals.pur")
    return solution(translate(scenario), scenario_objective(scenario), Rules())


@pytest.mark.parametrize("engine", ENGINES)
@given(networks(tuple(Kind)), st.sampled_from((2, 5, 8, 10)), st.sampled_from((0, 1)))
@FEW
def test_the_unit_of_time_changes_no_verdict(
    engine: str, game: Tuple[Network, Objective], factor: int, delay: int
) -> None:
    network, objective = game
    small, reaction = scaled(network, Fraction(1, factor)), Fraction(delay, factor)
    verdict = solve(small, objective, reaction, ENGINES[engine])
    assert verdict.won == solve(network, objective, Fraction(delay), ENGINES[engine]).won
    if verdict.strategy is not None:
        assert verify(small, objective, verdict.strategy, reaction).ok
        assert read_plan(write_plan(verdict.strategy, small, objective), small, "plan") == verdict.strategy


@given(networks((Kind.REACH,)), st.sampled_from((2, 10)))
@FEW
def test_the_least_time_is_that_of_the_same_game_in_other_units(game: Tuple[Network, Objective], factor: int) -> None:
    network, objective = game
    won = solve(network, objective)
    if not won.won or won.strategy is None:
        return
    known = worst_case(network, objective, won.strategy)
    small = scaled(network, Fraction(1, factor))
    same = solve(small, objective).strategy
    assert same is not None
    here, _ = fastest(network, objective, Fraction(0), known)
    there, _ = fastest(small, objective, Fraction(0), worst_case(small, objective, same))
    if here.exact and there.exact:
        assert there.least * factor == here.least
    assert there.most is None or there.most * factor >= here.least


@given(networks(tuple(Kind)), st.sampled_from((1, 2, 20, 1000)))
@example((translate(parse(WON, "decimals.pur")), scenario_objective(parse(WON, "decimals.pur"))), 1)
@FEW
def test_a_network_is_read_as_it_was_written(game: Tuple[Network, Objective], factor: int) -> None:
    network, objective = game
    small = scaled(network, Fraction(1, factor))
    text = write_network(small, objective)
    assert read_network(text, "TGA.xml") == small
    multiplied = common_denominator(small.times)
    assert ("All times are multiplied by" in text) == (multiplied > 1)
    if multiplied > 1:
        whole = write_network(scaled(small, multiplied), objective)
        comment = f"// All times are multiplied by {multiplied}: UPPAAL knows whole numbers only.\n"
        assert text.replace(comment, "") == whole


def test_a_plan_may_have_the_times_of_the_scenario_or_those_of_its_file() -> None:
    network, objective = translate(parse(WON, "decimals.pur")), scenario_objective(parse(WON, "decimals.pur"))
    large = scaled(network, common_denominator(network.times))
    for game in (network, large):
        strategy = solve(game, objective).strategy
        assert strategy is not None
        (trial,) = trials(write_plan(strategy, game, objective), "plan", network, objective, [IDEAL])
        assert trial.solution is not None


def test_simulated_missions_keep_to_the_game() -> None:
    won = solved(WON)
    case, _ = case_of(parse(WON, "decimals.pur"), won, Options(), Settings("mixed"))
    runner = MissionRunner(case)
    outcomes = [runner.run(seed) for seed in range(12)]
    assert {outcome.end for outcome in outcomes} == {GOAL}, [outcome.reason for outcome in outcomes]


def test_files_have_numbers_with_decimals() -> None:
    won = solved(WON)
    files = generate(parse(WON, "decimals.pur"), won.network, won.objective, won.strategy, Options())
    model = parse_data(files["src/observer/config/model.yaml"], "model.yaml")
    bot = next(automaton for automaton in model["automata"] if automaton["name"] == "bot")
    assert bot["locations"]["going_desk_to_shelf"] == ["Cbot <= 2.25"]
    assert parse_data(files["src/UI/config/ui.yaml"], "ui.yaml")["connections"] == [["desk", "shelf", 2.5]]
    assert b"after 2.5 time units within 16.5 time units" in files["README.md"]


def test_an_explanation_speaks_of_decimals() -> None:
    scenario = parse(LOST, "decimals.pur")
    found = render(explain(scenario, Rules(), Limits(20.0, work=3_000_000)), 1000)
    assert "within 9.5 of the start" in found
    assert "instead of 9.5" in found
    assert "19/2" not in found
