"""The data for a new plan during the mission: game.yaml, see docs/run_time.md."""

from __future__ import annotations

from pursue_gen.language.scenario import Scenario
from pursue_gen.partition.strategy_data import number
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.workspace.context import Options


def render(scenario: Scenario, options: Options, generator: str) -> str:
    """The text of game.yaml: the scenario word for word, which game is played, who gets which commands."""
    head = f"The game of {scenario.name}, written by pursue-gen {generator}: from this a new plan is made under way."
    slack = dict(sorted(options.slack.items()))
    data = {
        "format": 1,
        "name": scenario.name,
        "rules": inline({"ends": options.ends, "reaction": number(options.reaction), "slack": slack}),
        "controllers": options.controllers,
        "reach_obj": options.reach_obj,
        "scenario": scenario.text,
    }
    return yaml_text(data, [head])
