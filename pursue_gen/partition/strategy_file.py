"""The strategy as files that a person can follow (state → command → zone), and the cover that the observer reads.

The nodes of a workspace read these YAML files; what they hold is `strategy_data`'s.
"""

from __future__ import annotations

from fractions import Fraction

from pursue_gen.partition.split import SubStrategy
from pursue_gen.partition.strategy_data import cover_data, strategy_data
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.synthesis.strategy import Strategy

_WHEREVER = "Whoever a state does not name may be anywhere, and is not waited for."
_STAGES = "Stages are played one after the other: each ends where all of its places are reached."
_SHARES = "Shares are played at the same time: each avoids its places, and has an entry of its own in every state."
_PASSAGES = "Whoever sets off for a place has it until it sets off from there; each agent has an entry in every state."


def render(sub: SubStrategy, scenario_name: str, generator: str, reaction: Fraction) -> str:
    """The data file of one controller.

    `generator` is the version that stands in the header, `reaction` the delay (time units) that the strategy allows a
    command.
    """
    head = (
        f"Strategy of {sub.controller} in {scenario_name}, written by pursue-gen {generator}.",
        "In a state below, the command is due as soon as one of its zones (clocks in time units) holds.",
        *((_WHEREVER,) if sub.in_parts else ()),
    )
    data = strategy_data(sub, reaction)
    for name in ("commands_agents", "left_out_clocks"):
        if name in data:
            data[name] = inline(data[name])
    data["strategy"] = [{**entry, "state": inline(entry["state"])} for entry in data["strategy"]]
    return yaml_text(data, head)


def render_cover(strategy: Strategy, scenario_name: str, generator: str) -> str:
    """The data file of the observer: for each state in which zones the strategy waits, and in which it commands."""
    ends = _PASSAGES if strategy.passages else _SHARES if strategy.shares else _STAGES
    head = (
        f"What the strategy for {scenario_name} does, written by pursue-gen {generator}.",
        "In a state below, it waits or commands as long as one of the zones (clocks in time units) holds.",
        *((_WHEREVER, ends) if strategy.in_parts else ()),
    )
    data = cover_data(strategy)
    for name in ("stages", "shares"):
        if name in data:
            data[name] = [inline(places) for places in data[name]]
    for name in ("agents", "left_out_clocks"):
        if name in data:
            data[name] = inline(data[name])
    data["cover"] = [{**entry, "state": inline(entry["state"])} for entry in data["cover"]]
    return yaml_text(data, head)
