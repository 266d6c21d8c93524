"""Agents in words, by what locations and channels stand for: where one is, and what it does. Robots and the UI have the
same words (`pursue_runtime.vocabulary`)."""

from __future__ import annotations

from typing import Optional

from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import UNDER_WAY, Role, Symbol
from pursue_gen.tga.network import Edge
from pursue_runtime import vocabulary as words

_DEEDS = {
    Role.SETTING_OFF: words.SETS_OFF, Role.ARRIVAL: words.ARRIVES, Role.WAY: words.ARRIVES,
    Role.EVENT: words.DOES, Role.WORK: words.BEGINS, Role.END: words.FINISHES, Role.BROKEN_OFF: words.BREAKS_OFF,
    Role.PART_END: words.FINISHES_PART, Role.STARTS: words.STARTS,
}  # fmt: skip
"""What an agent does, by the role of its channel; of the location that it leaves or enters where that says more."""


def place(scenario: Scenario, location: str) -> str:
    """Where an agent is, behind `is`: `at c`, `on its way from c to b`, `doing catch at b`."""
    symbol = Symbol.of(location)
    if symbol.role is Role.SOMEWHERE:
        return words.UNPLACED
    if symbol.role not in UNDER_WAY:
        return words.AT.format(scenario.shown(location))
    return (words.ON_WAY if symbol.role is Role.WAY else words.AT_WORK).format(*map(scenario.shown, symbol.parts))


def deed(scenario: Scenario, automaton: str, edge: Edge) -> Optional[words.Deed]:
    """What an agent does by that edge; None where it is no agent, or there are no words for it."""
    symbol = Symbol.of(edge.sync.channel if edge.sync else edge.source)
    if symbol.role is Role.FOUND and edge.leaves is Role.FINDING:
        return words.FOUND.of(symbol.parts[-1])
    role = Role.WORK if symbol.role is Role.EVENT and edge.enters is Role.WORK else symbol.role
    said = _DEEDS.get(role) if any(agent.name == automaton for agent in scenario.agents) else None
    parts = symbol.parts[-1:] if said in (words.ARRIVES, words.STARTS) else symbol.parts[-2:]
    return None if said is None else said.of(*map(scenario.shown, parts))
