"""Labels: what people read in place of a name."""

from __future__ import annotations

import re
import unicodedata
from typing import Dict, Iterator, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.scenario import Scenario

LABELLED = {kind.declares: kind.listed_in for kind in STATEMENTS.values() if kind.labelled}
"""The kinds of things that may have a label, and the field of a scenario that has them."""

_SIGNS = re.compile(r"[!-/:-@\[-`{-~]")
"""The signs that mean something in Markdown; a backslash before one of them makes it an ordinary sign."""

_INVISIBLE = re.compile(
    "[\u034f\u115f-\u1160\u17b4-\u17b5\u180b-\u180f\u2800\u3164\uffa0\ufff0-\ufff8\U0001d159\U000e0000-\U000e0fff]"
)
"""Those of Default_Ignorable_Code_Point (Unicode, DerivedCoreProperties.txt) that Python may hold for printable, and
others that are blank: the empty cell of Braille, the empty head of a note. U+FE00 to U+FE0F are not here: they choose
how the sign before them looks."""

LONGEST_LABEL = 60
"""Letters of a label: pictures and buttons have little room."""


def why_no_label(label: str) -> str:
    """Why a text cannot be a label; the empty string: it can."""
    if not label.strip():
        return "it is empty"
    if label != label.strip():
        return "it begins or ends with a blank"
    if len(label) > LONGEST_LABEL:
        return f"it is longer than {LONGEST_LABEL} letters"
    if '"' in label or not label.isprintable():
        return "it has characters that cannot be seen, or that change the direction of writing"
    if _INVISIBLE.search(label):
        return "it has characters that show nothing"
    if all(unicodedata.category(letter)[0] in "MZ" for letter in label):
        return "it has no letter or sign of its own"
    return ""


def markdown(text: str) -> str:
    """The text as Markdown that shows just that."""
    return _SIGNS.sub(r"\\\g<0>", text)


def in_markdown(scenario: Scenario, text: str) -> str:
    """A text with what people read in this scenario as Markdown: labels may hold any sign, names none that matters."""
    return markdown(text) if scenario.labels else text


def check_labels(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about labels: those that cannot be shown, and things of one kind that people cannot tell apart."""
    for kind, field in LABELLED.items():
        parts = getattr(scenario, field)
        seen: Dict[str, Tuple[str, Span]] = {part.name: (part.name, part.span) for part in parts if part.label is None}
        for part in parts:
            if part.label is None:
                continue
            why = why_no_label(part.label)
            if why:
                hint = f"write 1 to {LONGEST_LABEL} letters, signs and blanks; without a label people read {part.name}"
                yield error("PML282", f"the label of {part.name} cannot be shown: {why}", part.span, hint)
            elif part.label in seen:
                name, span = seen[part.label]
                what = "place" if kind == "POI" else kind
                message = f'people read "{part.label}" for the {what} {name} in {span.in_words}, too'
                yield warning("PML283", message, part.span, "give one of them another label")
            seen.setdefault(part.label, (part.name, part.span))
