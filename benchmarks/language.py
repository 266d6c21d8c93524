"""Measures how long it takes to read, check and lay out scenarios: `python -m benchmarks.language`.

The scenarios are made here: a floor of any size, and the same floor with a mistake in every few lines. The least time
of several runs counts, in a process that has read a scenario before; the first one also builds the parser.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any, Callable, List, Sequence, Tuple

from benchmarks.tables import markdown
from pursue_gen.language.checks import check_reading
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read

ROOT = Path(__file__).resolve().parent.parent

HEAD = ("text", "lines", "findings", "read, ms", "check, ms", "format, ms", "together, ms")


def floor(places: int, agents: int) -> str:
    """A sound scenario: places in a line with shortcuts, a place and a job for each agent, hand-overs in pairs."""
    lines = [f'poi "p{n}"' for n in range(places)]
    lines += [f"connect p{n} and p{n + 1} distance {n % 7 + 1}" for n in range(places - 1)]
    lines += [f"connect p{n} and p{n + 10} distance {n % 7 + 1}" for n in range(0, places - 10, 3)]
    lines += [f'event "work{n}" location p{n * (places // agents)} duration 3' for n in range(agents)]
    lines += [f'event "hand{n}" collaborative' for n in range(agents // 2)]
    lines += [f'rule "r{n}": work{2 * n} before hand{n}' for n in range(agents // 2)]
    for n in range(agents):
        role = f", hand{n // 2}" if n % 2 == 0 else f" reacts_to hand{n // 2}"
        lines.append(f'agent "bot{n}" controllable mobile 2 location p{n} can_do work{n}{role}')
    return "\n".join([*lines, "reach_objective: do hand0"]) + "\n"


def with_slips(text: str, every: int) -> str:
    """The text with the last letter of every so many lines' first word missing: errors of syntax."""
    lines = text.split("\n")
    for number in range(every - 1, len(lines) - 1, every):
        word, _, rest = lines[number].partition(" ")
        lines[number] = f"{word[:-1]} {rest}"
    return "\n".join(lines)


def with_unknown_names(text: str) -> str:
    """The text with names misspelled wherever they are used behind `and` and `can_do`."""
    return text.replace(" and p", " and pp").replace("can_do work", "can_do wrok")


TEXTS: Tuple[Tuple[str, Callable[[], str]], ...] = (
    ("500 lines, sound", lambda: floor(184, 22)),
    ("500 lines, every line wrong", lambda: with_slips(floor(184, 22), 1)),
    ("500 lines, every fifth wrong", lambda: with_slips(floor(184, 22), 5)),
    ("500 lines, names unknown", lambda: with_unknown_names(floor(184, 22))),
    ("1,000 places, 100 agents", lambda: floor(1000, 100)),
    ("1,000 places, names unknown", lambda: with_unknown_names(floor(1000, 100))),
    ("5,000 places, 500 agents", lambda: floor(5000, 500)),
)


def least(work: Callable[[], Any], runs: int) -> Tuple[float, Any]:
    """The least time of some runs in milliseconds, and what the work gives."""
    times: List[float] = []
    result = None
    for _ in range(runs):
        start = time.perf_counter()
        result = work()
        times.append((time.perf_counter() - start) * 1000)
    return min(times), result


def row(name: str, text: str, runs: int) -> List[str]:
    """One line of the table."""
    reading_time, reading = least(lambda: read(text, "floor.pur"), runs)
    check_time, findings = least(lambda: check_reading(reading), runs)
    together, layout = reading_time + check_time, "-"
    if reading.scenario is not None:  # only what can be read is laid out
        format_time, _ = least(lambda: format_text(text, "floor.pur"), runs)
        together, layout = together + format_time, f"{format_time:.0f}"
    counts = [f"{text.count(chr(10)):,}", f"{len(findings):,}"]
    return [name, *counts, f"{reading_time:.0f}", f"{check_time:.0f}", layout, f"{together:.0f}"]


def main(words: Sequence[str] = ()) -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5, help="runs of each, of which the quickest counts (default 5)")
    runs = max(1, parser.parse_args(words or None).runs)
    first, _ = least(lambda: read('poi "a"', "first.pur"), 1)
    print(markdown(HEAD, [row(name, text(), runs) for name, text in TEXTS], left=1), end="")
    print(f"\nThe first text of a process: {first:.0f} ms, for the parser to be made.")


if __name__ == "__main__":
    main()
