"""Random lab scenarios are sound, of the size asked for, and the same wherever they are drawn."""

from __future__ import annotations

import subprocess
import sys

import pytest

from benchmarks.lab_scenarios import LARGE, SMALL, Size, lab_scenario, main
from benchmarks.measure import ROOT
from pursue_gen.language import check, parse

pytestmark = pytest.mark.benchmark

SIZES = (SMALL, LARGE, Size(places=4, robots=2, people=1, promises=2), Size(places=3, robots=1, people=1, promises=1))


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size.places} places")
def test_each_is_a_scenario_of_its_size_without_findings(size: Size) -> None:
    for seed in range(40):
        text = lab_scenario(seed, size)
        scenario = parse(text, "lab.pur")
        assert check(scenario) == (), seed
        robots = [agent for agent in scenario.agents if agent.controllable]
        assert len(scenario.pois) == size.places
        assert len(robots) == size.robots and all(robot.mobile for robot in robots)
        assert len(scenario.agents) - len(robots) == size.people
        assert text.count("\nobjective: ") == size.promises


def test_seeds_differ_and_a_seed_is_the_same_in_every_process(capsys: pytest.CaptureFixture[str]) -> None:
    assert len({lab_scenario(seed) for seed in range(40)}) == 40
    for options in (["7"], ["7", "--large"]):
        main(options)
        command = [sys.executable, "-m", "benchmarks.lab_scenarios", *options]
        printed = subprocess.run(command, cwd=str(ROOT), check=True, stdout=subprocess.PIPE, universal_newlines=True)
        assert printed.stdout == capsys.readouterr().out


def test_the_promises_are_of_all_kinds() -> None:
    texts = "".join(lab_scenario(seed) for seed in range(40))
    words = ("then answer", "then drop", "then any robot at", "patrol ", "never_with", "avoid ", "always not ")
    assert [word for word in words if word not in texts] == []
