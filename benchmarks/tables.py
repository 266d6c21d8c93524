"""Measured rows as tables: for a terminal, in Markdown, as CSV; and how a family's cost grows."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple

from benchmarks.families import FAMILIES, Family

Row = Dict[str, Any]

DASH = "-"
OUTCOMES = {
    "time": "too long",
    "memory": "too large",
    "proof": "not proven in time",
    "refused": "refused by the checker",
    "skipped": "not tried",
}
COLUMNS = (
    "group", "name", "size", "game", "verdict", "outcome", "reason", "states", "symbolic", "zones", "rate",
    "seconds", "runs", "decided", "proof", "memory", "blocks", "commands", "margin", "margin_open",
    "tiga_states", "tiga_waiting", "tiga_rate", "tiga_blocks", "tiga_commands",
    "stages", "cpu", "goal", "worst", "least", "games", "plain", "above", "undecided", "disagreed",
    "tchecker_states", "tchecker_seconds", "tchecker_outcome",
)  # fmt: skip


def complete(row: Row) -> Row:
    """The row with every column, symbolic states per second among them; None for what is not known."""
    full = {column: row.get(column) for column in COLUMNS}
    counted = row.get("symbolic") or row.get("states")
    if counted and row.get("seconds") and row.get("group") != "family":  # a family's seconds are those of proofs too
        full["rate"] = round(counted / row["seconds"])
    return full


def as_csv(rows: Iterable[Row]) -> str:
    """All the columns."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(complete(row) for row in rows)
    return stream.getvalue()


# Cells ---------------------------------------------------------------------------------------------------------------


def number(value: Optional[float]) -> str:
    """A count, thousands set apart."""
    return DASH if value is None else f"{value:,.0f}"


def seconds(value: Optional[float]) -> str:
    """Seconds with two or three digits that count."""
    if value is None:
        return DASH
    if value < 0.1:
        return f"{value:.4f}"
    return f"{value:.3f}" if value < 1 else f"{value:.1f}"


def verdict(row: Row) -> str:
    """Who wins, or why that is not known; a strategy without proof is said to be one."""
    known, outcome = row.get("verdict"), row.get("outcome", "")
    trouble = OUTCOMES.get(outcome, outcome)
    if known and trouble:
        return f"{known}, {trouble}"
    return str(known or trouble or DASH)


def margin(row: Row) -> str:
    """The largest delay with which the strategy still wins, in time units; ">=" where the search ended early."""
    value = row.get("margin")
    return DASH if value is None else f"{'>= ' * bool(row.get('margin_open'))}{value:g}"


# Markdown ------------------------------------------------------------------------------------------------------------


def markdown(head: Sequence[str], lines: Iterable[Sequence[str]], left: int = 2) -> str:
    """A table; the first `left` columns are words, the others numbers."""
    rule = ["---" if place < left else "---:" for place in range(len(head))]
    return "".join("| " + " | ".join(line) + " |\n" for line in [list(head), rule, *lines])


def beside_tiga(rows: Iterable[Row]) -> str:
    """The ideal game, which is TIGA's: ours and then TIGA's figure."""
    head = (
        "scenario", "verdict", "states", "TIGA", "states/s", "TIGA", "seconds", "proof, s", "MiB",
        "blocks", "TIGA", "commands", "TIGA", "margin",
    )  # fmt: skip
    lines = [
        [row["name"], verdict(row), number(row["states"]), number(row["tiga_states"]), number(row["rate"])]
        + [number(row["tiga_rate"]), seconds(row["seconds"]), seconds(row["proof"]), number(row["memory"])]
        + [number(row["blocks"]), number(row["tiga_blocks"]), number(row["commands"]), number(row["tiga_commands"])]
        + [margin(row)]
        for row in map(complete, rows)
        if row["game"] == "ideal"
    ]
    return markdown(head, lines)


def default_game(rows: Iterable[Row]) -> str:
    """The game that workspaces are made from."""
    head = (
        "scenario", "verdict", "states", "states/s", "seconds", "proof, s", "MiB", "blocks", "commands", "margin"
    )  # fmt: skip
    lines = [
        [row["name"], verdict(row), number(row["states"]), number(row["rate"]), seconds(row["seconds"])]
        + [seconds(row["proof"]), number(row["memory"]), number(row["blocks"]), number(row["commands"]), margin(row)]
        for row in map(complete, rows)
        if row["game"] == "default"
    ]
    return markdown(head, lines)


def family_table(family: Family, rows: Iterable[Row]) -> str:
    """One family: a line per size, the ideal game and beside it the default one."""
    mine = [complete(row) for row in rows if row["group"] == "family" and row["name"] == family.name]
    one = "distance" if family.grows == "distance" else family.grows
    part = ("verdict", "states", "seconds", "MiB", "blocks", "commands")
    head = (one, *(f"ideal: {word}" if word == "verdict" else word for word in part))
    head += tuple(f"default: {word}" if word == "verdict" else word for word in part)
    lines: List[List[str]] = []
    for size in sorted({row["size"] for row in mine}):
        line = [str(size)]
        for game in ("ideal", "default"):
            row = next((row for row in mine if row["size"] == size and row["game"] == game), complete({}))
            line += [verdict(row), number(row["states"]), seconds(row["seconds"]), number(row["memory"])]
            line += [number(row["blocks"]), number(row["commands"])]
        lines.append(line)
    return markdown(head, lines, left=1)


def families(rows: Sequence[Row]) -> str:
    """All families that were measured, each with its task and its table."""
    parts: List[str] = []
    for family in FAMILIES:
        if any(row["group"] == "family" and row["name"] == family.name for row in rows):
            parts.append(f"**{family.name}** ({family.grows}). {family.task}\n\n{family_table(family, rows)}")
    return "\n".join(parts)


# Growth --------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Growth:
    """How a figure grows with the size n: like n^k ("power") or like k^n ("factor"), whichever lies closer to the
    points (least squares on the logarithm); `points` of them were used."""

    kind: str
    k: float
    points: int

    def __str__(self) -> str:
        if self.kind == "power":
            return "constant" if abs(self.k) < 0.15 else f"n^{self.k:.1f}"
        return f"{self.k:.3g}^n"


def growth(points: Iterable[Tuple[float, float]]) -> Optional[Growth]:
    """The growth of a figure from (size, figure); None of fewer than three points that are above zero."""
    usable = [(size, figure) for size, figure in points if figure > 0]
    if len(usable) < 3:
        return None
    logs = [math.log(figure) for _, figure in usable]
    factor, off = _line([size for size, _ in usable], logs)
    if min(size for size, _ in usable) <= 0:
        if max(logs) - min(logs) < _CONSTANT:
            return Growth("power", 0.0, len(usable))
        return Growth("factor", math.exp(factor), len(usable))
    power, far = _line([math.log(size) for size, _ in usable], logs)
    # Where a figure hardly moves, both fit: then it is a power close to zero.
    if far <= off or abs(power) < 0.15:
        return Growth("power", power, len(usable))
    return Growth("factor", math.exp(factor), len(usable))


def growths(rows: Sequence[Row]) -> str:
    """A line per family and game: how states, seconds and commands grow."""
    lines: List[List[str]] = []
    for family in FAMILIES:
        for game in ("ideal", "default"):
            mine = [row for row in rows if (row["group"], row["name"], row["game"]) == ("family", family.name, game)]
            if not mine:
                continue
            fits = [growth((row["size"], row[what]) for row in mine if row.get(what)) for what in FIGURES]
            cells = [DASH if fit is None else str(fit) for fit in fits]
            decided = [row["size"] for row in mine if row.get("verdict")]
            lines.append([family.name, family.grows, game, *cells, str(max(decided)) if decided else "none"])
    return markdown(("family", "grows", "game", "states", "seconds", "commands", "decided up to"), lines, left=3)


FIGURES = ("states", "seconds", "commands")

_CONSTANT = math.log(1.1)
"""From the size 0 on, a figure that changes by less than a tenth is constant."""


def _line(xs: Sequence[float], ys: Sequence[float]) -> Tuple[float, float]:
    """Slope of the least-squares line, and the sum of the squares that remain."""
    middle, height = sum(xs) / len(xs), sum(ys) / len(ys)
    spread = sum((x - middle) ** 2 for x in xs)
    slope = sum((x - middle) * (y - height) for x, y in zip(xs, ys)) / spread if spread else 0.0
    return slope, sum((y - height - slope * (x - middle)) ** 2 for x, y in zip(xs, ys))


# Terminal ------------------------------------------------------------------------------------------------------------

HEADLINE = (
    f"{'scenario':34} {'game':8} {'verdict':12} {'states':>9} {'states/s':>9} {'seconds':>9} {'proof':>8} {'MiB':>6} "
    f"{'blocks':>7} {'commands':>8} {'margin':>8} | {'TIGA: states':>12} {'states/s':>8} {'blocks':>7} {'commands':>8}"
)


def terminal(row: Row) -> str:
    """The row below HEADLINE."""
    full = complete(row)
    name = full["name"] if full["size"] is None else f"{full['name']} {full['size']}"
    line = f"{name:34} {full['game']:8} {verdict(full):12} {number(full['states']):>9} {number(full['rate']):>9} "
    line += f"{seconds(full['seconds']):>9} {seconds(full['proof']):>8} {number(full['memory']):>6} "
    line += f"{number(full['blocks']):>7} {number(full['commands']):>8} {margin(full):>8}"
    ideal = full["game"] == "ideal"
    tiga = [number(full[f"tiga_{what}"] if ideal else None) for what in ("states", "rate", "blocks", "commands")]
    return line + f" | {tiga[0]:>12} {tiga[1]:>8} {tiga[2]:>7} {tiga[3]:>8}"
