"""The missions of crowds that are played on ROS: what they play, and how those on record ended."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.missions import CROWDS, GOAL, names, scenario_of

pytestmark = pytest.mark.benchmark


def test_crowds_are_the_members_of_families_that_their_names_say() -> None:
    delivery, visitors = map(scenario_of, CROWDS)
    assert sum(agent.controllable for agent in delivery.agents) == 8 and delivery.name == "delivery_8"
    assert sum(not agent.controllable for agent in visitors.agents) == 3 and visitors.name == "visitors_3"
    assert set(CROWDS) <= set(names())


def test_those_on_record_came_to_their_goals(project_root: Path) -> None:
    played = json.loads((project_root / "docs" / "benchmarks" / "missions.json").read_text())["missions"]
    assert {name: played[name]["outcome"] for name in CROWDS} == dict.fromkeys(CROWDS, GOAL)
