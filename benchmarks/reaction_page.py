"""The page on reactions: what benchmarks/reaction.py and benchmarks/soak.py measured, as tables."""

from __future__ import annotations

from typing import Any, Callable, Dict, Mapping, Optional

from benchmarks import page
from benchmarks.tables import markdown

Results = Mapping[str, Any]

NAMES = {
    "floor": "floor: three bare hops",
    "command": "the command is on `pursue/events`: three hops",
    "order": "the robot has its order: five hops",
    "thesis": "the thesis's scheme, the robot has its order",
}


def reaction_table(results: Results) -> str:
    """Milliseconds from an event to what follows from it, and as multiples of the floor's."""
    times = results.get("reaction", {})
    floor = times.get("floor", {})
    lines = []
    for name, title in NAMES.items():
        if name in times:
            row = times[name]
            ratio = [f"{row[key] / floor[key]:.1f}" if floor.get(key) else "-" for key in ("median", "p99")]
            figures = [f"{row[key]:.2f}" for key in ("median", "p99", "worst")]
            lines.append([title, f"{row['count']:.0f}", *figures, *ratio])
    head = ("from the event until", "events", "median, ms", "p99, ms", "worst, ms", "median / floor", "p99 / floor")
    return markdown(head, lines, left=1)


def idle_table(results: Results) -> str:
    """What a waiting mission costs."""
    idle = results.get("idle", {})
    lines = [[f"`{name}`", f"{share:.2f}"] for name, share in idle.items()]
    return markdown(("node", "percent of a core"), lines, left=1)


def soak_table(results: Results) -> str:
    """Memory of each node after the warm-up and at the end of a long mission."""
    soak = results.get("soak", {})
    lines = []
    for name, rss in soak.get("memory", {}).items():
        growth = rss["end"] - rss["warm"]
        lines.append([f"`{name}`", f"{rss['warm'] / 1024:.1f}", f"{rss['end'] / 1024:.1f}", f"{growth:+,d}"])
    return markdown(("node", "after the warm-up, MiB", "at the end, MiB", "growth, KiB"), lines, left=1)


def soak_sentences(results: Results) -> str:
    """What the long mission was."""
    soak = results.get("soak", {})
    if not soak:
        return "Not measured.\n"
    return (
        f"{soak['events']:,} events in {soak['mission_seconds']:,.0f} s of simulated time ({soak['seconds']:,.0f} s of "
        f"real time); warm-up: the first {soak['warm']:,} events. The largest distance between a clock of the state "
        f"and the time since its last reset: {soak['drift_ms']:.4f} ms.\n\n"
        f"Measured {soak['date']} on {soak['machine']}.\n"
    )


def _where(results: Results) -> str:
    return f"Measured {results['date']} on {results['machine']}.\n" if "reaction" in results else "Not measured.\n"


PARTS: Dict[str, Callable[[Dict[str, Any]], str]] = {
    "machine": _where,
    "reaction": reaction_table,
    "idle": idle_table,
    "soak": lambda results: f"{soak_sentences(results)}\n{soak_table(results)}",
}


def filled(text: Optional[str], results: Dict[str, Any]) -> str:
    """The page with its measured parts made anew."""
    return page.filled(text, results, PARTS, "Reaction")
