"""What is wrong with objectives beside each other, and with what is to be done."""

from __future__ import annotations

from typing import Dict, Iterator, Set

from pursue_gen.diagnostics import Diagnostic, error
from pursue_gen.language.numbers import exact
from pursue_gen.language.scenario import Avoid, Patrol, Reach, Scenario
from pursue_gen.language.wording import objective_text

MOST_EVENTS = 5
"""So many events stand behind one `do` at most: the order in which they happen is free, and each order counts."""

MOST_OPTIONAL = 6
"""So many different numbers stand behind `optional` at most: each takes a game of its own."""


def check_objectives(scenario: Scenario) -> Iterator[Diagnostic]:
    """Objectives that stand there twice or contradict each other, and those that can never be reached as they stand."""
    yield from _optional(scenario)
    lines: Dict[str, int] = {}
    statements = [statement[0] for statement in scenario.statements]
    for objective in sorted(statements, key=lambda each: (each.span.line, each.span.column)):
        text = objective_text(objective)
        if text in lines:
            message = f"the same objective stands in line {lines[text]} already"
            if isinstance(objective, Patrol) and lines[text] == objective.span.line:
                message = f"{objective.place.name} stands twice in this patrol"
            yield error("PML220", message, objective.span, "delete one of the two")
        lines.setdefault(text, objective.span.line)
    avoided = {safety.event.name: safety for safety in scenario.safety if isinstance(safety, Avoid)}
    for patrol in statements:
        if isinstance(patrol, Patrol) and patrol.order:
            yield from _order(patrol)
    for reach in scenario.reach:
        for ref in reach.events:
            if ref.name in avoided:
                message = f"{ref.name} is to be done, and line {avoided[ref.name].span.line} has it avoided"
                yield error("PML221", message, ref.span, "delete one of the two, or name another event")
        yield from _reach(reach)


def _order(patrol: Patrol) -> Iterator[Diagnostic]:
    """An order of one place, or one that could not tell whose turn it is."""
    again = next((name for k, name in enumerate(patrol.order) if name in patrol.order[:k]), "")
    if again:
        message = f"{again} stands twice in this patrol in order: expected each place once in a round"
        yield error("PML261", message, patrol.span, "delete one of the two")
    elif len(patrol.order) < 2:
        message = "in order says nothing about one place: expected two or more"
        yield error("PML260", message, patrol.span, "name the other places, or delete in order")


def _optional(scenario: Scenario) -> Iterator[Diagnostic]:
    """Something has to be met in any case, and each number behind optional is a game to solve."""
    if scenario.objectives and all(each.optional for each in scenario.objectives):
        hint = "delete the optional of what matters most; whoever gives that up as well has nothing left to do"
        yield error("PML301", "every objective is optional", scenario.objectives[0].span, hint)
    patrols = (each for each in scenario.safety if isinstance(each, Patrol))
    for span in dict.fromkeys(each.span for each in patrols if each.optional and each.every is None):
        message = "an optional patrol without every: the least period is found for what has to be promised"
        yield error("PML303", message, span, "write how often, as in every 60, or delete optional")
    for number in scenario.optional[MOST_OPTIONAL:]:
        first = next(each for each in scenario.objectives if each.optional == number)
        message = f"more than {MOST_OPTIONAL} different numbers behind optional"
        hint = "objectives with one number are kept or given up together: use a number for several of them"
        yield error("PML302", message, first.span, hint)


def _reach(reach: Reach) -> Iterator[Diagnostic]:
    seen: Set[str] = set()
    for ref in reach.events:
        if ref.name in seen:
            yield error("PML222", f"{ref.name} stands twice behind do", ref.span, "delete one: it happens once")
        seen.add(ref.name)
    if len(reach.events) > MOST_EVENTS:
        message = f"more than {MOST_EVENTS} events behind one do"
        yield error("PML224", message, reach.span, "write several lines: all reach_objectives have to be reached")
    if reach.within is not None and reach.within <= reach.after:
        message = f"within {reach.within} ends before it counts, which is later than {reach.after}"
        hint = f"both count from the start of the mission: write within {exact(reach.after + 1)} or more"
        yield error("PML223", message, reach.span, hint)
