"""What more could be assumed of others, as an author writes it: tighter assumptions, pauses between calls, and places
to which they do not come."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Iterator, Sequence

from pursue_gen.explanation.number_changes import NumberChange
from pursue_gen.language.assumption_checks import SHORTEST_STAY
from pursue_gen.language.conditions import At, atoms
from pursue_gen.language.numbers import Number, whole_above, whole_below
from pursue_gen.language.scenario import AboutOne, Agent, AtMost, Leaves, NeverAt, Ref, Scenario, Waits
from pursue_gen.language.writer import assumption_text


def assumption_changes(scenario: Scenario, longest: Number) -> Iterator[NumberChange]:
    """Assumptions with another number, pauses of up to `longest` time units between two calls that are answered, and
    that agents do not come to places of which an objective says what must never be there."""
    for known in scenario.assumptions:
        if isinstance(known, AtMost):
            yield from _tighter(scenario, known, "times", range(known.times - 1, 0, -1))
        elif isinstance(known, Waits):
            yield from _tighter(scenario, known, "time", whole_above(known.time, longest))
        elif isinstance(known, Leaves):
            yield from _tighter(scenario, known, "time", whole_below(known.time, SHORTEST_STAY))
    yield from _pauses(scenario, longest)
    yield from _elsewhere(scenario)


def _tighter(scenario: Scenario, known: AboutOne, field: str, values: Sequence[int]) -> Iterator[NumberChange]:
    """The assumption with each of these values of its field."""
    before: Number = getattr(known, field)

    def changed(k: int) -> AboutOne:
        new: Any = {field: k}
        return replace(known, **new)

    def make(k: int) -> Scenario:
        return replace(scenario, assumptions=tuple(changed(k) if a == known else a for a in scenario.assumptions))

    if values:
        yield NumberChange(
            "assumption", known.agent.name, f"more than {assumption_text(known)}", before, values, make,
            lambda k: f"{assumption_text(changed(k))} instead of {before}", known.span,
        )  # fmt: skip


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

    return NumberChange(
        "assumption", agent.name, f"assume: {agent.name} waits … between {event.name}", 0, whole_above(0, longest),
        lambda k: replace(scenario, assumptions=(*scenario.assumptions, pause(k))), lambda k: assumption_text(pause(k)),
        event.span,
    )  # fmt: skip


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
    changed, text = replace(scenario, assumptions=(*scenario.assumptions, never)), assumption_text(never)
    return NumberChange("assumption", agent.name, text, 0, (1,), lambda k: changed, lambda k: text, agent.span)
