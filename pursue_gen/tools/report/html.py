"""One page that holds everything: no network, no other file. Sections put their parts into it.

The page runs only the scripts that its sections give as `script` (the browser checks their hashes), so nothing that a
scenario's author wrote can ever run.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, List, Sequence

import jinja2
from markupsafe import Markup

from pursue_gen import __version__
from pursue_gen.diagnostics import listed
from pursue_gen.drawing.look import safe

_NUMBER = re.compile(r"-?[\d,]+(\.\d+)?")


@dataclass(frozen=True)
class Section:
    """A part of the page.

    `id` is its anchor (unique in the page; begin ids inside `body_html` with it), `title` is plain text, `body_html`
    is markup in which every name has been escaped (`look.safe`). `style` and `script` are added to the page once.
    A script is run when the whole page is there; it must not rely on event attributes (onclick=…), which are blocked.
    """

    id: str
    title: str
    body_html: str
    style: str = ""
    script: str = ""


def page(title: str, sections: Sequence[Section]) -> str:
    """The complete HTML document. Raises ValueError where two sections have one id."""
    ids = [section.id for section in sections]
    if len(set(ids)) != len(ids):
        raise ValueError(f"two sections have one id: {ids}")
    style = "\n".join(_once([asset("page.css"), *(section.style for section in sections)]))
    scripts = _once([asset("page.js"), *(section.script for section in sections)])
    shown = {"title": title, "sections": sections, "style": style, "scripts": scripts}
    return rendered("page", **shown, hash=_hash, version=__version__) + "\n"


def rendered(template: str, **values: Any) -> str:
    """The markup that a template (`templates/*.html.j2`) makes of these values: they are escaped, unless they go
    through its filter `safe`.
    """
    return _templates().get_template(f"{template}.html.j2").render(values).rstrip("\n")


def table(heads: Sequence[object], rows: Sequence[Sequence[object]], caption: str = "") -> str:
    """A table of plain texts (escaped here); cells that are numbers stand to the right. It scrolls if too wide."""
    numbers = [bool(rows) and all(_is_number(row[k]) for row in rows) for k in range(len(heads))]
    kinds = [' class="number"' if right else "" for right in numbers]
    head = "".join(f'<th scope="col"{kind}>{safe(word)}</th>' for kind, word in zip(kinds, heads))
    body = "".join(f"<tr>{''.join(_cell(cell) for cell in row)}</tr>\n" for row in rows)
    caption_tag = f"<caption>{safe(caption)}</caption>" if caption else ""
    label = f' role="region" aria-label="{safe(caption)}"' if caption else ""
    whole = f"<table>{caption_tag}<thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table>"
    return f'<div class="wide" tabindex="0"{label}>{whole}</div>'


def figure(picture: str, caption: str) -> str:
    """A picture (SVG or <img>, markup already) with its caption (plain text). It scrolls if too wide."""
    caption = safe(caption)
    shown = f'<div class="wide picture" tabindex="0" role="region" aria-label="{caption}">{picture}</div>'
    return f"<figure>{shown}<figcaption>{caption}</figcaption></figure>"


def data(ident: str, value: Any) -> str:
    """Data for a section's script: JSON.parse(document.getElementById(ident).textContent)."""
    text = json.dumps(value, ensure_ascii=True, separators=(",", ":")).replace("<", "\\u003c").replace(">", "\\u003e")
    return f'<script type="application/json" id="{safe(ident)}">{text.replace("&", chr(92) + "u0026")}</script>'


def asset(name: str) -> str:
    """The text of a file of this package (css, js), for `style` and `script` of a section."""
    return (Path(__file__).parent / name).read_text(encoding="utf-8")


def _cell(cell: object) -> str:
    words = f"{cell:,}" if isinstance(cell, int) else str(cell)
    kind = ' class="number"' if _NUMBER.fullmatch(words) else ""
    return f"<td{kind}>{safe(words)}</td>"


def _is_number(cell: object) -> bool:
    return str(cell) in ("", "-") or bool(_NUMBER.fullmatch(str(cell)))


def _once(texts: Sequence[str]) -> List[str]:
    """The texts without empty ones and repetitions, in order."""
    return [text for text in dict.fromkeys(texts) if text]


@lru_cache(maxsize=1)
def _templates() -> jinja2.Environment:
    """How templates are rendered: every value goes through `look.safe`, since jinja2 keeps what XML cannot hold."""
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(Path(__file__).parent / "templates")),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=True,
        finalize=lambda value: value if isinstance(value, Markup) else Markup(safe(value)),
    )
    made.globals.update(figure=figure, listed=listed, table=table)
    return made


def _hash(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")
