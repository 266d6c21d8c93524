"""What is wrong with objectives beside each other, and with what is to be done."""

from __future__ import annotations

from typing import Dict, Iterator

from pursue_gen.diagnostics import Diagnostic, error
from pursue_gen.language.scenario import Scenario

MOST_OPTIONAL = 6
"""So many different numbers stand behind `optional` at most: each takes a game of its own."""


def check_objectives(scenario: Scenario) -> Iterator[Diagnostic]:
    """Objectives that stand there twice or contradict each other, and those that can never be reached as they stand."""
    yield from _optional(scenario)
    lines: Dict[str, int] = {}
    statements = [statement[0] for statement in scenario.statements]
    for objective in sorted(statements, key=lambda each: (each.span.line, each.span.column)):
        text = objective.text
        if text in lines:
            message = f"the same objective stands in line {lines[text]} already"
            if len(objective.statement(scenario.objectives).objectives) > 1:
                message = f"{next(objective.names())[1].name} stands twice in this patrol"
            yield error("PML220", message, objective.span, "delete one of the two")
        lines.setdefault(text, objective.span.line)
    for objective in statements:
        yield from objective.check(scenario.agents)
    avoided = {each.breaks.event.name: each for each in scenario.safety if each.breaks.event is not None}
    for reach in scenario.reach:
        for ref in reach.events:
            if ref.name in avoided:
                message = f"{ref.name} is to be done, and line {avoided[ref.name].span.line} has it avoided"
                yield error("PML221", message, ref.span, "delete one of the two, or name another event")


def _optional(scenario: Scenario) -> Iterator[Diagnostic]:
    """Something has to be met in any case, and each number behind optional is a game to solve."""
    if scenario.objectives and all(each.optional for each in scenario.objectives):
        hint = "delete the optional of what matters most; whoever gives that up as well has nothing left to do"
        yield error("PML301", "every objective is optional", scenario.objectives[0].span, hint)
    for span in dict.fromkeys(each.span for each in scenario.patrols if each.optional and each.every is None):
        message = "an optional patrol without every: the least period is found for what has to be promised"
        yield error("PML303", message, span, "write how often, as in every 60, or delete optional")
    for number in scenario.optional[MOST_OPTIONAL:]:
        first = next(each for each in scenario.objectives if each.optional == number)
        message = f"more than {MOST_OPTIONAL} different numbers behind optional"
        hint = "objectives with one number are kept or given up together: use a number for several of them"
        yield error("PML302", message, first.span, hint)
