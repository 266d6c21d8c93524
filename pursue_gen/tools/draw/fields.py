"""What the page's forms send: each value is looked at before it becomes a part of a text."""

from __future__ import annotations

import math
import re
from functools import partial
from typing import Any, List, Mapping, Sequence

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.language.labels import why_no_label
from pursue_gen.language.measures import LENGTHS, Units
from pursue_gen.language.numbers import read_number
from pursue_gen.language.times import TIMES, has_unit

Values = Mapping[str, Any]

_NAME = re.compile(r"[A-Za-z]\w*(-\w+)*", re.ASCII)
_FARTHEST = 1e6  # metres, as for poses
_LONGEST = 1000


def refused(message: str, hint: str = "") -> PursueError:
    """The error of a change that cannot be made."""
    return PursueError([error("DRW001", message, hint=hint)])


def text_of(values: Values, field: str) -> str:
    """A text on one line, without what would begin a comment; "" where there is none."""
    value = values.get(field)
    if value is None:
        return ""
    if not isinstance(value, str) or len(value) > _LONGEST:
        raise refused(f"{field} is no text of at most {_LONGEST} letters")
    value = value.strip()
    if "\n" in value or "\r" in value or "//" in value or "/*" in value:
        raise refused(f"{field} has a line end or a comment in it", "write comments into the text")
    return value


def name_of(values: Values, field: str) -> str:
    """A name."""
    value = text_of(values, field)
    if not _NAME.fullmatch(value):
        raise refused(f"{field} is '{value[:60]}'; expected a name", "letters, digits and _, a letter first")
    return value


def names_of(values: Values, field: str) -> List[str]:
    """A list of names, perhaps empty."""
    found = values.get(field)
    if not isinstance(found, list):
        raise refused(f"{field} is no list of names")
    return [name_of({field: one}, field) for one in found]


def number_of(values: Values, field: str) -> str:
    """A number as it is written in a scenario."""
    value = text_of(values, field)
    if read_number(value) is None:
        raise refused(f"{field} is '{value[:60]}'; expected a number", "such as 3 or 2.5")
    return value


def _measured(kinds: Sequence[Units], values: Values, field: str) -> str:
    """A number as it is written in a scenario, with a unit of one of these kinds or without."""
    value = " ".join(text_of(values, field).split())
    known = has_unit(value) and any(kind.read(value).value is not None for kind in kinds)
    return value if known else number_of(values, field)


measure_of, time_of, length_of = (partial(_measured, kinds) for kinds in ((TIMES, LENGTHS), (TIMES,), (LENGTHS,)))
"""A number, a time or a length as it is written in a scenario, with its unit or without."""


def window_of(values: Values, field: str) -> str:
    """One time, or two as in `3 to 5` or `30 s to 2 min`."""
    first, to, second = text_of(values, field).partition(" to ")
    texts = [first, second] if to else [first]
    return " to ".join(time_of({field: one}, field) for one in texts)


def label_of(values: Values, field: str) -> str:
    """What people read, in quotes; "" where there is no label."""
    value = values.get(field)
    if not isinstance(value, str):
        raise refused(f"{field} is no text")
    why = why_no_label(value.strip()) if value.strip() else ""
    if why:
        raise refused(f"the label cannot be shown: {why}", "letters, signs and blanks without double quotes")
    return f'"{value.strip()}"' if value.strip() else ""


def metres_of(values: Values, field: str) -> float:
    """A coordinate."""
    value = _float(values, field)
    if abs(value) > _FARTHEST:
        message = f"{field} is off the map: farther than {_FARTHEST:,.0f} m from its origin"
        raise refused(message, "expected metres on the map")
    return value


def positive_of(values: Values, field: str, most: float) -> float:
    """A number of at least 0.001."""
    value = _float(values, field)
    if not 0.001 <= value <= most:
        raise refused(f"{field} is {value:g}", f"expected a number from 0.001 to {most:g}")
    return value


def degrees_of(values: Values, field: str) -> float:
    """An angle."""
    return math.fmod(_float(values, field), 360)


def is_set(values: Values, field: str) -> bool:
    """A tick."""
    value = values.get(field)
    if not isinstance(value, bool):
        raise refused(f"{field} is neither true nor false")
    return value


def index_of(values: Values, field: str, length: int) -> int:
    """The place of something in a list of that length."""
    value = values.get(field)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < length:
        raise refused("this is not in the text any more", "choose it again")
    return value


def _float(values: Values, field: str) -> float:
    value = values.get(field)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise refused(f"{field} is not a number", "such as 3 or 2.5")
    return float(value)
