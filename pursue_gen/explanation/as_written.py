"""Changes of statements that are for each of a group: of the one number that is written, so for all members at once."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, Dict, Iterable, Iterator, List, Sequence, Union

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.number_changes import Repair
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules


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
