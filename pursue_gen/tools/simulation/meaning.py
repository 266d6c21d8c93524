"""What conditions mean, said of where agents are and of the values of states: for judges, independent of the guards."""

from __future__ import annotations

from typing import Mapping

from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import AllOf, AnyOf, At, Condition, Holds, Not, OnWay
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, role_of


def holds(condition: Condition, scenario: Scenario, locations: Mapping[str, str], values: Mapping[str, int]) -> bool:
    """True if a condition holds where agents are at these locations of their automata and variables have these values.

    Raises KeyError for an agent or a state that is not there.
    """
    if isinstance(condition, Not):
        return not holds(condition.part, scenario, locations, values)
    if isinstance(condition, AllOf):
        return all(holds(part, scenario, locations, values) for part in condition.parts)
    if isinstance(condition, AnyOf):
        return any(holds(part, scenario, locations, values) for part in condition.parts)
    if isinstance(condition, Holds):
        return bool(values[names.state_value(condition.state.name)]) is condition.value
    who = condition.who
    if who.agent is not None:
        meant = [who.agent.name]
    else:
        meant = [agent.name for agent in scenario.agents if agent.is_robot or not who.robots]
    places = [locations[name] for name in meant]
    if isinstance(condition, OnWay):
        return any(role_of(place) is Role.WAY for place in places)
    if isinstance(condition, At):
        poi = condition.place.name
        here = {poi, *(names.doing(event.name, poi) for event in scenario.events)}
    else:
        here = {names.doing(condition.event.name, poi.name) for poi in scenario.pois}
    return any(place in here for place in places)
