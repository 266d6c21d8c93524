"""The families of the benchmarks are sound scenarios, and their smallest members are decided as their tasks promise."""

from __future__ import annotations

from fractions import Fraction

import pytest

from benchmarks.families import FAMILIES, Family
from benchmarks.ordinary_families import ORDINARY
from pursue_gen.language import check, parse
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate

pytestmark = pytest.mark.benchmark

BY_NAME = {family.name: family for family in FAMILIES}


@pytest.mark.parametrize("family", (*FAMILIES, *ORDINARY), ids=lambda family: family.name)
def test_every_member_is_a_scenario_without_findings(family: Family) -> None:
    """But for the warning that no way leads to other buildings, where that is the story."""
    allowed = {"PML147"} if family.name == "buildings apart" else set()
    for size in family.sizes:
        assert {finding.code for finding in check(parse(family.text(size), f"member{size}.pur"))} <= allowed


@pytest.mark.parametrize("family", (*FAMILIES, *ORDINARY), ids=lambda family: family.name)
def test_a_family_has_a_task_and_its_sizes_grow(family: Family) -> None:
    assert family.task.endswith(".")
    assert list(family.sizes) == sorted(set(family.sizes))
    assert set(family.quick) <= {*family.sizes, 1}
    texts = [family.text(size) for size in family.sizes]
    assert len(set(texts)) == len(texts)


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_the_smallest_member_is_won_in_the_ideal_game_by_a_proven_strategy(family: Family) -> None:
    scenario = parse(family.text(family.sizes[0]), "member.pur")
    assert solve_scenario(scenario, IDEAL).strategy.blocks


def test_what_grows_is_what_the_family_says() -> None:
    def members(name: str, size: int) -> int:
        scenario = parse(BY_NAME[name].text(size), "member.pur")
        controllable = sum(agent.controllable for agent in scenario.agents)
        return {
            "robots": controllable,
            "POIs": len(scenario.pois),
            "distance": max(way.distance for way in scenario.connections),
            "actions": sum(event.name.startswith("check") for event in scenario.events),
            "uncontrollable agents": len(scenario.agents) - controllable,
        }[BY_NAME[name].grows]

    for family in FAMILIES:
        size = family.sizes[-1]
        assert members(family.name, size) == size, family.name


def test_ways_as_short_as_the_uncertainty_of_an_arrival_lose_the_thief() -> None:
    for distance, won in ((1, False), (10, True)):
        scenario = parse(BY_NAME["all ways"].text(distance), "member.pur")
        if won:
            assert solve_scenario(scenario, Rules()).strategy.blocks
        else:
            from pursue_gen.tga import ends_reported

            network = ends_reported(translate(scenario), {})
            assert not solve(network, scenario_objective(scenario), reaction=Fraction(1, 10)).won
