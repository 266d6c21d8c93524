"""What more could be assumed of others, as an author writes it."""

from __future__ import annotations

from dataclasses import replace
from typing import Iterator, Sequence

from pursue_gen.explanation.number_changes import Repair
from pursue_gen.language.assumption_checks import setting_of
from pursue_gen.language.assumptions import KINDS, Assumption
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import written_time

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
