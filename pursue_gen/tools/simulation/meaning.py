"""What conditions mean, said of where agents are and of the values of states: for judges, independent of the guards."""

from __future__ import annotations

from functools import lru_cache
from itertools import product
from typing import Callable, Iterable, Mapping, Set

from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import AllOf, AnyOf, At, AtMostOf, Atom, Condition, Has, Holds, Not, OnWay, names_in
from pursue_gen.language.loads import carriers
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, role_of


def holds(
    condition: Condition,
    scenario: Scenario,
    locations: Mapping[str, str],
    values: Mapping[str, int],
    whatever: Callable[[Iterable[object]], bool] = all,
) -> bool:
    """True if a condition holds where agents are at these locations of their automata and variables have these values,
    whatever the states are that are not known; with `any` if it may hold. Where it is not known yet where agents start,
    it holds wherever that is.

    Raises KeyError for an agent or a state that is not there.
    """
    named = (names.state_value(ref.name) for kind, ref in names_in(condition) if kind == "state")
    unknown = tuple(dict.fromkeys(name for name in named if values[name] == names.UNKNOWN_VALUE))
    some = ({**values, **dict(zip(unknown, known))} for known in product((0, 1), repeat=len(unknown)))
    known = tuple(some)
    starts = [each for each in scenario.agents if locations.get(each.name) == names.SOMEWHERE]
    return all(
        whatever(_holds(condition, scenario, {**locations, **there}, each) for each in known)
        for there in (
            dict(zip((each.name for each in starts), (ref.name for ref in places)))
            for places in product(*(each.starts for each in starts))
        )
    )


def _holds(condition: Condition, scenario: Scenario, locations: Mapping[str, str], values: Mapping[str, int]) -> bool:
    """True if it does where all states are known."""
    if isinstance(condition, Not):
        return not _holds(condition.part, scenario, locations, values)
    if isinstance(condition, AllOf):
        return all(_holds(part, scenario, locations, values) for part in condition.parts)
    if isinstance(condition, AnyOf):
        return any(_holds(part, scenario, locations, values) for part in condition.parts)
    if isinstance(condition, AtMostOf):
        found = {name for part in condition.parts for name in _found(part, scenario, locations, values)}
        return len(found) <= condition.most
    return bool(_found(condition, scenario, locations, values))


@lru_cache(maxsize=10_000)
def _going(a: str, b: str) -> str:
    return names.going(a, b)


@lru_cache(maxsize=10_000)
def _doing(event: str, poi: str) -> str:
    return names.doing(event, poi)


def _found(atom: Atom, scenario: Scenario, locations: Mapping[str, str], values: Mapping[str, int]) -> Set[str]:
    """The agents, or the state, of which it is so."""
    if isinstance(atom, Holds):
        name = atom.state.name
        return {name} if bool(values[names.state_value(name)]) is atom.value else set()
    who = atom.who
    if who.agent is not None:
        meant = [who.agent.name]
    else:
        meant = [agent.name for agent in scenario.agents if agent.is_robot or not who.robots]
    if isinstance(atom, Has):
        known = ((one.agent.name, one) for one in carriers(scenario) if atom.thing.name in one.names)
        loads = {name: dict(zip(one.names, one.loads[values[names.load(name)]])) for name, one in known}
        return {name for name in meant if loads.get(name, {}).get(atom.thing.name)}
    if isinstance(atom, OnWay) and not atom.ends:
        return {name for name in meant if role_of(locations[name]) is Role.WAY}
    if isinstance(atom, OnWay):
        a, b = (ref.name for ref in atom.ends)
        ways = ((a, b), (b, a)) if atom.either_way else ((a, b),)
        here: Set[str] = {_going(*way) for way in ways}
    elif isinstance(atom, At):
        poi = atom.place.name
        here = {poi, *(_doing(event.name, poi) for event in scenario.events)}
    else:
        here = {_doing(atom.event.name, poi.name) for poi in scenario.pois}
    return {name for name in meant if locations[name] in here}
