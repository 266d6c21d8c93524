"""One look for all pictures: fonts, sizes, and an agent's colour, line and shape; and the one writer of SVG.

Pictures are read in black and white too: an agent has a line pattern, a filling and a shape as well as a colour, and
the colours differ in lightness (after Okabe and Ito's palette for people who see colours differently).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Dict, Iterable, Mapping, Sequence, Tuple

from pursue_gen.language.numbers import rounded_text

FONT = "'DejaVu Sans',Verdana,Helvetica,Arial,sans-serif"
TEXT_SIZE, SMALL_SIZE = 14, 12  # px
INK, QUIET, PAPER, RULE, ACCENT = "#1b1f24", "#57606a", "#ffffff", "#8a8f98", "#22577a"

STYLE = (
    f".pg text{{font-family:{FONT};font-size:{TEXT_SIZE}px;fill:{INK}}}"
    f".pg .pg-small{{font-size:{SMALL_SIZE}px;fill:{QUIET}}}"
    ".pg .pg-strong{font-weight:bold}"
    f".pg .pg-halo{{stroke:{PAPER};stroke-width:4px;paint-order:stroke;stroke-linejoin:round}}"
    f".pg .pg-rule{{stroke:{RULE};stroke-width:1;fill:none}}"
    f".pg .pg-way{{stroke:{RULE};stroke-width:3;fill:none}}"
    f".pg .pg-poi{{fill:{PAPER};stroke:{ACCENT};stroke-width:2}}"
)
"""Classes for all pictures; they apply below an element of class `pg`, which `svg` makes."""

_COLOURS = ("#0072b2", "#a3410b", "#00785a", "#7b2d7f", "#8a6d00", "#3a3f47", "#c2185b", "#2f7fb5")
_DASHES = ("", "8 4", "2 3", "10 3 2 3", "14 5", "5 2 1 2 1 2", "1 5", "12 2")
_SHAPES = ("circle", "square", "triangle", "diamond", "hexagon", "cross", "pentagon", "star")
_FILLS = ("solid", "diagonal", "dots", "cross", "level", "upright", "counter", "empty")
_ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ESCAPED = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;"})
_POLYGONS: Mapping[str, Tuple[Tuple[float, float], ...]] = {
    "square": ((-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)),
    "triangle": ((0, -1.05), (1, 0.8), (-1, 0.8)),
    "diamond": ((0, -1.15), (1.15, 0), (0, 1.15), (-1.15, 0)),
    "hexagon": ((-0.5, -0.9), (0.5, -0.9), (1, 0), (0.5, 0.9), (-0.5, 0.9), (-1, 0)),
    "cross": (
        (-0.35, -1), (0.35, -1), (0.35, -0.35), (1, -0.35), (1, 0.35), (0.35, 0.35),
        (0.35, 1), (-0.35, 1), (-0.35, 0.35), (-1, 0.35), (-1, -0.35), (-0.35, -0.35),
    ),
    "pentagon": ((0, -1.05), (1, -0.3), (0.62, 0.88), (-0.62, 0.88), (-1, -0.3)),
    "star": (
        (0, -1.15), (0.27, -0.37), (1.09, -0.36), (0.44, 0.14), (0.68, 0.93),
        (0, 0.46), (-0.68, 0.93), (-0.44, 0.14), (-1.09, -0.36), (-0.27, -0.37),
    ),
}  # fmt: skip


@dataclass(frozen=True)
class AgentLook:
    """How an agent is drawn: `colour` (hex), `dash` (stroke-dasharray, "" is a full line), `shape`, `fill` (a pattern).

    `shape` is one of circle, square, triangle, diamond, hexagon, cross, pentagon, star; `fill` names a pattern of
    `patterns`.
    """

    colour: str
    dash: str
    shape: str
    fill: str


def agent_looks(names: Sequence[str]) -> Dict[str, AgentLook]:
    """Agent → its look, the same in every picture: pass the agents in the order in which the scenario declares them."""
    looks = {}
    for place, name in enumerate(names):
        at, round_ = place % len(_COLOURS), place // len(_COLOURS)
        other = (at + round_) % len(_DASHES)  # after eight agents the combination differs, never the single mark
        looks[name] = AgentLook(_COLOURS[at], _DASHES[other], _SHAPES[(at + 2 * round_) % len(_SHAPES)], _FILLS[other])
    return looks


def clean(words: object) -> str:
    """The text without letters that XML cannot hold; they become U+FFFD."""
    return _ILLEGAL.sub("\ufffd", str(words))


def safe(words: object) -> str:
    """The text escaped for XML and HTML, between tags and in attributes."""
    return clean(words).translate(_ESCAPED)


def number(value: float) -> str:
    """A coordinate: at most two decimals, no needless zeros, the same on every machine."""
    return rounded_text(value, 2)


def tag(name: str, *children: str, **attributes: object) -> str:
    """An element. `children` are markup already; attribute values are escaped here and None leaves one out.

    `class_` becomes class, an underscore a hyphen: tag("line", x1=0, stroke_width=2). Floats are written by `number`.
    """
    parts = [name]
    for key, value in attributes.items():
        if value is None or value == "":
            continue
        shown = number(value) if isinstance(value, float) else safe(value)
        parts.append(f'{key.rstrip("_").replace("_", "-")}="{shown}"')
    opened = " ".join(parts)
    return f"<{opened}>{''.join(children)}</{name}>" if children else f"<{opened}/>"


def text(x: float, y: float, words: object, kind: str = "", anchor: str = "middle", **attributes: object) -> str:
    """Words at a point (their base line). `kind`: classes of STYLE, such as "pg-small" or "pg-strong pg-halo"."""
    return tag("text", safe(words), x=float(x), y=float(y), class_=kind, text_anchor=anchor, **attributes)


def mark(look: AgentLook, x: float, y: float, size: float = 8.0, **attributes: object) -> str:
    """The agent's shape around a point; `size` is about half its height."""
    if look.shape == "circle":
        return tag("circle", cx=float(x), cy=float(y), r=float(size), fill=look.colour, **attributes)
    points = " ".join(f"{number(x + size * dx)},{number(y + size * dy)}" for dx, dy in _POLYGONS[look.shape])
    return tag("polygon", points=points, fill=look.colour, **attributes)


def patterns(looks: Mapping[str, AgentLook], prefix: str) -> str:
    """<defs> with a filling for each agent, for bars and areas: fill="url(#<prefix>-fill-<n>)", n counting from 0.

    `prefix` keeps the ids of two pictures of one page apart.
    """
    return tag("defs", *(_pattern(look, f"{prefix}-fill-{place}") for place, look in enumerate(looks.values())))


def _pattern(look: AgentLook, ident: str) -> str:
    """A light ground with strokes of the agent's colour; each agent has another hatching."""
    strokes = {
        "diagonal": "M-2,2 L2,-2 M0,8 L8,0 M6,10 L10,6",
        "counter": "M-2,6 L2,10 M0,0 L8,8 M6,-2 L10,2",
        "cross": "M0,0 L8,8 M8,0 L0,8",
        "level": "M0,4 L8,4",
        "upright": "M4,0 L4,8",
    }
    ground = look.colour if look.fill == "solid" else PAPER
    parts = [tag("rect", width=8, height=8, fill=ground)]
    if look.fill in strokes:
        parts.append(tag("path", d=strokes[look.fill], stroke=look.colour, stroke_width=2, fill="none"))
    if look.fill == "dots":
        parts += [tag("circle", cx=at, cy=at, r=1.5, fill=look.colour) for at in (2, 6)]
    return tag("pattern", *parts, id=ident, width=8, height=8, patternUnits="userSpaceOnUse")


def svg(width: float, height: float, title: str, description: str, body: Iterable[str], ident: str = "") -> str:
    """A picture: a complete SVG document that can stand inside a page too.

    `title` and `description` are read to people who cannot see it. `ident` becomes its id in a page.
    """
    size = f"{number(width)} {number(height)}"
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="pg" role="img" viewBox="0 0 {size}" '
        f'width="{number(width)}" height="{number(height)}" style="max-width:100%;height:auto"'
        + (f' id="{safe(ident)}">' if ident else ">")
    )
    texts = f"<title>{safe(title)}</title>\n<desc>{safe(description)}</desc>\n<style>{STYLE}</style>"
    ground = tag("rect", width="100%", height="100%", fill=PAPER)
    return "\n".join([head, texts, ground, *body, "</svg>"]) + "\n"
