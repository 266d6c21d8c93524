"""Scenarios without one of their parts: an agent, a rule, a dependency, an objective."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from operator import attrgetter
from typing import AbstractSet, Any, Callable, Iterator, Optional, Set, Tuple

from pursue_gen.language.conditions import condition_text, names_in
from pursue_gen.language.scenario import (
    Agent,
    Assumption,
    Ref,
    RuleBody,
    Scenario,
    StatedObjective,
)


@dataclass(frozen=True)
class Part:
    """Something that a scenario can do without. `name` as in "without …"; `left_out` returns the scenario without it,
    None where an objective would have no meaning then.
    """

    name: str
    left_out: Callable[[Scenario], Optional[Scenario]]


def without_each(scenario: Scenario, objectives: bool = True) -> Iterator[Tuple[Part, Scenario]]:
    """The parts that the scenario can do without, and the scenario without each of them alone; `objectives`: these
    are among them."""
    found = [Part(agent.name, partial(without_agent, name=agent.name)) for agent in scenario.agents]
    found += [Part(f"rule {rule.name}", _smaller("rules", rule, "name")) for rule in scenario.rules]
    limited = (event for event in scenario.events if event.at_most)
    found += [Part(f"at_most of {event.name}", _smaller("events", event, "name", "at_most")) for event in limited]
    for event in scenario.events:
        words = (word for word in ("gives", "needs") if getattr(event, word) is not None)
        found += [Part(f"{word} of {event.name}", _smaller("events", event, "name", word)) for word in words]
    for one in scenario.batteries:
        found.append(Part(f"the battery of {one.agent.name}", _smaller("batteries", one, "agent.name")))
    for need in scenario.dependencies:
        value = "true" if need.value else "false"
        name = f"stateDependency {need.event.name} only_if {need.state.name} is_{value}"
        found.append(Part(name, _smaller("dependencies", need, "event.name state.name")))
    found += [Part(f"only_if {text} on {what}", left_out) for what, text, left_out in without_conditions(scenario)]
    if objectives and len(scenario.statements) > 1:
        for first, *_ in scenario.statements:
            name = f"{first.word} {first.text}{first.words.behind}".lstrip()
            found.append(Part(name, partial(without_objective, objective=first)))
    for part in found:
        smaller = part.left_out(scenario)
        if smaller is not None:
            yield part, smaller


def without_agent(scenario: Scenario, name: str) -> Optional[Scenario]:
    """The scenario without the agent and without the events that only it can do or, if they need another, react to.

    None where no controllable agent would be left, or where an objective or a condition names it or such an event.
    """
    agents = tuple(agent for agent in scenario.agents if agent.name != name)
    gone = _events(scenario, scenario.agents) - _events(scenario, agents)
    if not any(agent.controllable for agent in agents) or (gone | {name}) & _wanted(scenario):
        return None
    states = tuple(
        replace(
            state,
            true_if=_others(state.true_if, gone),
            false_if=_others(state.false_if, gone),
            shown_by=_others(state.shown_by, gone),
        )
        for state in scenario.states
    )
    named = {ref.name for condition, _ in scenario.conditions() for _, ref in names_in(condition)}
    kept = {state.name for state in states if state.true_if or state.false_if or state.name in named}
    bodies = [(rule, _body(rule.body, gone)) for rule in scenario.rules]
    return replace(
        scenario,
        events=tuple(event for event in scenario.events if event.name not in gone),
        rules=tuple(replace(rule, body=body) for rule, body in bodies if body and not isinstance(body, Ref)),
        states=tuple(state for state in states if state.name in kept),
        dependencies=tuple(d for d in scenario.dependencies if d.event.name not in gone and d.state.name in kept),
        agents=tuple(
            replace(a, can_do=_others(a.can_do, gone), reacts_to=_others(a.reacts_to, gone)) for a in agents
        ),
        travels=tuple(travel for travel in scenario.travels if travel.agent.name != name),
        batteries=tuple(battery for battery in scenario.batteries if battery.agent.name != name),
        assumptions=tuple(a for a in scenario.assumptions if not _names(a, name, gone)),
    )


def _names(assumption: Assumption, agent: str, gone: AbstractSet[str]) -> bool:
    """True if the assumption is about the agent or one of these events; what a condition names is never left out."""
    wanted = {"agent": {agent}, "event": gone}
    return any(ref.name in wanted.get(kind, ()) for kind, ref in assumption.names())


def without_conditions(scenario: Scenario) -> Iterator[Tuple[str, str, Callable[[Scenario], Scenario]]]:
    """For each event or way with `only_if` its name, the condition as a text, and what makes a scenario without it."""
    for way in scenario.connections:
        if way.only_if is not None:
            free = _smaller("connections", way, "a b only_for not_for", "only_if")
            yield way.what, condition_text(way.only_if), free
    for event in scenario.events:
        if event.only_if is not None:
            yield event.name, condition_text(event.only_if), _smaller("events", event, "name", "only_if")


def _smaller(kind: str, part: object, keys: str, field: str = "") -> Callable[[Scenario], Scenario]:
    """What leaves out the part of this kind that is the same in these keys; with `field` that field of it alone."""

    def smaller(whole: Scenario) -> Scenario:
        key = attrgetter(*keys.split())
        parts = [(each, key(each) == key(part)) for each in getattr(whole, kind)]
        kept = [replace(each, **{field: None}) if same else each for each, same in parts if field or not same]
        changed: Any = {kind: tuple(kept)}
        return replace(whole, **changed)

    return smaller


def without_objective(scenario: Scenario, objective: StatedObjective) -> Optional[Scenario]:
    """The scenario without the objective and what has no meaning without it; None where it has no other one that has
    to be met."""
    kept = [other for statement in scenario.statements if objective not in statement for other in statement]
    if all(other.optional for other in kept):
        return None
    return scenario.with_each(lambda each: each if each in kept else None)


def _events(scenario: Scenario, agents: Tuple[Agent, ...]) -> Set[str]:
    """The events that these agents can do among themselves."""
    doing = {ref.name for agent in agents for ref in agent.can_do}
    reacting = {ref.name for agent in agents for ref in agent.reacts_to}
    together = {event.name for event in scenario.events if event.collaborative}
    return {name for name in doing if name not in together or name in reacting}


def _wanted(scenario: Scenario) -> Set[str]:
    """The events and agents that the objectives and conditions name."""
    names = {ref.name for condition, _ in scenario.conditions() for _, ref in names_in(condition)}
    stated = (each.names() for each in scenario.objectives)
    names |= {ref.name for each in stated for kind, ref in each if kind in ("event", "agent")}
    names |= {agent.name for patrol in scenario.patrols for agent in scenario.on_patrol(patrol)}
    return names


def _others(refs: Tuple[Ref, ...], gone: AbstractSet[str]) -> Tuple[Ref, ...]:
    return tuple(ref for ref in refs if ref.name not in gone)


def _body(body: RuleBody, gone: AbstractSet[str]) -> Optional[RuleBody]:
    """The order of the other events; None if there are none."""
    if isinstance(body, Ref):
        return None if body.name in gone else body
    first, second = _body(body.first, gone), _body(body.second, gone)
    if first is None or second is None:
        return first or second
    return replace(body, first=first, second=second)
