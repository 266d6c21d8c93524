"""Edits of a text: parts of it that are replaced by others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, List


@dataclass(frozen=True)
class Edit:
    """text[start:end] is replaced by `text`."""

    start: int
    end: int
    text: str


def edited(text: str, edits: Iterable[Edit]) -> str:
    """The text after all the edits, whose offsets are those of the text before; they do not overlap."""
    parts: List[str] = []
    done = 0
    for edit in sorted(edits, key=lambda one: (one.start, one.end)):
        assert edit.start >= done, "edits overlap"
        parts += [text[done : edit.start], edit.text]
        done = edit.end
    return "".join([*parts, text[done:]])
