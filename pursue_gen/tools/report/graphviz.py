"""Pictures that graphviz lays out: its program `dot` is called if it is installed; nothing else of it is needed."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence

from pursue_gen.drawing.look import FONT, INK, PAPER, clean, safe

HOW_TO_GET = "install graphviz (Debian, Ubuntu: sudo apt install graphviz) and make the report again"
_SECONDS = 20
_FONT = "DejaVu Sans"
_HEAD = re.compile(r"<svg[^>]*?viewBox=\"([^\"]*)\"[^>]*>", re.S)
_UNWANTED = re.compile(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<!--.*?-->", re.S)
_TITLES = re.compile(r"<title>.*?</title>\n?", re.S)


@dataclass(frozen=True)
class Graph:
    """What is drawn: lines of DOT, made with `node` and `arrow`. `ident` begins every id in the picture."""

    ident: str
    title: str
    description: str
    lines: Sequence[str]
    sideways: bool = False


def quoted(text: object) -> str:
    """A text as DOT has it; line feeds begin new lines."""
    return '"' + clean(text).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def node(ident: str, label: str, **attributes: object) -> str:
    """A node; attributes as DOT has them."""
    return f"{quoted(ident)} [{_listed({'id': ident, 'label': label, **attributes})}];"


def arrow(source: str, target: str, ident: str, label: str = "", **attributes: object) -> str:
    """An arrow between two nodes; the lines of its label stand a little to its right."""
    indented = "\n".join(f"\u00a0\u00a0{line}" for line in label.split("\n")) if label else ""
    more = {"id": ident, **({"label": indented} if indented else {}), **attributes}
    return f"{quoted(source)} -> {quoted(target)} [{_listed(more)}];"


def dot_text(graph: Graph) -> str:
    """The graph as DOT."""
    common = f'fontname={quoted(_FONT)} fontcolor="{INK}"'
    head = [
        "digraph {",
        f'graph [id={quoted(graph.ident + "-graph")} rankdir={"LR" if graph.sideways else "TB"} bgcolor="{PAPER}" '
        f"pad=0.2 nodesep=0.35 ranksep=0.5 {common}];",
        f'node [fontsize=12 shape=box style="rounded,filled" fillcolor="{PAPER}" color="{INK}" margin="0.12,0.06" '
        f"{common}];",
        f'edge [fontsize=10 color="{INK}" arrowsize=0.8 {common}];',
    ]
    return "\n".join([*head, *graph.lines, "}"]) + "\n"


def installed() -> bool:
    """Is there a `dot` on this machine?"""
    return shutil.which("dot") is not None


def draw(graph: Graph) -> Optional[str]:
    """The picture as SVG; None where graphviz is not installed, fails, or takes longer than some seconds."""
    program = shutil.which("dot")
    if program is None:
        return None
    try:
        done = subprocess.run(
            [program, "-Tsvg"],
            input=dot_text(graph).encode("utf-8"),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=_SECONDS,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return _with_head(done.stdout.decode("utf-8", "replace"), graph)


def _with_head(text: str, graph: Graph) -> Optional[str]:
    """Graphviz's SVG with our head: no program's name, titles that say something, sizes in pixels."""
    text = _TITLES.sub("", _UNWANTED.sub("", text)).replace(f'font-family="{_FONT}"', f'font-family="{FONT}"')
    found = _HEAD.search(text)
    if found is None:
        return None
    _, _, width, height = (float(number) for number in found.group(1).split())
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="graph" role="img" id="{safe(graph.ident)}" '
        f'viewBox="{found.group(1)}" width="{width:.0f}" height="{height:.0f}">\n'
        f"<title>{safe(graph.title)}</title>\n<desc>{safe(graph.description)}</desc>\n"
    )
    return head + text[found.end() :].lstrip()


def _listed(attributes: Dict[str, object]) -> str:
    parts: List[str] = [f"{key}={quoted(value)}" for key, value in attributes.items()]
    return " ".join(parts)
