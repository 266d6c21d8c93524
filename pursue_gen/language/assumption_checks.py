"""Checks of assumptions: whether they say something, and of whom."""

from __future__ import annotations

from typing import Dict, Iterator, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.behaviour import destinations_from
from pursue_gen.language.scenario import Agent, Assumption, AtMost, Leaves, NeverAt, Scenario, Waits
from pursue_gen.language.wording import assumption_words

MOST_TIMES = 100
"""The most times that an assumption may allow: each is a value of a variable of its own."""

SHORTEST_STAY = 2
"""Time units: an agent rests for one before it may set off."""


def check_assumptions(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about assumptions whose names are declared: whom they are about, their numbers, whether they matter."""
    agents = {agent.name: agent for agent in reversed(scenario.agents)}
    seen: Dict[Tuple[object, ...], Span] = {}
    for assumption in scenario.assumptions:
        agent = agents.get(assumption.agent.name)
        if agent is None:
            continue
        key = _subject(assumption)
        if key in seen:
            message = f"line {seen[key].line} assumes this of {agent.name} already"
            yield error("PML253", message, assumption.span, "keep the one that is meant")
        seen.setdefault(key, assumption.span)
        if agent.controllable:
            message = f"{agent.name} is controlled: what it does is decided, not assumed"
            hint = "write an objective, a rule or a stateDependency, or take controllable away from it"
            yield error("PML250", message, assumption.agent.span, hint)
            continue
        found = _number(assumption) or _place(assumption, agent, scenario) or _event(assumption, agent)
        if found is not None:
            yield found


def _subject(assumption: Assumption) -> Tuple[object, ...]:
    """What an assumption is about: two of one subject would say the same, or contradict."""
    about = assumption.event if isinstance(assumption, (AtMost, Waits)) else assumption.place
    return type(assumption), assumption.agent.name, about.name


def _number(assumption: Assumption) -> Optional[Diagnostic]:
    if isinstance(assumption, AtMost) and assumption.times > MOST_TIMES:
        message = f"at_most {assumption.times}: expected {MOST_TIMES} or less, as each time is counted"
        hint = "write a smaller number, or how long it waits: waits 5 between"
        return error("PML251", message, assumption.span, hint)
    if isinstance(assumption, Waits) and assumption.time <= 0:
        message = "waits 0 assumes nothing: expected more than 0"
        return error("PML251", message, assumption.span, "write the time, or delete the assumption")
    if isinstance(assumption, Leaves) and assumption.time < SHORTEST_STAY:
        message = f"within {assumption.time} is too short: whoever arrives rests for 1 time unit before it can set off"
        return error("PML251", message, assumption.span, f"write within {SHORTEST_STAY} or more")
    return None


def _place(assumption: Assumption, agent: Agent, scenario: Scenario) -> Optional[Diagnostic]:
    if not isinstance(assumption, (Leaves, NeverAt)):
        return None
    place, start = assumption.place.name, agent.location.name
    if agent.mobile is None:
        stays = f"{agent.name} is not mobile: it stays in {start}"
        if isinstance(assumption, Leaves) and place == start:
            return error("PML252", f"{stays}, and cannot leave it", assumption.span, "make it mobile (mobile 1)")
        if isinstance(assumption, NeverAt) and place == start:
            return error("PML252", stays, assumption.span, "let it start somewhere else")
        return warning("PML254", f"{stays} anyway", assumption.span, "delete the assumption")
    if place not in destinations_from(scenario, start):
        message = f"no way leads {agent.name} from {start} to {place} anyway"
        return warning("PML254", message, assumption.span, "delete the assumption")
    if isinstance(assumption, NeverAt) and place == start:
        return error("PML252", f"{agent.name} starts in {start}", assumption.span, "let it start somewhere else")
    if isinstance(assumption, Leaves) and destinations_from(scenario, place) == {place}:
        return error("PML252", f"no way leads away from {place}", assumption.span, f"connect {place} and …")
    return None


def _event(assumption: Assumption, agent: Agent) -> Optional[Diagnostic]:
    if not isinstance(assumption, (AtMost, Waits)) or any(ref.name == assumption.event.name for ref in agent.can_do):
        return None
    message = f"{assumption_words(assumption)}: {agent.name} cannot do {assumption.event.name} anyway"
    hint = f"delete the assumption, or give it to {agent.name}: can_do {assumption.event.name}"
    return warning("PML254", message, assumption.event.span, hint)
