"""The page on simulated missions with faults: what benchmarks/simulation.py found, as tables."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

from benchmarks import page
from benchmarks.tables import markdown

Results = Mapping[str, Any]
Row = Mapping[str, Any]

HEAD = (
    "scenario", "margin", "missions", "goal or safe", "%", "safe stop", "holding", "lost", "latest command",
    "command too late", "agent off its model", "our fault",
)  # fmt: skip

TITLES = {
    "loss=0.01": "One message in 100 is lost (`loss=0.01`)",
    "loss": "One message in 20 is lost (`loss`)",
    "loss=0.1": "One message in 10 is lost (`loss=0.1`)",
    "loss=0.2": "One message in 5 is lost (`loss=0.2`)",
    "restart": "One node dies once, and is back within the margin (`restart`)",
    "orders": "One order in 20 finds its robot disconnected (`orders`)",
    "duplicates": "One message in 10 arrives twice (`duplicates`)",
    "reorder": "One message in 10 is overtaken (`reorder`)",
    "delay": "One message in 10 is late by up to 5 s (`delay`)",
    "deaths": "Up to three nodes die for 0.3 to 3 s (`deaths`)",
    "all": "All faults",
}


def cells_of(results: Results, faults: str) -> List[Row]:
    """The rows of these faults, by scenario."""
    rows = (row for row in results.get("cells", {}).values() if row["faults"] == faults)
    return sorted(rows, key=lambda row: str(row["scenario"]))


def ends_table(rows: List[Row]) -> str:
    """How the missions ended, and why those that were lost were."""
    lines = [_line(str(row["scenario"]), f"{row['margin']:g}", [row]) for row in rows]
    if len(rows) > 1:
        lines.append(_line("all", "", rows))
    return markdown(HEAD, lines, left=1)


def _line(name: str, margin: str, rows: List[Row]) -> List[str]:
    def total(part: str, *keys: str) -> int:
        return sum(row[part].get(key, 0) for row in rows for key in keys)

    missions, good = sum(row["missions"] for row in rows), total("ends", "goal", "safe")
    ends = [total("ends", end) for end in ("stopped", "held")]
    causes = [total("causes", cause) for cause in ("command", "agent", "ours")]
    latest = max(row["latest"] for row in rows)
    figures = [f"{missions:,}", f"{good:,}", f"{100 * good / missions:.2f}"]
    bad = [f"{number:,}" for number in (*ends, total("ends", "lost", "failed"))]
    return [name, margin, *figures, *bad, f"{latest:.3f}", *(f"{number:,}" for number in causes)]


def tables(results: Results) -> str:
    """A table for each kind of fault."""
    parts = []
    for faults, title in TITLES.items():
        rows = cells_of(results, faults)
        if rows:
            parts += [f"### {title}", "", ends_table(rows), ""]
    return "\n".join(parts) if parts else "Not measured.\n"


def examples(results: Results) -> str:
    """For each cell with lost missions the first one, with the fault that was too long."""
    lines = [
        [row["scenario"], f"`{row['faults']}`", str(row["examples"][0]["seed"]), row["examples"][0]["cause"]]
        for faults in TITLES
        for row in cells_of(results, faults)
        if row["examples"]
    ]
    return markdown(("scenario", "faults", "mission", "cause"), lines, left=4) if lines else "No mission was lost.\n"


def speed_table(results: Results) -> str:
    """Missions per second of processor time."""
    speed = results.get("speed")
    if not speed:
        return "Not measured.\n"
    before = results.get("speed before", {})
    lines = [[name, str(before.get(name, "")), str(rate)] for name, rate in speed["rates"].items()]
    table = markdown(("scenario", "before, missions/s", "now, missions/s"), lines, left=1)
    return f"Measured {speed['date']} on {speed['machine']}, while other work ran.\n\n{table}"


def count(results: Results) -> str:
    """How many missions the tables have."""
    rows = list(results.get("cells", {}).values())
    missions = sum(row["missions"] for row in rows)
    wrong = sum(row["causes"].get("ours", 0) for row in rows)
    faults = sum(row["missions"] for row in rows if row["faults"] == "all")
    what = f"{missions:,} missions, {faults:,} of them with all faults"
    end = f"{wrong} of them failed a check, or were lost without a fault that was too long"
    return f"{what}; {end}.\n\n{played(results)}"


def played(results: Results) -> str:
    """When the rows were played, and with which commit."""
    rows: Dict[Tuple[str, str], Dict[str, List[str]]] = {}
    for faults in TITLES:
        for row in cells_of(results, faults):
            of_stamp = rows.setdefault((row["date"], row["commit"]), {})
            of_stamp.setdefault(faults, []).append(str(row["scenario"]))
    lines = []
    for (date, commit), found in sorted(rows.items(), reverse=True):
        whole = [f"`{faults}`" for faults, names in found.items() if len(names) == len(cells_of(results, faults))]
        parts = [
            f"`{faults}` of {', '.join(names)}"
            for faults, names in found.items()
            if len(names) < len(cells_of(results, faults))
        ]
        lines.append([date, commit, "; ".join([*([", ".join(whole)] if whole else []), *parts])])
    return markdown(("played", "with commit", "rows"), lines, left=3) if lines else ""


PARTS: Dict[str, Callable[[Results], str]] = {
    "count": count,
    "tables": tables,
    "lost missions": examples,
    "speed": speed_table,
}


def filled(text: Optional[str], results: Dict[str, Any]) -> str:
    """The page with its measured parts made anew."""
    return page.filled(text, results, PARTS, title="Simulated missions with faults")
