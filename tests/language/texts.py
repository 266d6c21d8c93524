"""A small sound scenario in statements, for tests that change one of them."""

from __future__ import annotations

from typing import List

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.language import check, parse
from pursue_gen.language.parser import read

STATEMENTS = {
    "poi a": 'poi "a"',
    "poi b": 'poi "b"',
    "connect": "connect a and b distance 3",
    "event work": 'event "work" location b duration 3',
    "event hand": 'event "hand" collaborative',
    "event rest": 'event "rest"',
    "rule": 'rule "order": work before hand',
    "state": 'state "tired": initially false, true_if work false_if rest',
    "dependency": "stateDependency: hand only_if tired is_true",
    "agent bot": 'agent "bot" controllable mobile 2 location a can_do work, hand',
    "agent man": 'agent "man" location b can_do rest reacts_to hand',
    "objective": "objective: if work then hand within 20",
    "reach": "reach_objective: do hand after 4",
}


def text(**changes: str) -> str:
    """The scenario with some statements replaced ('' deletes one); `_` stands for a blank, `more` is appended."""
    statements = dict(STATEMENTS)
    more = changes.pop("more", "")
    for key, statement in changes.items():
        assert key.replace("_", " ") in statements
        statements[key.replace("_", " ")] = statement
    return "\n".join([*statements.values(), *([more] if more else [])]) + "\n"


def findings(source: str, name: str = "test") -> List[Diagnostic]:
    """Every finding about a text, whatever their severity."""
    reading = read(source, name + ".pur")
    return list(check(reading.scenario) if reading.scenario is not None else reading.diagnostics)


def syntax_errors(source: str) -> List[Diagnostic]:
    """What `parse` raises; the empty list: it raises nothing."""
    try:
        parse(source, "test.pur")
    except PursueError as problem:
        return list(problem.diagnostics)
    return []
