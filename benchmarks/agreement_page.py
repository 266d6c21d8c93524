"""The counts of benchmarks/agreement.py as a table and sentences."""

from __future__ import annotations

from typing import Any, Dict, Iterable, List, Mapping

from benchmarks.tables import markdown, number

Row = Mapping[str, Any]


def table(results: Mapping[str, Any]) -> str:
    """A line per group of games; what differs is named."""
    found = results.get("agreement")
    if found is None:
        return "Not compared yet: `python -m benchmarks.agreement --out docs`.\n"
    head = ("drawn", "game", "compared", "games", "most states", "won", "lost", "undecided", "differ",
            "proven by both checkers")  # fmt: skip
    rows: List[Row] = found["rows"]
    lines = [
        [row["name"], row["game"], row["date"] + (f", version {row['version']}" if row["version"] else "")]
        + [*map(number, (row["games"], row["most_states"], row["won"], row["lost"]))]
        + [number(row["undecided"]), number(len(row["differ"])), number(row["proven"])]
        for row in rows
    ]
    text = [sentence(which, kind) for which, kind in _split(rows).items() if kind]
    return f"{markdown(head, lines, left=3)}\n" + "\n\n".join(text) + "\n"


def _split(rows: Iterable[Row]) -> Dict[str, List[Row]]:
    kinds: Dict[str, List[Row]] = {"random games": [], "games of random scenarios": []}
    for row in rows:
        kinds["games of random scenarios" if row["name"].endswith("scenario") else "random games"].append(row)
    return kinds


def sentence(which: str, rows: List[Row]) -> str:
    """What these rows say together."""
    differ = [f"{row['name']} {row['game']} {n}" for row in rows for n in row["differ"]]
    text = f"{_total(rows, 'games'):,} {which}: "
    text += f"**{len(differ)} differ** ({', '.join(differ[:10])})" if differ else "all verdicts agree"
    text += f"; {_total(rows, 'undecided'):,} are decided by nobody within the limits. "
    decided, undecided = (_by(rows, f"{word}decided_by") for word in ("", "un"))
    # Who leaves something out finds no verdict where that does not help: that is no limit.
    text += "Verdicts: " + ", ".join(f"{who} {count:,}" for who, count in decided.items()) + ". "
    at_limit = {who: count for who, count in undecided.items() if which == "random games" or who in _EXACT}
    if at_limit:
        text += "At a limit: " + ", ".join(f"{who} {count:,}" for who, count in at_limit.items()) + ". "
    text += (
        f"Strategies: both checkers prove {_total(rows, 'proven'):,}; {_total(rows, 'half_proven'):,} are large, and "
        f"looked at by the native one alone; {_total(rows, 'unproven'):,} took more than a proof may here"
    )
    stages = _total(rows, "stages")
    return text + (f"; {stages:,} are in stages." if stages else ".")


_EXACT = ("whole", "command", "python")


def _total(rows: List[Row], key: str) -> int:
    return sum(row[key] for row in rows)


def _by(rows: List[Row], key: str) -> Dict[str, int]:
    counts: Dict[str, int] = {}
    for row in rows:
        for who, count in row[key].items():
            counts[who] = counts.get(who, 0) + count
    return counts
