"""The strategy as files that a person can follow (state → command → zone), and the cover that the observer reads.

The nodes of a workspace read these YAML files; what they hold is `strategy_data`'s.
"""

from __future__ import annotations

import json
import re
from fractions import Fraction
from typing import Any, List, Mapping

from pursue_gen.partition.split import SubStrategy
from pursue_gen.partition.strategy_data import cover_data, strategy_data
from pursue_gen.synthesis.strategy import Strategy

_PLAIN = re.compile(r"[A-Za-z_]\w*", re.ASCII)
# What YAML 1.1 takes for a Boolean or for nothing, in any case of its letters.
_MISREAD = frozenset(("y", "n", "yes", "no", "on", "off", "true", "false", "null"))


def render(sub: SubStrategy, scenario_name: str, generator: str, reaction: Fraction) -> str:
    """The data file of one controller.

    `generator` is the version that stands in the header, `reaction` the delay (time units) that the strategy allows a
    command.
    """
    data = strategy_data(sub, reaction)
    lines = [
        f"# Strategy of {sub.controller} in {scenario_name}, written by pursue-gen {generator}.",
        "# In a state below, the command is due as soon as one of its zones (clocks in time units) holds.",
        f"format: {data['format']}",
        f"controller: {_scalar(data['controller'])}",
        f"commands_agents: [{', '.join(map(_scalar, data['commands_agents']))}]",
        f"reaction: {data['reaction']}",
        "strategy:" if data["strategy"] else "strategy: []",
    ]
    for entry in data["strategy"]:
        lines += [f"- state: {_state(entry['state'])}", "  commands:"]
        for command in entry["commands"]:
            lines += _command(command)
    return "\n".join(lines) + "\n"


def render_cover(strategy: Strategy, scenario_name: str, generator: str) -> str:
    """The data file of the observer: for each state the zones in which the strategy says something, wait or command."""
    data = cover_data(strategy)
    lines = [
        f"# Where the strategy for {scenario_name} knows what to do, written by pursue-gen {generator}.",
        "# In a state below, it holds as long as one of the zones (clocks in time units) does.",
        f"format: {data['format']}",
        "cover:" if data["cover"] else "cover: []",
    ]
    for entry in data["cover"]:
        lines.append(f"- state: {_state(entry['state'])}")
        lines += ["  zones:", *(f"  - {text}" for text in entry["zones"])] if entry["zones"] else ["  zones: []"]
    return "\n".join(lines) + "\n"


def _command(command: Mapping[str, Any]) -> List[str]:
    """The lines of one command."""
    return [
        f"  - do: {_scalar(command['do'])}",
        *(f"    {key}: {_scalar(command[key])}" for key in ("agent", "from", "to")),
        "    when:",
        *(f"    - {text}" for text in command["when"]),
    ]


def _state(state: Mapping[str, object]) -> str:
    return "{" + ", ".join(f"{_scalar(name)}: {_scalar(value)}" for name, value in state.items()) + "}"


def _scalar(value: object) -> str:
    """The number, or the text as a YAML scalar that is read back as this very text."""
    if not isinstance(value, str):
        return str(value)
    if _PLAIN.fullmatch(value) and value.lower() not in _MISREAD:
        return value
    return json.dumps(value)
