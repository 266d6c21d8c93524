"""What more could be assumed of others, as an author writes it: tighter assumptions, pauses between calls, and places
to which they do not come."""

from __future__ import annotations

from dataclasses import replace
from typing import Callable, Iterator, Sequence

from pursue_gen.explanation.number_changes import NumberChange
from pursue_gen.language.conditions import At, atoms
from pursue_gen.language.numbers import Number, whole_above, whole_below
from pursue_gen.language.scenario import AboutOne, Agent, AtMost, Leaves, NeverAt, Ref, Scenario, Waits

_SHORTEST_STAY = 2
"""Time units within which an agent can leave: whoever arrives rests for one before it can set off."""


def assumption_changes(scenario: Scenario, longest: Number) -> Iterator[NumberChange]:
    """Assumptions with another number, pauses of up to `longest` time units between two calls that are answered, and
    that agents do not come to places of which an objective says what must never be there."""
    for known in scenario.assumptions:
        if isinstance(known, AtMost):
            yield from _tighter(scenario, known, known.times, range(known.times - 1, 0, -1), _fewer(known))
        elif isinstance(known, Waits):
            yield from _tighter(scenario, known, known.time, whole_above(known.time, longest), _longer(known))
        elif isinstance(known, Leaves):
            yield from _tighter(scenario, known, known.time, whole_below(known.time, _SHORTEST_STAY), _sooner(known))
    yield from _pauses(scenario, longest)
    yield from _elsewhere(scenario)


def _fewer(known: AtMost) -> Callable[[int], AtMost]:
    return lambda k: replace(known, times=k)


def _longer(known: Waits) -> Callable[[int], Waits]:
    return lambda k: replace(known, time=k)


def _sooner(known: Leaves) -> Callable[[int], Leaves]:
    return lambda k: replace(known, time=k)


def _tighter(
    scenario: Scenario, known: AboutOne, before: Number, values: Sequence[int], changed: Callable[[int], AboutOne]
) -> Iterator[NumberChange]:
    def make(k: int) -> Scenario:
        return replace(scenario, assumptions=tuple(changed(k) if a == known else a for a in scenario.assumptions))

    def say(k: int) -> str:
        return f"{_text(changed(k))} instead of {before}"

    if values:
        label = f"more than {_text(known)}"
        yield NumberChange("assumption", known.agent.name, label, before, values, make, say, known.span)


def _pauses(scenario: Scenario, longest: Number) -> Iterator[NumberChange]:
    """For each event that has to be answered, and each agent that may begin it again and again as it likes."""
    calls = (each.breaks.begins for each in scenario.safety)
    answered = {call.name: call for call in calls if isinstance(call, Ref)}
    known = {(a.agent.name, a.event.name) for a in scenario.assumptions if isinstance(a, (AtMost, Waits))}
    counted = {event.name for event in scenario.events if event.at_most is not None}
    for name, event in answered.items():
        for agent in scenario.agents:
            can_do = any(ref.name == name for ref in agent.can_do)
            if can_do and not agent.controllable and name not in counted and (agent.name, name) not in known:
                yield _pause(scenario, Ref(agent.name, agent.span), event, longest)


def _pause(scenario: Scenario, agent: Ref, event: Ref, longest: Number) -> NumberChange:
    def pause(k: int) -> Waits:
        return Waits(agent, event, k, event.span)

    def make(k: int) -> Scenario:
        return replace(scenario, assumptions=(*scenario.assumptions, pause(k)))

    def say(k: int) -> str:
        return _text(pause(k))

    label = f"assume: {agent.name} waits … between {event.name}"
    return NumberChange("assumption", agent.name, label, 0, whole_above(0, longest), make, say, event.span)


def _elsewhere(scenario: Scenario) -> Iterator[NumberChange]:
    """For each place in a condition that must always, or never, hold, and each agent of whom it is said."""
    conditions = [each.breaks.condition for each in scenario.safety if each.breaks.condition is not None]
    said = [atom for condition in conditions for atom in atoms(condition) if isinstance(atom, At)]
    known = {(a.agent.name, a.place.name) for a in scenario.assumptions if isinstance(a, NeverAt)}
    for agent in (agent for agent in scenario.agents if not agent.controllable and agent.mobile is not None):
        for place in dict.fromkeys(atom.place.name for atom in said if _is_about(atom, agent)):
            if (agent.name, place) not in known:
                yield _never_at(scenario, Ref(agent.name, agent.span), Ref(place, agent.span))


def _is_about(atom: At, agent: Agent) -> bool:
    return not atom.who.robots if atom.who.agent is None else atom.who.agent.name == agent.name


def _never_at(scenario: Scenario, agent: Ref, place: Ref) -> NumberChange:
    never = NeverAt(agent, place, agent.span)

    def make(k: int) -> Scenario:
        return replace(scenario, assumptions=(*scenario.assumptions, never))

    return NumberChange("assumption", agent.name, _text(never), 0, (1,), make, lambda k: _text(never), agent.span)


def _text(assumption: AboutOne) -> str:
    """The statement."""
    if isinstance(assumption, AtMost):
        return f"assume: {assumption.agent.name} does {assumption.event.name} at_most {assumption.times} times"
    if isinstance(assumption, Waits):
        return f"assume: {assumption.agent.name} waits {assumption.time} between {assumption.event.name}"
    if isinstance(assumption, Leaves):
        return f"assume: {assumption.agent.name} leaves {assumption.place.name} within {assumption.time}"
    return f"assume: {assumption.agent.name} never at {assumption.place.name}"
