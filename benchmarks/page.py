"""The page of results: a text that people write, in which each part between two marks is made of what was measured."""

from __future__ import annotations

import re
import textwrap
from typing import Any, Callable, Dict, Mapping, Optional

from benchmarks import agreement_page, command, ordinary_page, random_page, tables, tchecker

Results = Dict[str, Any]

_PART = re.compile(r"(<!-- measured: ([a-z ]+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def filled(
    page: Optional[str],
    results: Results,
    parts: Optional[Mapping[str, Callable[[Results], str]]] = None,
    title: str = "Benchmarks",
) -> str:
    """The page with its measured parts made anew (PARTS, unless others are given); where there is none yet, one of
    measured parts alone.

    Raises ValueError for a mark that names no part.
    """
    known = PARTS if parts is None else parts
    if page is None:
        page = f"# {title}\n\n" + "\n".join(f"<!-- measured: {part} -->\n<!-- end -->\n" for part in known)

    def part(match: "re.Match[str]") -> str:
        if match.group(2) not in known:
            raise ValueError(f"the page asks for '{match.group(2)}'; there is {', '.join(known)}")
        return f"{match.group(1)}\n{_wrapped(known[match.group(2)](results))}\n{match.group(4)}"

    return _PART.sub(part, page)


def _wrapped(text: str) -> str:
    """The text with its sentences in lines of at most 120 columns; tables and pictures stay as they are."""
    wrapper = textwrap.TextWrapper(120, break_long_words=False, break_on_hyphens=False)
    return "\n".join(line if line.startswith(("|", "!")) else wrapper.fill(line) for line in text.split("\n"))


def _where(results: Results) -> str:
    load = results["load"]
    text = (
        f"Measured {results['date']} on {results['machine']}. Limits of each game: {results['seconds']:g} s of "
        f"processor time to decide and as many to prove, {results['memory']:,} MiB."
    )
    if load >= _BUSY:
        text += (
            f" Other work ran on the machine (load average {load:.1f} when the measurement began), so times by the "
            "clock, those of the solver alone, are too long."
        )
    return text + "\n"


_BUSY = 0.5
"""The load average from which on other work counts."""


def _scenarios(results: Results) -> "list[Dict[str, Any]]":
    return [row for row in results["rows"] if row["group"] in ("thesis", "story", "reference", "file")]


PARTS: Dict[str, Callable[[Results], str]] = {
    "machine": _where,
    "ideal game": lambda results: tables.beside_tiga(_scenarios(results)),
    "default game": lambda results: tables.default_game(_scenarios(results)),
    "growth": lambda results: tables.growths(results["rows"]),
    "whole commands": lambda results: command.table(results["rows"]),
    "guaranteed times": lambda results: command.times_table(results["rows"]),
    "ordinary work": ordinary_page.families,
    "lab scenarios": ordinary_page.labs,
    "driving": ordinary_page.driving,
    "random games": lambda results: random_page.table(results["rows"]),
    "agreement": agreement_page.table,
    "tchecker": lambda results: tchecker.table(results["rows"]),
    "families": lambda results: tables.families(results["rows"]),
}
"""What a page can ask for."""
