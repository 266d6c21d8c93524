"""The text of a scenario that was built, or changed, in Python: what is solved and what robots get say the same."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any, Iterable, Iterator, List

from pursue_gen.diagnostics import NOWHERE, PursueError, Span, error
from pursue_gen.language import scenario as pml
from pursue_gen.language.formatter import format_text
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.lifts import in_building
from pursue_gen.language.measures import Measured
from pursue_gen.language.numbers import exact
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Ref, Scenario


def written(scenario: Scenario) -> Scenario:
    """The scenario itself if it has a text that says the same, poses aside; else as its new text is read.

    Raises as `scenario_text`; whether it makes sense is for `checks` to say.
    """
    if scenario.text and _meaning(read(scenario.text, "", scenario.name).scenario) == _meaning(scenario):
        return scenario
    file = scenario.file or f"{scenario.name}.pur"
    again = read(scenario_text(scenario), file, scenario.name).scenario
    assert again is not None, "a text that was compared can be read"
    return again


def scenario_text(scenario: Scenario) -> str:
    """The scenario in PuRSUE-ML, laid out, without comments but poses; what is given up is left out.

    Raises Invalid where that is no text of the language, and PursueError (API001) where it would mean something else:
    names hold what only a text can, or parts stand where the language has no place for them.
    """
    plain: Scenario = _plain(in_building(scenario))
    text = format_text("\n".join(_statements(plain)), plain.file or f"{plain.name}.pur")
    if _meaning(read(text, "", plain.name).scenario) != _meaning(plain):
        message = f"{plain.name} cannot be written in PuRSUE-ML: its text would mean something else"
        hint = "names are letters, digits and _; the places of a patrol in order are one objective for each of them"
        raise PursueError([error("API001", message, hint=hint)])
    return text


def _plain(value: Any) -> Any:
    """A part with numbers that are exact, and tuples; a float is the number that it is shown as."""
    if isinstance(value, Measured):
        return value
    if isinstance(value, (Fraction, float)):
        return exact(Fraction(str(value))) if math.isfinite(value) else value
    if isinstance(value, (tuple, list)):
        return tuple(map(_plain, value))
    if not is_dataclass(value) or isinstance(value, (Span, pml.Pose, type)):
        return value
    return type(value)(**{field.name: _plain(getattr(value, field.name)) for field in fields(value)})


def _meaning(value: Any) -> Any:
    """A part without what does not matter for which game is played: places in the text, poses, files."""
    if isinstance(value, Span):
        return NOWHERE
    if isinstance(value, tuple):
        return tuple(map(_meaning, value))
    if not is_dataclass(value):
        return value
    if isinstance(value, Scenario):
        safety = tuple(sorted(value.safety, key=lambda each: each.last))
        value = replace(value, file="", text="", given_up=(), safety=safety)
    elif isinstance(value, Ref):
        return value.name
    aside = getattr(value, "aside", ())
    return type(value), tuple(_meaning(getattr(value, each.name)) for each in fields(value) if each.name not in aside)


def _statements(scenario: Scenario) -> Iterator[str]:
    for kind in STATEMENTS.values():
        if kind.listed_in:
            yield from (part.text for part in getattr(scenario, kind.listed_in))
    yield from _objectives(scenario.safety)
    yield from _objectives(scenario.reach)


def _objectives(objectives: Iterable[pml.StatedObjective]) -> Iterator[str]:
    """A statement for each objective; the places of a patrol in order have one together."""
    turns: List[pml.StatedObjective] = []
    for objective in objectives:
        turns.append(objective)
        if len(turns) >= len(objective.order):
            yield objective.full_text
            turns = []
