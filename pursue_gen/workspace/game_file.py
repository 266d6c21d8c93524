"""The data for a new plan during the mission: game.yaml, see docs/run_time.md."""

from __future__ import annotations

import hashlib
from typing import Dict

from pursue_gen.language.scenario import Scenario
from pursue_gen.partition.strategy_data import number
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.synthesis.plan_parts import follower_lines
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.workspace.context import Options


def render(scenario: Scenario, options: Options, strategy: Strategy, plan: str, generator: str) -> str:
    """The text of game.yaml: the scenario word for word, which game is played, by which plan, who gets which commands.

    The plan is not in it, but its digest, and what to ask the solver for to have it again; and its tours, with which
    robots may go on.
    """
    head = f"The game of {scenario.name}, written by pursue-gen {generator}: from this a new plan is made under way."
    slack = dict(sorted(options.slack.items()))
    asked: Dict[str, object] = {"sha256": hashlib.sha256(plan.encode()).hexdigest()}
    if options.optimize is not None:
        asked["optimize"] = options.optimize
    if options.within is not None:
        asked["within"] = number(options.within)
    data = {
        "format": 1,
        "name": scenario.name,
        "rules": inline({"ends": options.ends, "reaction": number(options.reaction), "slack": slack}),
        "controllers": options.controllers,
        "reach_obj": options.reach_obj,
        "plan": inline(asked),
    }
    given_up = sorted({one.objective.optional for one in scenario.given_up})
    if given_up:
        data["given_up"] = inline(given_up)
    if strategy.tours:
        data["follows"] = follower_lines(strategy)
    if strategy.shares:
        data["shares"] = [inline([sorted(who), sorted(what)]) for who, what in strategy.shared_out()]
    data["scenario"] = scenario.text
    return yaml_text(data, [head])
