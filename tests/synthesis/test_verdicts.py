"""Verdicts on the published scenarios and the thesis's, in the ideal game and in the one that a robot can play."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from pursue_gen.language import load, parse
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.solving.solution import solution
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, read_query
from tests.conftest import thesis_scenario
from tests.oracle import ENGINES

DEFAULT = Rules()


def published(reference_dir: Path, name: str):
    folder = reference_dir / name
    network = read_network((folder / "TGA.xml").read_text(), f"{name}/TGA.xml")
    return network, read_query((folder / "TCTL.q").read_text(), f"{name}/TCTL.q")


@pytest.mark.parametrize(
    ("name", "ideal", "default"),
    [
        ("CT1", True, True),
        ("CT2a", True, True),
        ("CT3a", False, False),
        ("CT4", True, True),
        ("CT5", True, True),
        ("WC1", True, True),
        ("WC2a", False, False),
        ("EB1", True, False),
        ("EB3", True, False),
        ("EB2", True, False),
        ("EB2x", True, False),
        ("CT3b", True, True),
        ("EB4", True, False),
    ],
)
def test_published_scenarios_are_decided_as_tiga_does_and_as_a_robot_must(reference_dir, name, ideal, default):
    network, objective = published(reference_dir, name)
    for rules, expected in ((IDEAL, ideal), (DEFAULT, default)):
        assert solve(played(network, rules), objective, rules.reaction).won is expected


@pytest.mark.parametrize("name", ["CT1", "CT2a", "CT4", "CT5", "WC1"])
def test_a_reaction_of_half_a_unit_changes_no_verdict_of_these(reference_dir, name):
    network, objective = published(reference_dir, name)
    rules = Rules(reaction=Fraction(1, 2))
    assert solve(played(network, rules), objective, rules.reaction).won


@pytest.mark.parametrize("rules", [Rules(reaction=Fraction(0)), Rules("controllable", Fraction(1, 10))])
def test_ends_reported_alone_and_reaction_alone_both_cost_the_first_ecobot_its_win(reference_dir, rules):
    network, objective = published(reference_dir, "EB1")
    assert not solve(played(network, rules), objective, rules.reaction).won


@pytest.mark.parametrize(("deadline", "won"), [(45, False), (46, True)])
def test_the_first_ecobot_wins_with_a_deadline_of_46_and_not_of_45(reference_dir, deadline, won):
    text = (reference_dir / "EB1" / "scenario.pur").read_text().replace("within 20", f"within {deadline}")
    scenario = parse(text, "EB1.pur")
    network = played(translate(scenario), DEFAULT)
    assert solve(network, scenario_objective(scenario), DEFAULT.reaction).won is won


@pytest.mark.parametrize("rules", [IDEAL, DEFAULT], ids=["ideal", "default"])
@pytest.mark.parametrize("number", ["1", "2", "3", "4", "catch_the_thief"])
def test_the_five_scenarios_of_the_thesis_are_won_and_proven(number, rules):
    scenario = load(thesis_scenario(number))
    assert solution(translate(scenario), scenario_objective(scenario), rules).strategy.blocks


@pytest.mark.parametrize("rules", [IDEAL, DEFAULT], ids=["ideal", "default"])
@pytest.mark.parametrize("name", ["CT1", "CT2a", "WC1"])
def test_strategies_for_published_scenarios_pass_the_checker(reference_dir, name, rules):
    network, objective = published(reference_dir, name)
    assert solution(network, objective, rules).strategy.blocks


@pytest.mark.parametrize("name", ["EB1", "EB3"])
def test_strategies_for_the_ideal_ecobots_pass_the_checker(reference_dir, name):
    network, objective = published(reference_dir, name)
    assert solution(network, objective, IDEAL).strategy.blocks


@pytest.mark.parametrize("name", ["CT1", "WC1", "WC2a", "EB1"])
@pytest.mark.parametrize("rules", [IDEAL, DEFAULT], ids=["ideal", "default"])
def test_both_engines_agree(reference_dir, name, rules):
    network, objective = published(reference_dir, name)
    game = played(network, rules)
    verdicts = {name: solve(game, objective, rules.reaction, engine=engine).won for name, engine in ENGINES.items()}
    assert verdicts["native"] is verdicts["python"]
