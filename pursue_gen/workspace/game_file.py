"""What it takes to plan again, as the observer reads it: game.yaml, see docs/run_time.md."""

from __future__ import annotations

import json

from pursue_gen.language.scenario import Scenario
from pursue_gen.synthesis.plan_text import number_text
from pursue_gen.workspace.context import Options


def render(scenario: Scenario, options: Options, generator: str) -> str:
    """The text of game.yaml: the scenario word for word, which game is played, who gets which commands."""
    slack = ", ".join(f"{json.dumps(name)}: {late}" for name, late in sorted(options.slack.items()))
    lines = [
        f"# The game of {scenario.name}, written by pursue-gen {generator}: from this a new plan is made under way.",
        "format: 1",
        f"name: {json.dumps(scenario.name)}",
        f"rules: {{ends: {options.ends}, reaction: {number_text(options.reaction)}, slack: {{{slack}}}}}",
        f"controllers: {options.controllers}",
        f"reach_obj: {json.dumps(options.reach_obj)}",
        f"scenario: {_block(scenario.text)}",
    ]
    return "\n".join(lines) + "\n"


def _block(text: str) -> str:
    """The text as a YAML scalar that is read back as this very text: line by line where that can be."""
    lines = text.split("\n")
    if len(lines) < 2 or lines[-1] or not all(line.replace("\t", "").isprintable() for line in lines):
        return f'"{"".join(map(_escaped, text))}"'
    body = "\n".join(f"  {line}" if line else "" for line in lines[:-1])
    return f"|2+\n{body}"


def _escaped(letter: str) -> str:
    """The letter between YAML's double quotes; JSON would write those beyond the first 65536 as two."""
    if letter in '"\\':
        return "\\" + letter
    return letter if letter.isprintable() else f"\\U{ord(letter):08x}"
