"""Whether several of an event that has to be answered may be answered by one."""

from __future__ import annotations

from pursue_gen.language.scenario import (
    Assumption,
    AtMost,
    Event,
    Every,
    InAll,
    MostOpen,
    NotBefore,
    Reaches,
    Ref,
    Respond,
    Scenario,
    StatedObjective,
    Waits,
)


def is_one_for_all(objective: StatedObjective, scenario: Scenario) -> bool:
    """True for `if e then f within T` where somebody who is not controlled may do e again before T is over, as far as
    statements alone say: then one f answers several of them. False where that is not sure."""
    if not isinstance(objective, Respond) or not isinstance(objective.trigger, Ref):
        return False
    name = objective.trigger.name
    event = next((each for each in scenario.events if each.name == name), None)
    if event is None or not _is_free(event, scenario) or objective.deadline <= scenario.rest:
        return False
    doers = [agent for agent in scenario.doers(name) if not agent.controllable]
    return bool(doers) and all(_allows(each, objective) for each in scenario.assumed)


def _is_free(event: Event, scenario: Scenario) -> bool:
    """True if nothing but who can do it restricts an event that takes no time."""
    ruled = any(ref.name == event.name for rule in scenario.rules for ref in rule.events)
    needs = any(need.event.name == event.name for need in scenario.dependencies)
    alone = event.duration is None and not event.collaborative and event.only_if is None
    return alone and event.at_most != 1 and not ruled and not needs


def _allows(assumption: Assumption, objective: Respond) -> bool:
    """True if the assumption lets the event come again before its answer."""
    name = getattr(objective.trigger, "name", "")
    if isinstance(assumption, Waits):
        return assumption.following.name != name or assumption.time < objective.deadline
    if isinstance(assumption, Every):
        return assumption.event.name != name or assumption.least < objective.deadline
    if isinstance(assumption, (AtMost, InAll)):
        return assumption.times > 1 or all(ref.name != name for _, ref in assumption.names())
    if isinstance(assumption, MostOpen):
        return assumption.event.name != name or assumption.most > 1
    return isinstance(assumption, (NotBefore, Reaches)) or all(ref.name != name for _, ref in assumption.names())
