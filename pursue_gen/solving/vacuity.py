"""Objectives that hold because of assumptions alone, whether or not the robots do anything."""

from __future__ import annotations

from dataclasses import replace
from typing import Collection, Iterator, Tuple

from pursue_gen.diagnostics import Diagnostic, warning
from pursue_gen.language.scenario import Assumption, Safety, Scenario
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits, careful_memory
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Network

_WORK = 3_000_000
"""The work for all games together: half a second at most. What it does not decide gives no warning. Not measured."""


def check_assumed_alone(scenario: Scenario) -> Iterator[Diagnostic]:
    """A warning for each objective that idle robots keep under the assumptions, and not without them."""
    if not scenario.assumptions:
        return
    budget = Budget(Limits(work=_WORK, memory=careful_memory()))
    try:
        for objective in scenario.safety:
            if objective.breaks.by_robots:
                continue
            everything = scenario.assumptions
            if not _holds(scenario, objective, everything, budget) or _holds(scenario, objective, (), budget):
                continue
            singles = ((each,) for each in everything)
            enough = next((one for one in singles if _holds(scenario, objective, one, budget)), everything)
            why = " and ".join(each.clause for each in enough)
            message = f"{objective.text}: this holds without anything that robots do, as long as {why}"
            hint = "assume less where the robots are to see to it; else delete the objective"
            yield warning("PML265", message, objective.span, hint)
    except LimitHit:
        pass


def _holds(scenario: Scenario, objective: Safety, assumptions: Tuple[Assumption, ...], budget: Budget) -> bool:
    """True if the objective holds though no robot does anything. Raises LimitHit."""
    alone = replace(scenario, safety=(objective,), reach=(), assumptions=assumptions)
    rules = Rules()
    network = played(translate(alone), rules)
    agents = {automaton.name for automaton in network.automata if is_agent(automaton)}
    return budget.verdict(idle(network, agents), scenario_objective(alone), rules.reaction).won


def idle(network: Network, names: Collection[str]) -> Network:
    """The network in which the controlled of these agents begin nothing; they take part in what others begin."""
    return network.with_each(
        lambda a: a.with_edges(edge for edge in a.edges if not edge.is_command) if a.name in names else a
    )
