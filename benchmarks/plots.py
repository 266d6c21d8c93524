"""The growth of the families as pictures (SVG), readable without colour. Nothing else here needs matplotlib."""

from __future__ import annotations

import io
from typing import Any, Dict, List, Sequence, Tuple

from benchmarks.families import FAMILIES, Family

Row = Dict[str, Any]

FIGURES = (("states", "states"), ("seconds", "seconds to solve and prove"), ("commands", "commands"))
MARKERS = ("o", "s", "^")
GAMES = {"ideal": ("-", "white"), "default": ("--", "black")}  # how the line looks, and what fills its marks


def pictures(rows: Sequence[Row]) -> Dict[str, str]:
    """One picture for each thing that grows, by file name; the same rows give the same bytes."""
    import matplotlib

    matplotlib.use("svg")
    # Text stays text: smaller, and found by a search. The salt fixes the names that clip paths get.
    settings: Dict[Any, Any] = {"svg.fonttype": "none", "svg.hashsalt": "pursue-gen", "font.size": 9}
    settings["font.sans-serif"] = ["DejaVu Sans"]  # comes with matplotlib, so that every machine draws the same
    drawn: Dict[str, str] = {}
    with matplotlib.rc_context(settings):
        for grows in dict.fromkeys(family.grows for family in FAMILIES):
            families = [family for family in FAMILIES if family.grows == grows]
            if any(_points(rows, family, game, "states") for family in families for game in GAMES):
                drawn[f"{grows.replace(' ', '_').lower()}.svg"] = _picture(grows, families, rows)
    return drawn


def _picture(grows: str, families: Sequence[Family], rows: Sequence[Row]) -> str:
    """Three axes side by side, one per figure; a line per family and game."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import NullFormatter, NullLocator

    # Not with pyplot, which keeps figures of its own.
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    axes = figure.subplots(1, len(FIGURES))
    for ax, (key, title) in zip(axes, FIGURES):
        for family, marker in zip(families, MARKERS):
            for game, (style, fill) in GAMES.items():
                points = _points(rows, family, game, key)
                look = {"linestyle": style, "marker": marker, "markersize": 5, "markerfacecolor": fill}
                xs, ys = [x for x, _ in points], [y for _, y in points]
                ax.plot(xs, ys, color="black", linewidth=1, label=f"{family.name}, {game}", **look)
        ax.set_yscale("log")
        sizes = sorted({size for family in families for size in family.sizes})
        if sizes[0] > 0:  # growth with a power is a straight line
            ax.set_xscale("log")
        else:
            ax.set_xscale("symlog", linthresh=1, linscale=0.3)
            ax.set_xlim(-0.5)
        shown = _apart(sizes)
        ax.set_xticks(shown, [str(size) for size in shown])
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_minor_locator(NullLocator())
            axis.set_minor_formatter(NullFormatter())
        ax.set_xlabel(grows)
        ax.set_title(title, fontsize=9)
        ax.grid(color="0.85", linewidth=0.5)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, handlelength=4)
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.strip() for line in stream.getvalue().splitlines()) + "\n"


def _apart(sizes: Sequence[int]) -> List[int]:
    """The sizes, but for those that would stand too close to the one before on a logarithmic axis."""
    shown: List[int] = []
    for size in sizes:
        if not shown or shown[-1] == 0 or size / shown[-1] > _APART:
            shown.append(size)
    return shown


_APART = 1.26


def _points(rows: Sequence[Row], family: Family, game: str, key: str) -> List[Tuple[int, float]]:
    """(size, figure), by size, of what is known and can stand on a logarithmic axis."""
    mine = [row for row in rows if (row["group"], row["name"], row["game"]) == ("family", family.name, game)]
    return sorted((row["size"], row[key]) for row in mine if row.get(key))
