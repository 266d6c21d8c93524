"""A survey as a table for people, and as data for programs."""

from __future__ import annotations

from dataclasses import astuple
from typing import Any, Dict, List

from pursue_gen.columns import columns
from pursue_gen.survey.make import Survey, SurveyedWay


def table(survey: Survey) -> List[str]:
    """A line for each way with its length and what becomes of its distance, then those for travel times and spots."""
    rows = [("way", "metres", "distance")]
    for way in survey.ways:
        metres = "-" if way.metres is None else f"{way.metres:.2f}"
        rows.append((f"{way.a} - {way.b}", metres, _distance(way)))
    lines = columns(rows, "<><")
    windows = [one for way in survey.ways for one in way.windows]
    lines += [f"travel {robot} from {a} to {b} takes {low} to {high}" for robot, a, b, low, high in windows]
    for place, spots in survey.spots.items():
        lines += [f"spot of {robot} at {place}: {pose.x:g}, {pose.y:g}" for robot, pose in spots.items()]
    return lines


def _distance(way: SurveyedWay) -> str:
    crossed = f", leads through {', '.join(way.crossed)}" if way.crossed else ""
    if way.kept:
        return f"{way.given} stays: {way.kept}{crossed}"
    if way.given is None:
        return f"{way.written} (missing in the scenario){crossed}"
    return f"{way.given}{crossed}" if way.given == way.written else f"{way.given} -> {way.written}{crossed}"


def as_data(survey: Survey) -> Dict[str, Any]:
    """The survey as JSON: `ways` (metres, `line`: the bends of the path on the map) and `spots` (poses as lists)."""
    return {
        "ways": [
            {
                "a": way.a,
                "b": way.b,
                "given": None if way.given is None else float(way.given),
                "metres": None if way.metres is None else round(way.metres, 3),
                "written": None if way.written is None else float(way.written),
                "kept": way.kept,
                "crossed": list(way.crossed),
                "windows": [
                    {"agent": robot, "from": a, "to": b, "earliest": low, "latest": high}
                    for robot, a, b, low, high in way.windows
                ],
                "line": [[round(x, 3), round(y, 3)] for x, y in way.line],
            }
            for way in survey.ways
        ],
        "spots": {
            place: {robot: list(astuple(pose)) for robot, pose in found.items()}
            for place, found in survey.spots.items()
        },
    }
