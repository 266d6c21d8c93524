"""A strategy as plain data for the nodes of a mission: in YAML files that a person can follow (state → command → zone),
with the cover that the observer reads, and in JSON for a new plan. docs/run_time.md describes the format.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Dict, Iterable, List, Sequence, Union

from pursue_gen.language.network_names import reach_objective, rule_turn, safety_objective
from pursue_gen.language.numbers import Number, decimal_text
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.partition.split import SubStrategy
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.synthesis.plan_text import constraint_texts
from pursue_gen.synthesis.strategy import Command, DiscreteState, Strategy, Zone
from pursue_gen.tga.event_words import event_word


def strategy_data(sub: SubStrategy, reaction: Fraction) -> Dict[str, Any]:
    """What one controller does, and the delay (time units) that the strategy allows a command.

    Bounds of zones are in time units: decimals where that is exact, else fractions.
    """
    named = not {reach_objective(0), safety_objective(0)}.issuperset(sub.objectives)
    return {
        "format": 2 if named or sub.left_out_clocks else 1,
        "controller": sub.controller,
        "commands_agents": list(sub.agents),
        **({"objectives": list(sub.objectives)} if named else {}),
        "reaction": number(reaction),
        **_left_out(sub.left_out_clocks),
        "strategy": [
            {"state": _state(state), "commands": [_command(command) for command in commands]}
            for state, commands in sub.blocks
        ],
    }


def cover_data(strategy: Strategy) -> Dict[str, Any]:
    """For each state what the strategy does, and in which zones: wait, or a command; its stages, shares, or agents
    with orders of passage, if it has any, and the clocks that it leaves out."""
    cover: List[Dict[str, Any]] = []
    for block in strategy.blocks:
        does: Dict[str, Any] = {"wait": _zones(block.wait)} if block.wait else {}
        if block.commands:
            does["commands"] = [_command(command) for command in block.commands]
        cover.append({"state": _state(block.state), **does})
    parts = {"stages": strategy.stages, "shares": strategy.shares}
    places = {name: [[list(place) for place in some] for some in all_of_them] for name, all_of_them in parts.items()}
    named = {name: some for name, some in places.items() if some}
    agents = {"agents": list(strategy.commanded)} if strategy.passages else {}
    return {"format": 4 if agents else 3, **named, **agents, **_left_out(strategy.left_out_clocks), "cover": cover}


def _left_out(clocks: Sequence[str]) -> Dict[str, List[str]]:
    return {"left_out_clocks": list(clocks)} if clocks else {}


def number(value: Number) -> Union[int, float, str]:
    """The number as readers of YAML and JSON have it: a fraction that is no decimal stands as text, `1/3`."""
    text = decimal_text(value)
    return text if "/" in text else float(text) if "." in text else int(text)


def _command(command: Command) -> Dict[str, Any]:
    first = command.moves[0]
    return {
        "do": event_word(first.automaton, first.edge),
        "agent": first.automaton,
        "from": first.edge.source,
        "to": first.edge.target,
        "when": _zones(command.zones),
    }


def _state(state: DiscreteState) -> Dict[str, Union[str, int]]:
    """Where every automaton is, and the variables that do not follow from that: all but the `P<automaton>`. That of an
    objective does not, either: it says which place of a patrol comes next."""
    follows = {rule_turn(automaton) for automaton, _ in state.locations if role_of(automaton) is not Role.SAFETY}
    parts: Dict[str, Union[str, int]] = dict(state.locations)
    parts.update((name, value) for name, value in state.values if name not in follows)
    return parts


def _zones(zones: Iterable[Zone]) -> List[str]:
    """The zones' texts, each once."""
    return list(dict.fromkeys(zone_text(zone) for zone in zones))


def zone_text(zone: Zone) -> str:
    """The zone as comparisons joined by `&&`, `always` for the one without any."""
    return " && ".join(constraint_texts(zone, space=" ")) or "always"


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
    return _in_lines(strategy_data(sub, reaction), "strategy", head)


def render_cover(strategy: Strategy, scenario_name: str, generator: str) -> str:
    """The data file of the observer: for each state in which zones the strategy waits, and in which it commands."""
    ends = _PASSAGES if strategy.passages else _SHARES if strategy.shares else _STAGES
    head = (
        f"What the strategy for {scenario_name} does, written by pursue-gen {generator}.",
        "In a state below, it waits or commands as long as one of the zones (clocks in time units) holds.",
        *((_WHEREVER, ends) if strategy.in_parts else ()),
    )
    return _in_lines(cover_data(strategy), "cover", head)


def _in_lines(data: Dict[str, Any], states: str, head: Sequence[str]) -> str:
    """The text, with a line for each state, list of agents or clocks, stage and share."""
    for name in ("commands_agents", "agents", "left_out_clocks"):
        data.update({name: inline(data[name])} if name in data else {})
    for name in ("stages", "shares"):
        data.update({name: [inline(places) for places in data[name]]} if name in data else {})
    data[states] = [{**entry, "state": inline(entry["state"])} for entry in data[states]]
    return yaml_text(data, head)
