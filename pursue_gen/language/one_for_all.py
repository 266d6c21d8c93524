"""Whether several of an event that has to be answered may be answered by one."""

from __future__ import annotations

from pursue_gen.language.scenario import Event, Scenario, StatedObjective


def is_one_for_all(objective: StatedObjective, scenario: Scenario) -> bool:
    """True for `if e then f within T` where somebody who is not controlled may do e again before T is over, as far as
    statements alone say: then one f answers several of them. False where that is not sure."""
    name = objective.called_by
    if not name or objective.order:
        return False
    event = next((each for each in scenario.events if each.name == name), None)
    if event is None or not _is_free(event, scenario) or objective.known_limit <= scenario.rest:
        return False
    doers = [agent for agent in scenario.doers(name) if not agent.controllable]
    return bool(doers) and all(each.allows(name, objective.known_limit) for each in scenario.assumed)


def _is_free(event: Event, scenario: Scenario) -> bool:
    """True if nothing but who can do it restricts an event that takes no time."""
    ruled = any(ref.name == event.name for rule in scenario.rules for ref in rule.events)
    needs = any(need.event.name == event.name for need in scenario.dependencies)
    alone = event.duration is None and not event.collaborative and event.only_if is None
    return alone and event.at_most != 1 and not ruled and not needs
