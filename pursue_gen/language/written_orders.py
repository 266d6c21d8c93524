"""Objectives that people write while a mission is under way, each as if it had stood in the scenario with an event of
its own that is ordered."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from typing import Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, Severity, listed
from pursue_gen.language.checks import check_reading
from pursue_gen.language.numbers import decimal_text, exact
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario

WrittenOrder = Tuple[str, Fraction]
"""What is to hold or to happen, in the scenario's language, and within how many time units."""

CAN_BE_ORDERED = (
    "expected a condition, as in bot1 at room4 or any robot at room3, or an event that is to happen, as in do clean"
)

_DO = re.compile(r"do\s+(?P<event>\w+)(\s+at\s+(?P<place>\w+))?(\s+by\s+(?P<who>any\s+robot|\w+))?\s*", re.ASCII)


class NoOrder(Exception):
    """What a person has written cannot be ordered; its text, a sentence, says why, and what to write."""


def event_names(scenario: Scenario, count: int) -> Tuple[str, ...]:
    """The events of so many written orders: no word of the scenario is one of them."""
    stem = "order"
    while re.search(rf"\b{stem}\d", scenario.text, re.ASCII):
        stem += "_"
    return tuple(f"{stem}{number}" for number in range(1, count + 1))


def with_written(scenario: Scenario, orders: Sequence[WrittenOrder]) -> Scenario:
    """The scenario with these orders behind its own, in this order. Raises NoOrder."""
    if not orders:
        return scenario
    for says, _ in orders:
        _check_deed(says, scenario)
    text = scenario.text if scenario.text.endswith("\n") or not scenario.text else f"{scenario.text}\n"
    first, names = text.count("\n") + 1, event_names(scenario, len(orders))
    for name, (phrase, within) in zip(names, orders):
        text += f'event "{name}" on_order\n{_begin(name)}{_bare(phrase)} within {decimal_text(exact(within))}\n'
    reading = read(text, scenario.file, scenario.name)
    for finding in check_reading(reading):
        if finding.severity is Severity.ERROR:
            raise NoOrder(_sentence(finding, first, names, orders))
    found = reading.partial
    events = tuple(each for each in found.events if each.name in names)
    asked = tuple(each for each in found.safety if each.span.line >= first)
    if [each.called_by for each in asked] != list(names) or len(events) != len(names):
        raise NoOrder(CAN_BE_ORDERED)
    return replace(scenario, events=(*scenario.events, *events), safety=(*scenario.safety, *asked), text=text)


def _begin(name: str) -> str:
    return f"objective: if {name} then "


def _bare(phrase: str) -> str:
    """The text as the language has it: of an event that is to be done its name alone."""
    deed = _DO.fullmatch(phrase)
    return deed["event"] if deed else phrase


def _check_deed(phrase: str, scenario: Scenario) -> None:
    """That an event that is to be done happens where it is wanted, and that who is named alone can do it. Raises
    NoOrder."""
    deed = _DO.fullmatch(phrase)
    event = next((each for each in scenario.events if deed and each.name == deed["event"]), None)
    if deed is None or event is None:
        return
    if deed["place"] and (event.location is None or event.location.name != deed["place"]):
        where = "anywhere" if event.location is None else f"at {event.location.name}"
        raise NoOrder(f"column {deed.start('place') + 1}: {event.name} happens {where}; order it without at")
    who, able = deed["who"], {agent.name: agent.is_robot for agent in scenario.doers(event.name)}
    wanted = {name for name, is_robot in able.items() if name == who or (is_robot and " " in (who or ""))}
    others = sorted(set(able) - wanted)
    if who and (others or not wanted):
        can = f"{listed(others) if others else 'nobody'} can do {event.name}{', too' if wanted else ''}"
        raise NoOrder(f"column {deed.start('who') + 1}: {can}; order it without by: who does it cannot be chosen")


def _sentence(finding: Diagnostic, first: int, names: Sequence[str], orders: Sequence[WrittenOrder]) -> str:
    """What is wrong with an order, with its column in the order's own text, and what to write."""
    span, where = finding.span, ""
    number, is_objective = divmod(span.line - first, 2) if span is not None else (-1, 0)
    if span is not None and is_objective and 0 <= number < len(orders):
        phrase = orders[number][0]
        column = span.column - len(_begin(names[number])) + max(0, phrase.find(_bare(phrase)))
        where = f"column {max(1, column)}: "
    hint = CAN_BE_ORDERED if "objective" in finding.hint else finding.hint
    return f"{where}{finding.message}" + (f"; {hint}" if hint else "")
