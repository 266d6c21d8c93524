"""The strategy as data that a person can follow (state → command → zone), and the cover that the observer reads.

The nodes of a workspace read these YAML files; the format is described with the run time.
"""

from __future__ import annotations

import json
import re
from fractions import Fraction
from typing import Iterable, List, Tuple

from pursue_gen.partition.split import SubStrategy
from pursue_gen.synthesis.plan_text import constraint_texts, number_text
from pursue_gen.synthesis.strategy import Command, DiscreteState, Strategy, Zone
from pursue_gen.tga.words import event_word

_PLAIN = re.compile(r"[A-Za-z_]\w*", re.ASCII)
# What YAML 1.1 takes for a Boolean or for nothing, in any case of its letters.
_MISREAD = frozenset(("y", "n", "yes", "no", "on", "off", "true", "false", "null"))


def render(sub: SubStrategy, scenario_name: str, generator: str, reaction: Fraction) -> str:
    """The data file of one controller.

    `generator` is the version that stands in the header, `reaction` the delay (time units) that the strategy allows a
    command. Bounds of zones are in time units: decimals where that is exact, else fractions.
    """
    lines = [
        f"# Strategy of {sub.controller} in {scenario_name}, written by pursue-gen {generator}.",
        "# In a state below, the command is due as soon as one of its zones (clocks in time units) holds.",
        "format: 1",
        f"controller: {_scalar(sub.controller)}",
        f"commands_agents: [{', '.join(map(_scalar, sub.agents))}]",
        f"reaction: {number_text(reaction)}",
        "strategy:" if sub.blocks else "strategy: []",
    ]
    for state, commands in sub.blocks:
        lines += [f"- state: {_state(state)}", "  commands:"]
        for command in commands:
            lines += _command(command)
    return "\n".join(lines) + "\n"


def render_cover(strategy: Strategy, scenario_name: str, generator: str) -> str:
    """The data file of the observer: for each state the zones in which the strategy says something, wait or command."""
    lines = [
        f"# Where the strategy for {scenario_name} knows what to do, written by pursue-gen {generator}.",
        "# In a state below, it holds as long as one of the zones (clocks in time units) does.",
        "format: 1",
        "cover:" if strategy.blocks else "cover: []",
    ]
    for block in strategy.blocks:
        zones = [*block.wait, *(zone for command in block.commands for zone in command.zones)]
        lines.append(f"- state: {_state(block.state)}")
        lines += ["  zones:", *(f"  - {text}" for text in _zones(zones))] if zones else ["  zones: []"]
    return "\n".join(lines) + "\n"


def _command(command: Command) -> List[str]:
    """The lines of one command."""
    first = command.moves[0]
    return [
        f"  - do: {_scalar(event_word(first.automaton, first.edge))}",
        f"    agent: {_scalar(first.automaton)}",
        f"    from: {_scalar(first.edge.source)}",
        f"    to: {_scalar(first.edge.target)}",
        "    when:",
        *(f"    - {text}" for text in _zones(command.zones)),
    ]


def _state(state: DiscreteState) -> str:
    """Where every automaton is, and the variables that do not follow from that: all but the `P<automaton>`."""
    follows = {f"P{automaton}" for automaton, _ in state.locations}
    parts: List[Tuple[str, str]] = [(name, _scalar(location)) for name, location in state.locations]
    parts += [(name, str(value)) for name, value in state.values if name not in follows]
    return "{" + ", ".join(f"{_scalar(name)}: {text}" for name, text in parts) + "}"


def _zones(zones: Iterable[Zone]) -> Tuple[str, ...]:
    """The zones' texts, each once."""
    return tuple(dict.fromkeys(zone_text(zone) for zone in zones))


def zone_text(zone: Zone) -> str:
    """The zone as comparisons joined by `&&`, `always` for the one without any."""
    return " && ".join(constraint_texts(zone, space=" ")) or "always"


def _scalar(text: str) -> str:
    """The text as a YAML scalar that is read back as this very text."""
    if _PLAIN.fullmatch(text) and text.lower() not in _MISREAD:
        return text
    return json.dumps(text)
