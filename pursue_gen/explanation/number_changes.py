"""How numbers that an author wrote could change: windows (`3 to 5`), travel times, `at_most 2 times`, `carries 2`."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from math import ceil, floor
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Union

from pursue_gen.diagnostics import Span, listed
from pursue_gen.language.assumption_checks import setting_of
from pursue_gen.language.assumptions import KINDS, Assumption
from pursue_gen.language.loads import MOST_LOADS, Carrier
from pursue_gen.language.numbers import Number, Window, whole_above, whole_below
from pursue_gen.language.scenario import Battery, Event, Scenario, Travel
from pursue_gen.language.statements.event import MOST_TIMES
from pursue_gen.language.times import like, window_text, written_time
from pursue_gen.solving.rules import Rules

SLOWER = 32
"""How many times slower an agent, or longer an event, is tried. Not measured."""


@dataclass(frozen=True)
class Repair:
    """Something that can be changed, by the steps `values` from the smallest change to the largest: numbers (times in
    time units), or texts, "" for what is on or off.

    `what` as in `changes.Change`. `make` is the scenario, or the rules, with that value; `say` describes it.
    """

    what: str
    name: str
    label: str
    before: object
    values: Sequence[Any]
    make: Callable[[Any], Union[Scenario, Rules]]
    say: Callable[[Any], str]
    span: Optional[Span] = None
    helps: int = 2
    """How well a strategy that wins the changed game serves in the game as it is; 0: not at all."""


def _instead(new: Window, old: Window, first: object) -> str:
    """`5 s to 8 s instead of 5 s to 9 s`, written as the first time is."""
    now, before = (window_text(*(like(end, first) for end in ends)) for ends in (new, old))
    return f"{now} instead of {before}"


def event_changes(scenario: Scenario, event: Event) -> Iterator[Repair]:
    """An event that ends earlier at the latest; one of the environment that ends later at the earliest."""
    if event.window is None:
        return
    name, shown, span, (low, high), first = event.name, event.shown, event.span, event.window, event.duration

    def make(earliest: Number, latest: Number) -> Scenario:
        changed = replace(event, duration=like(earliest, first), latest=like(latest, first))
        return scenario.with_instead(event, changed)

    def say(earliest: Number, latest: Number) -> str:
        return f"{shown} lasting {_instead((earliest, latest), (low, high), first)}"

    doers = scenario.doers(name)
    if high - low > 1:
        yield Repair(
            "latest", name, f"a {shown} that ends earlier", like(high, first), whole_below(high, floor(low) + 1),
            lambda k: make(low, k), lambda k: say(low, k), span,
        )  # fmt: skip
    if high - low > 1 and doers and not any(agent.controllable for agent in doers):
        yield Repair(
            "earliest", name, f"a {shown} that ends later", like(low, first), whole_above(low, ceil(high) - 1),
            lambda k: make(k, high), lambda k: say(k, high), span,
        )  # fmt: skip


def travel_changes(scenario: Scenario, travel: Travel) -> Iterator[Repair]:
    """A way that an agent takes in less time; one that is not controllable: in more."""
    low, high = travel.window
    name, who, span, first = travel.agent.name, travel.agent.shown, travel.span, travel.earliest
    a, b = travel.a.shown, travel.b.shown

    def make(earliest: Number, latest: Number) -> Scenario:
        changed = replace(travel, earliest=like(earliest, first), latest=like(latest, first))
        return scenario.with_instead(travel, changed)

    def say(earliest: Number, latest: Number) -> str:
        return f"{who} going from {a} to {b} in {_instead((earliest, latest), (low, high), first)}"

    if any(agent.controllable for agent in scenario.agents if agent.name == name):
        if high > 1:
            yield Repair(
                "travel", name, f"{who} going faster from {a} to {b}", like(high, first), whole_below(high, 1),
                lambda k: make(min(low, k - 1), k), lambda k: say(min(low, k - 1), k), span,
            )  # fmt: skip
    else:
        yield Repair(
            "travel", name, f"{who} going slower from {a} to {b}", like(low, first),
            whole_above(low, SLOWER * max(low, 1)),
            lambda k: make(k, max(high, k + 1)), lambda k: say(k, max(high, k + 1)), span,
        )  # fmt: skip


def battery_changes(scenario: Scenario, battery: Battery) -> Iterator[Repair]:
    """A battery that holds more, or that is recharged faster."""
    name, before, span = battery.agent.name, battery.capacity, battery.span

    yield Repair(
        "capacity", name, f"a larger battery of {name}", before, range(before + 1, 3 * before + 1),
        lambda k: scenario.with_instead(battery, replace(battery, capacity=k)),
        lambda k: f"a battery of {name} with capacity {k} instead of {before}", span,
    )  # fmt: skip
    if battery.dock is not None:
        rate = battery.recharges
        yield Repair(
            "recharges", name, f"a battery of {name} that is recharged faster", rate, whole_above(rate, 4 * rate + 1),
            lambda k: scenario.with_instead(battery, replace(battery, recharges=k)),
            lambda k: f"a battery of {name} that recharges {k} instead of {rate} per unit", span,
        )  # fmt: skip


def count_changes(scenario: Scenario, event: Event, most: int) -> Iterator[Repair]:
    """An event that can happen more often where robots do it, less often where the environment does."""
    ours = any(agent.controllable for agent in scenario.doers(event.name))
    values = range(most + 1, min(2 * most + 2, MOST_TIMES) + 1) if ours else range(most - 1, 0, -1)
    if values:
        yield Repair(
            "times", event.name, f"{event.shown} {'more' if ours else 'less'} often", most, values,
            lambda k: scenario.with_instead(event, replace(event, at_most=k)),
            lambda k: f"{event.shown} at_most {k} times instead of {most}", event.span,
        )  # fmt: skip


def load_changes(scenario: Scenario, carrier: Carrier) -> Iterator[Repair]:
    """An agent that carries more at one time; one that is not controllable: less."""
    agent, room = carrier.agent, carrier.room
    values = range(room + 1, 2 * room + 2) if agent.controllable else range(room - 1, max(carrier.held - 1, 0), -1)
    possible = [k for k in values if replace(carrier, agent=replace(agent, carries=k)).count <= MOST_LOADS]
    if possible:
        yield Repair(
            "room", agent.name, f"{agent.shown} carrying {'more' if agent.controllable else 'less'}", room, possible,
            lambda k: scenario.with_instead(agent, replace(agent, carries=k)),
            lambda k: f"{agent.shown} carries {k} instead of {room}", agent.span,
        )  # fmt: skip


def as_written(scenario: Scenario, repairs: Iterable[Repair]) -> Iterator[Repair]:
    """The repairs, with one in place of those of several members that are the same change of the text; those that
    differ speak of their member."""
    several: Dict[object, List[Repair]] = {}
    for number, repair in enumerate(repairs):
        key: object = number
        if repair.span is not None and repair.span.member:
            key = (repair.what, repair.span.written, str(repair.before), tuple(map(str, repair.values)))
        several.setdefault(key, []).append(repair)
    for some in several.values():
        yield _of_all(scenario, some) if len(some) > 1 else some[0]


def _of_all(scenario: Scenario, some: Sequence[Repair]) -> Repair:
    """One change of all members."""
    first, *_ = some
    assert first.span is not None, "they are of one statement"
    variables = listed(part.split(" is ")[0] for part in first.span.member.split(", "))
    behind = f", and so for each other {variables}"

    def make(value: Any) -> Union[Scenario, Rules]:
        changed = [repair.make(value) for repair in some]
        return _together(scenario, [each for each in changed if isinstance(each, Scenario)])

    return replace(
        first, name=", ".join(dict.fromkeys(repair.name for repair in some)), label=first.label + behind, make=make,
        say=lambda value: first.say(value) + behind, span=first.span.written,
    )  # fmt: skip


def _together(scenario: Scenario, changed: Sequence[Scenario]) -> Scenario:
    """The scenario with all changes: of its parts each scenario has another one, or lacks some, or has more."""
    parts: Dict[str, Any] = {}
    for field in fields(scenario):
        before, after = getattr(scenario, field.name), [getattr(each, field.name) for each in changed]
        if isinstance(before, tuple) and any(each != before for each in after):
            parts[field.name] = tuple(_merged(before, after))
    return replace(scenario, **parts)


def _merged(before: Sequence[object], after: Sequence[Sequence[object]]) -> Iterator[object]:
    if any(len(each) != len(before) for each in after):
        yield from (part for part in before if all(part in each for each in after))
        yield from dict.fromkeys(part for each in after for part in each if part not in before)
    else:
        yield from (next((new for new in row if new != part), part) for part, *row in zip(before, *after))


_CONTRADICTIONS = ("PML264", "PML442")
"""Findings about two assumptions of which one may keep an agent from what the other one says that it does."""


def assumption_changes(scenario: Scenario, longest: Number) -> Iterator[Repair]:
    """Assumptions with another number, and those that may be missing; times are up to `longest` time units."""
    setting = setting_of(scenario)
    for known in scenario.assumptions:
        stronger = known.stronger(longest, setting.shortest_stay)
        if stronger:
            before = known.known_number
            label, instead = f"more than {known.text}", f" instead of {written_time(before)}"
            yield _change(scenario, known, stronger, label, before, instead)
    for kind in KINDS.values():
        for one, values in kind.missing(setting, longest):
            with_it = replace(scenario, assumptions=(*scenario.assumptions, one))
            if not _contradicts(with_it):
                yield _change(with_it, one, values, one.subject)


def _contradicts(scenario: Scenario) -> bool:
    """True if one of its assumptions leaves no room for another one."""
    setting = setting_of(scenario)
    found = (finding for each in scenario.assumptions for finding in each.check_in(setting))
    return any(finding.code in _CONTRADICTIONS for finding in found)


def _change(
    scenario: Scenario, one: Assumption, values: Sequence[int], label: str, before: Number = 0, instead: str = ""
) -> Repair:
    """One of these numbers in an assumption of the scenario."""
    named = list(one.names())
    about = next((ref.name for kind, ref in named if kind == "agent"), named[0][1].name)
    return Repair(
        "assumption", about, label, before, values, lambda k: scenario.with_instead(one, one.with_number(k)),
        lambda k: f"{one.with_number(k).text}{instead}", one.span,
    )  # fmt: skip
