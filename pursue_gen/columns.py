"""Tables for the terminal: texts in columns."""

from __future__ import annotations

from typing import List, Sequence


def columns(rows: Sequence[Sequence[str]], align: str = "<>", ruled: bool = False) -> List[str]:
    """The rows as lines, with a rule below the first one where `ruled`; `align`: `<` for a column to the left and `>`
    for one to the right, where the last sign stands for all further columns."""
    widths = [max(map(len, cells)) for cells in zip(*rows)]
    signs = align.ljust(len(widths), align[-1])
    lines = ["  ".join(f"{cell:{how}{width}}" for cell, how, width in zip(row, signs, widths)).rstrip() for row in rows]
    return [lines[0], "  ".join("-" * width for width in widths), *lines[1:]] if ruled else lines
