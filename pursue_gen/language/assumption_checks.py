"""Checks of assumptions: whether they say something, and of whom."""

from __future__ import annotations

from typing import Dict, Iterator, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, Span
from pursue_gen.language.assumptions.base import Setting
from pursue_gen.language.behaviour import destinations_from
from pursue_gen.language.clauses import Domains, TooMany, holds_at_start
from pursue_gen.language.conditions import Condition
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Agent, Scenario


def setting_of(scenario: Scenario) -> Setting:
    """The scenario as assumptions ask for it."""

    def at_start(condition: Condition) -> bool:
        try:
            return holds_at_start(condition, scenario, Domains(scenario))
        except TooMany:
            return False  # reported with the condition

    def next_to(place: str, agent: str) -> Set[str]:
        ways = (way for connection in scenario.ways_of(agent) for way in connection.directions)
        return {end for start, end in ways if start == place}

    ruled = {ref.name for rule in scenario.rules for ref in rule.events}
    ruled.update(dependency.event.name for dependency in scenario.dependencies)
    return Setting(
        scenario.agents, scenario.events, scenario.states, scenario.safety, scenario.assumed,
        lambda place, agent: destinations_from(scenario, place, agent), next_to,
        lambda agent: open_ways(scenario, agent), at_start, lambda agent: _longest(scenario, agent), scenario.rest,
        ruled,
    )  # fmt: skip


def open_ways(scenario: Scenario, agent: Agent) -> Dict[Tuple[str, str], Number]:
    """The ways that are always open, and that no assumption keeps the agent from, with their longest times."""
    shunned = {place for each in scenario.assumptions if each.binds(agent) for place in each.shunned}
    own = scenario.ways_of(agent.name)
    closed = {way for each in own if each.only_if is not None for way in each.directions}
    ways = scenario.movements(agent).items()
    return {way: most for way, (_, most) in ways if way not in closed and way[1] not in shunned}


def _longest(scenario: Scenario, agent: Agent) -> Dict[str, Number]:
    """By place the longest way of the agent there, or the longest that it is busy there."""
    found: Dict[str, Number] = {}
    for (_, place), (_, most) in scenario.movements(agent).items():
        found[place] = max(most, found.get(place, 0))
    named = {ref.name for ref in agent.can_do}
    for event in (each for each in scenario.events if each.name in named and each.part_window is not None):
        assert event.part_window is not None
        for place in [poi.name for poi in scenario.pois] if event.location is None else [event.location.name]:
            found[place] = max(event.part_window[1], found.get(place, 0))
    return found


def check_assumptions(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about assumptions whose names are declared: whom they are about, their numbers, whether they matter."""
    setting = setting_of(scenario)
    seen: Dict[str, Span] = {}
    for assumption in scenario.assumptions:
        if assumption.subject in seen:
            yield assumption.again(seen[assumption.subject])
        seen.setdefault(assumption.subject, assumption.span)
    for assumption in scenario.assumed:
        yield from assumption.check_in(setting)
