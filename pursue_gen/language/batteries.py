"""Batteries: what a robot uses and recharges, at which levels its battery can be, and what is wrong with them.

What a movement or an action may use at most is taken off when it begins, so a battery never runs empty on the way; what
is recharged at least is added when an action at the dock ends. The one is rounded up, the other down: levels are whole.
Where ways use by their lengths, nothing is rounded: a unit of the capacity has as many levels as make all of it whole.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor, gcd
from typing import Dict, Iterator, Mapping, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.numbers import decimal_text, exact
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.scenario import Agent, Battery, Endurance, Event, Scenario
from pursue_gen.language.times import like, written_time

_LARGEST = 30_000
"""The largest level: UPPAAL has variables of 16 bits."""

MOST_LEVELS = 60
"""The most levels at which a battery can be: each multiplies the states of the game."""


def levels_in(scenario: Scenario, battery: Battery) -> int:
    """How many levels there are in a unit of the capacity: one, or as many as make all that is used by way of lengths
    and at work, and recharged, whole."""
    found, driven = 1, _driven(scenario, battery)
    at_work = (*_used_at_work(scenario, battery).values(), *_recharged(scenario, battery).values())
    for number in (*driven.values(), *at_work) if driven else ():
        found *= number.denominator // gcd(found, number.denominator)
    return found


def full(scenario: Scenario, battery: Battery) -> int:
    """The level of a full battery."""
    return battery.capacity * levels_in(scenario, battery)


def shown_level(scenario: Scenario, battery: Battery, level: int) -> str:
    """A level, or so many levels, in units of the capacity."""
    return decimal_text(exact(Fraction(level, levels_in(scenario, battery))))


def _driven(scenario: Scenario, battery: Battery) -> Dict[Tuple[str, str], Fraction]:
    """What each movement uses by its length, in units of the capacity; none where time counts."""
    agent = _agent(scenario, battery)
    if battery.driving is None or agent.mobile is None:
        return {}
    ways = ((way, each.distance) for each in scenario.ways_of(agent.name) for way in each.directions)
    return {way: Fraction(battery.driving) * Fraction(distance) for way, distance in ways}


def movements_use(scenario: Scenario, battery: Battery) -> Dict[Tuple[str, str], int]:
    """From and to of each movement of the battery's robot, and how many levels it uses at most."""
    if battery.driving is not None:
        in_one = levels_in(scenario, battery)
        return {way: int(use * in_one) for way, use in _driven(scenario, battery).items()}
    agent = _agent(scenario, battery)
    return {way: ceil(battery.uses * window[1]) for way, window in scenario.movements(agent).items()}


def actions_use(scenario: Scenario, battery: Battery) -> Dict[Tuple[str, str], int]:
    """Event and place of each of its robot's actions elsewhere than at the dock, and the levels used at most."""
    in_one = levels_in(scenario, battery)
    return {action: ceil(use * in_one) for action, use in _used_at_work(scenario, battery).items()}


def _used_at_work(scenario: Scenario, battery: Battery) -> Dict[Tuple[str, str], Fraction]:
    return {
        (event.name, place): Fraction(battery.uses) * Fraction(event.part_window[1])
        for event, place in _actions(scenario, battery)
        if event.part_window is not None and not is_dock(battery, place)
    }


def recharges(scenario: Scenario, battery: Battery) -> Dict[Tuple[str, str], int]:
    """Event and place of each of its robot's actions at the dock, and how many levels that recharges at least."""
    in_one = levels_in(scenario, battery)
    return {action: floor(gain * in_one) for action, gain in _recharged(scenario, battery).items()}


def _recharged(scenario: Scenario, battery: Battery) -> Dict[Tuple[str, str], Fraction]:
    return {
        (event.name, place): Fraction(battery.recharges) * Fraction(event.part_window[0])
        for event, place in _actions(scenario, battery)
        if event.part_window is not None and is_dock(battery, place)
    }


def is_dock(battery: Battery, place: str) -> bool:
    """True for the place where the battery is recharged."""
    return battery.dock is not None and battery.dock.name == place


def levels(scenario: Scenario, battery: Battery) -> Tuple[int, ...]:
    """Every level at which the battery can be, the full one first."""
    uses = {*movements_use(scenario, battery).values(), *actions_use(scenario, battery).values()}
    gains = set(recharges(scenario, battery).values())
    most = full(scenario, battery)
    found, waiting = {most}, [most]
    while waiting:
        level = waiting.pop()
        following = {level - use for use in uses if use <= level}
        following |= {min(most, level + gain) for gain in gains}
        waiting += following - found
        found |= following
    return tuple(sorted(found, reverse=True))


def check_batteries(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about batteries whose names are declared."""
    agents = {agent.name: agent for agent in scenario.agents}
    seen: Dict[str, Span] = {}
    for battery in sorted(scenario.powered, key=lambda each: (each.span.line, each.span.column)):
        agent = agents.get(battery.agent.name)
        if agent is None:
            continue
        if agent.name in seen:
            message = f"{seen[agent.name].in_words} gives {agent.name} a battery already"
            yield error("PML311", message, battery.span, "delete one of the two")
        seen.setdefault(agent.name, battery.span)
    for by_level in (each for each in scenario.batteries if each.agent.name in agents):
        agent = agents[by_level.agent.name]
        problems = [*_of(agent, by_level), *_shared(agent, scenario), *by_level.check()]
        yield from problems or _levels(scenario, by_level)
    for _, by_time in batteries_in(scenario.safety):
        for agent in (agents[name] for name in (by_time.agent.name,) if name in agents):
            yield from [*_of(agent, by_time)] or _too_long(agent, by_time, scenario)


def _of(agent: Agent, battery: Union[Battery, Endurance]) -> Iterator[Diagnostic]:
    if not agent.is_robot:
        name = agent.name
        message = f"{name} is no robot: a strategy sees to the batteries of robots"
        hint = f"write controllable behind {name} (and no human), or delete this line"
        yield error("PML310", message, battery.agent.span, hint)


def _shared(agent: Agent, scenario: Scenario) -> Iterator[Diagnostic]:
    """What a robot that may run empty takes part in, and others end."""
    name, events = agent.name, {event.name: event for event in scenario.events}
    for ref in agent.reacts_to:
        if events[ref.name].is_shared:
            message = f"{name} takes part in {ref.name} until it ends, and others decide when: it could run empty"
            hint = f"let {name} be the one that can_do {ref.name}, or delete together"
            yield error("PML314", message, ref.span, hint)


def _too_long(agent: Agent, endurance: Endurance, scenario: Scenario) -> Iterator[Diagnostic]:
    for way, window in scenario.movements(agent).items():
        if window[1] > endurance.lasts > 0:
            name, lasts, takes = agent.name, endurance.lasts, written_time(window[1])
            message = f"a full battery does not last {name} from {way[0]} to {way[1]}: that takes up to {takes}"
            enough = written_time(like(ceil(window[1]), lasts))
            hint = f"{name} never sets off on it; write lasts {enough} or more, not {written_time(lasts)}"
            yield warning("PML316", message, endurance.span, hint)


def _levels(scenario: Scenario, battery: Battery) -> Iterator[Diagnostic]:
    name = battery.agent.name
    if battery.dock is not None and not recharges(scenario, battery):
        dock = battery.dock.name
        message = f"{name} never recharges: it can do nothing at {dock} that lasts"
        hint = f'let it: event "charge" location {dock} duration 10, and can_do charge'
        yield error("PML313", message, battery.dock.span, hint)
        return
    most = full(scenario, battery)
    if most > _LARGEST:
        message = f"what {name} uses on its ways has too many digits: the full battery would be level {most}"
        yield error("PML315", message, battery.span, "round distances, or what it uses per metre")
        return
    count = len(levels(scenario, battery))
    if count > MOST_LEVELS:
        message = f"the battery of {name} can be at {count} levels, and multiplies the states of the game by as many"
        uses = {*movements_use(scenario, battery).values(), *actions_use(scenario, battery).values()}
        shown = ", ".join(shown_level(scenario, battery, use) for use in sorted(uses))
        coarser = f"a larger unit, or times with a common divisor (movements and actions use, at most: {shown})"
        yield error("PML315", message, battery.span, f"at most {MOST_LEVELS} are possible; choose {coarser}")
    for way, use in movements_use(scenario, battery).items():
        if use > most:
            enough, used = ceil(Fraction(use, most) * battery.capacity), shown_level(scenario, battery, use)
            message = f"a full battery does not last {name} from {way[0]} to {way[1]}: that uses up to {used}"
            hint = f"{name} never sets off on it; write capacity {enough} or more"
            yield warning("PML316", message, battery.span, hint)


def _actions(scenario: Scenario, battery: Battery) -> Iterator[Tuple[Event, str]]:
    """The lasting events that the battery's robot can do, with each place where it can."""
    agent = _agent(scenario, battery)
    able = {ref.name for ref in agent.can_do}
    everywhere = [agent.location.name] if agent.mobile is None else [poi.name for poi in scenario.pois]
    for event in scenario.events:
        if event.name in able and event.duration is not None:
            for place in everywhere if event.location is None else [event.location.name]:
                yield event, place


def _agent(scenario: Scenario, battery: Battery) -> Agent:
    agents: Mapping[str, Agent] = {agent.name: agent for agent in scenario.agents}
    return agents[battery.agent.name]
