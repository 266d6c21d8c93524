"""The network as the nodes of a workspace read it: model.yaml, see docs/run_time.md."""

from __future__ import annotations

import json
import re
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.names import REACH, STATES
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Network, Objective
from pursue_gen.tga.words import event_word

_PLAIN = re.compile(r"[A-Za-z_]\w*", re.ASCII)
# What YAML 1.1 takes for a Boolean or for nothing, in any case of its letters.
_MISREAD = frozenset(("y", "n", "yes", "no", "on", "off", "true", "false", "null"))


def render(network: Network, objective: Objective, scenario: Scenario, generator: str) -> str:
    """The text of model.yaml: `network` is the one of the game that is played (its ends and slack included)."""
    kinds = _kinds(scenario)
    lines = [
        f"# The automata of {scenario.name}, written by pursue-gen {generator}.",
        "# Clocks count time units; an event moves one sender (or owner) and every automaton that can receive it.",
        "format: 1",
        f"scenario: {_scalar(scenario.name)}",
        f"clocks: {_list(map(_scalar, network.clocks))}",
        f"variables: {_map((_scalar(name), str(value)) for name, value in network.variables)}",
        "automata:",
    ]
    for automaton in network.automata:
        lines += _automaton(automaton, kinds.get(automaton.name, "safety"))
    goal, bad = _place(objective.goal), _place(objective.bad)
    lines.append(f"objective: {{kind: {objective.kind.value}, goal: {goal}, bad: {bad}}}")
    return "\n".join(lines) + "\n"


def _kinds(scenario: Scenario) -> Dict[str, str]:
    """automaton → kind, for all but the safety objective's."""
    kinds = {STATES: "states", REACH: "reach"}
    kinds.update((rule.name, "rule") for rule in scenario.rules)
    for agent in scenario.agents:
        kinds[agent.name] = "robot" if agent.is_robot else "human" if agent.controllable else "agent"
    return kinds


def _automaton(automaton: Automaton, kind: str) -> List[str]:
    locations = _map((_scalar(location.name), _list(_bounds(location.invariant))) for location in automaton.locations)
    return [
        f"- name: {_scalar(automaton.name)}",
        f"  kind: {kind}",
        f"  initial: {_scalar(automaton.initial)}",
        f"  locations: {locations}",
        "  edges:" if automaton.edges else "  edges: []",
        *(f"  - {_edge(automaton.name, edge)}" for edge in automaton.edges),
    ]


def _edge(automaton: str, edge: Edge) -> str:
    sync = "own" if edge.sync is None else "send" if edge.sync.sends else "receive"
    tests = _list(_list(f"{test.variable}={test.value}" for test in clause) for clause in edge.guard.integers)
    parts = [
        ("from", _scalar(edge.source)),
        ("to", _scalar(edge.target)),
        ("word", _scalar(event_word(automaton, edge))),
        ("sync", sync),
        ("when", _list(_bounds(edge.guard.clocks))),
        ("if", tests),
        ("set", _map((_scalar(name), str(value)) for name, value in edge.assign)),
        ("reset", _list(map(_scalar, edge.resets))),
        ("controllable", "true" if edge.controllable else "false"),
    ]
    return _map((name, text) for name, text in parts if text not in ("[]", "{}"))


def _bounds(bounds: Sequence[ClockBound]) -> List[str]:
    return [f"{bound.clock} {bound.op} {bound.bound}" for bound in bounds]


def _place(place: Optional[Tuple[str, str]]) -> str:
    return "null" if place is None else _list(map(_scalar, place))


def _list(texts: Iterable[str]) -> str:
    return f"[{', '.join(texts)}]"


def _map(parts: Iterable[Tuple[str, str]]) -> str:
    return "{" + ", ".join(f"{name}: {text}" for name, text in parts) + "}"


def _scalar(text: str) -> str:
    """The text as a YAML scalar that is read back as this very text."""
    return text if _PLAIN.fullmatch(text) and text.lower() not in _MISREAD else json.dumps(text)
