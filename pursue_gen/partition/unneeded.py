"""Robots and allies that a strategy does without."""

from __future__ import annotations

from typing import Sequence, Set, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.language.clauses import Domains
from pursue_gen.language.conditions import Holds, atoms
from pursue_gen.language.scenario import Agent, Scenario
from pursue_gen.synthesis.strategy import Strategy


def unneeded(scenario: Scenario, strategy: Strategy) -> Tuple[Agent, ...]:
    """The controllable agents that the strategy never moves, and whose mere presence helps nobody.

    Who stands at a place of a patrol, is named in a condition, or may be needed by somebody else's event, is needed.
    So are all where people may order something.
    """
    if scenario.orders:
        return ()
    moves = [move for block in strategy.blocks for command in block.commands for move in command.moves]
    moved = {move.automaton for move in moves}
    begun = {move.edge.channel for move in moves}
    begun |= {ref.name for agent in scenario.agents if not agent.controllable for ref in agent.can_do}
    present = _present(scenario)
    return tuple(
        agent
        for agent in scenario.agents
        if agent.controllable
        and agent.name not in moved | present
        and not any(ref.name in begun for ref in agent.reacts_to)
    )


def unneeded_words(agents: Sequence[Agent]) -> str:
    """That these agents are not needed, as a sentence; "" where there are none."""
    if not agents:
        return ""
    verb, them = ("is", "it") if len(agents) == 1 else ("are", "them")
    names = listed(agent.shown for agent in agents)
    return f"{names} {verb} not needed in this mission: the strategy never commands {them}."


def _present(scenario: Scenario) -> Set[str]:
    """The agents that objectives and conditions look at where they stand."""
    domains = Domains(scenario)
    found: Set[str] = set()
    for condition, _ in scenario.conditions():
        for atom in atoms(condition):
            if not isinstance(atom, Holds):
                found.update(domains.among(atom.who))
    for patrol in scenario.patrols:
        places = patrol.order or (patrol.place.name,)
        found.update(agent.name for agent in scenario.on_patrol(patrol) if agent.location.name in places)
    return found
