"""A picture of the map: the points of interest, the connections with their distances, and who starts where."""

from __future__ import annotations

from typing import Dict, List, Mapping, Tuple
from xml.sax.saxutils import escape

from pursue_gen.language.scenario import Pose, Scenario

_WIDTH = 640.0
_MARGIN = 70.0
_STYLE = (
    "text{font-family:sans-serif;font-size:14px;fill:#222;text-anchor:middle}"
    "line{stroke:#8a8f98;stroke-width:3}"
    ".poi{fill:#fff;stroke:#22577a;stroke-width:2}"
    ".distance{fill:#555;stroke:#fff;stroke-width:4;paint-order:stroke}"
    ".robot{fill:#22577a}.other{fill:#b23a48}.note{font-size:12px;fill:#555}"
)


def draw(scenario: Scenario, poses: Mapping[str, Pose], computed: bool) -> str:
    """The map as an SVG document; `computed` says under it that the poses were not given but computed."""
    places, height = _on_paper(poses)
    parts = [_connection(places[c.a], places[c.b], c.distance) for c in scenario.connections]
    parts += [_poi(name, places[name]) for name in sorted(places)]
    parts += _agents(scenario, places)
    if computed:
        parts.append(_text(_WIDTH / 2, height - 12, "positions computed from the distances", "note"))
    body = "\n".join(parts)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH:.0f} {height:.0f}">\n'
        f"<title>{escape(scenario.name)}</title>\n<style>{_STYLE}</style>\n"
        f'<rect width="100%" height="100%" fill="#fff"/>\n{body}\n</svg>\n'
    )


def _on_paper(poses: Mapping[str, Pose]) -> Tuple[Dict[str, Tuple[float, float]], float]:
    """POI → point on the picture (y downwards), and the picture's height; one scale for both directions."""
    xs = [pose.x for pose in poses.values()] or [0.0]
    ys = [pose.y for pose in poses.values()] or [0.0]
    room = _WIDTH - 2 * _MARGIN
    scale = room / max(max(xs) - min(xs), max(ys) - min(ys), 1e-6)
    left = (_WIDTH - scale * (max(xs) - min(xs))) / 2
    places = {name: (left + scale * (p.x - min(xs)), _MARGIN + scale * (max(ys) - p.y)) for name, p in poses.items()}
    return places, 2 * _MARGIN + scale * (max(ys) - min(ys))


def _connection(a: Tuple[float, float], b: Tuple[float, float], distance: int) -> str:
    line = f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}"/>'
    return f"{line}\n{_text((a[0] + b[0]) / 2, (a[1] + b[1]) / 2 + 5, str(distance), 'distance')}"


def _poi(name: str, at: Tuple[float, float]) -> str:
    return f'<circle class="poi" cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="18"/>\n{_text(at[0], at[1] + 5, name, "name")}'


def _agents(scenario: Scenario, places: Mapping[str, Tuple[float, float]]) -> List[str]:
    """The agents' names above the POI where they start, one above the other."""
    parts = []
    standing: Dict[str, int] = {}
    for agent in scenario.agents:
        if agent.location.name not in places:
            continue
        x, y = places[agent.location.name]
        row = standing.get(agent.location.name, 0)
        standing[agent.location.name] = row + 1
        parts.append(_text(x, y - 26 - 16 * row, agent.name, "robot" if agent.controllable else "other"))
    return parts


def _text(x: float, y: float, text: str, kind: str) -> str:
    return f'<text class="{kind}" x="{x:.1f}" y="{y:.1f}">{escape(text)}</text>'
