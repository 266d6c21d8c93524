"""Checks of assumptions: whether they say something, and of whom."""

from __future__ import annotations

from typing import AbstractSet, Dict, Iterator, Mapping, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.behaviour import destinations_from
from pursue_gen.language.clauses import Domains, TooMany, holds_at_start
from pursue_gen.language.conditions import Atom, Doing, Holds, atoms, condition_text, condition_words
from pursue_gen.language.scenario import AboutOne, Agent, AtMost, Leaves, NeverAt, NeverHolds, Scenario, Waits
from pursue_gen.language.wording import assumption_words

MOST_TIMES = 100
"""The most times that an assumption may allow: each is a value of a variable of its own."""

SHORTEST_STAY = 2
"""Time units: an agent rests for one before it may set off."""


def check_assumptions(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about assumptions whose names are declared: whom they are about, their numbers, whether they matter."""
    agents = {agent.name: agent for agent in reversed(scenario.agents)}
    seen: Dict[Tuple[object, ...], Span] = {}
    leaving = {assumption.agent.name for assumption in scenario.assumptions if isinstance(assumption, Leaves)}
    for assumption in scenario.assumptions:
        if isinstance(assumption, NeverHolds):
            yield from _never_holds(assumption, scenario, seen, leaving)
            continue
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


def _never_holds(
    assumption: NeverHolds, scenario: Scenario, seen: Dict[Tuple[object, ...], Span], leaving: AbstractSet[str]
) -> Iterator[Diagnostic]:
    """An assumption on a condition that a controlled agent can bring about, or that contradicts others."""
    agents = {agent.name: agent for agent in reversed(scenario.agents)}
    key = (NeverHolds, condition_text(assumption.condition))
    if key in seen:
        yield error("PML253", f"line {seen[key].line} assumes this already", assumption.span, "delete one of the two")
    seen.setdefault(key, assumption.span)
    sound = True
    for atom in atoms(assumption.condition):
        for finding in _of_others(atom, agents, scenario, assumption.span, leaving):
            sound = False
            yield finding
    try:
        if sound and holds_at_start(assumption.condition, scenario, Domains(scenario)):
            message = f"this holds at the start: {condition_words(assumption.condition)}"
            hint = "let agents start somewhere else, start the states with other values, or correct the condition"
            yield error("PML252", message, assumption.span, hint)
    except TooMany:
        return  # reported with the condition


def _of_others(
    atom: Atom, agents: Mapping[str, Agent], scenario: Scenario, span: Span, leaving: AbstractSet[str]
) -> Iterator[Diagnostic]:
    """What is wrong with a part of the condition: who can bring it about, and who may not be kept from moving."""
    decided = "what robots and allies do is decided, not assumed"
    if isinstance(atom, Holds):
        events = {r.name for s in scenario.states if s.name == atom.state.name for r in (*s.true_if, *s.false_if)}
        doers = [(agent.name, ref.name) for agent in scenario.agents for ref in agent.can_do if agent.controllable]
        for name, event in ((name, event) for name, event in doers if event in events):
            message = f"{name} is controlled, and its {event} sets {atom.state.name}: {decided}"
            yield error("PML263", message, atom.state.span, "write an objective instead, as in objective: avoid …")
        return
    ref = atom.who.agent
    if ref is None:
        if any(agent.controllable for agent in scenario.agents):
            message = f"any {'robot' if atom.who.robots else 'agent'} means controlled ones as well: {decided}"
            yield error("PML263", message, span, "name the agents that are meant, or write an objective instead")
        return
    if ref.name in agents and agents[ref.name].controllable:
        message = f"{ref.name} is controlled: what it does is decided, not assumed"
        yield error("PML250", message, ref.span, "write an objective instead, as in objective: avoid …")
    elif ref.name in leaving:
        message = f"{ref.name} is assumed to leave a place in time, and could be kept from setting off by this"
        yield error("PML264", message, ref.span, "assume one of the two, or never at in place of not")
    elif isinstance(atom, Doing):
        shared = any(event.name == atom.event.name and event.is_shared for event in scenario.events)
        for agent in (a for a in scenario.agents if a.controllable and shared):
            if any(each.name == atom.event.name for each in agent.can_do):
                message = f"{agent.name} is controlled, and can begin {atom.event.name} with {ref.name}: {decided}"
                yield error("PML263", message, atom.event.span, "write an objective instead, as in objective: avoid …")


def _subject(assumption: AboutOne) -> Tuple[object, ...]:
    """What an assumption is about: two of one subject would say the same, or contradict."""
    about = assumption.event if isinstance(assumption, (AtMost, Waits)) else assumption.place
    return type(assumption), assumption.agent.name, about.name


def _number(assumption: AboutOne) -> Optional[Diagnostic]:
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


def _place(assumption: AboutOne, agent: Agent, scenario: Scenario) -> Optional[Diagnostic]:
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


def _event(assumption: AboutOne, agent: Agent) -> Optional[Diagnostic]:
    if not isinstance(assumption, (AtMost, Waits)) or any(ref.name == assumption.event.name for ref in agent.can_do):
        return None
    message = f"{assumption_words(assumption)}: {agent.name} cannot do {assumption.event.name} anyway"
    hint = f"delete the assumption, or give it to {agent.name}: can_do {assumption.event.name}"
    return warning("PML254", message, assumption.event.span, hint)
