"""`pursue-gen explain`: what a message means, and what to do about it."""

from __future__ import annotations

from pathlib import Path
from typing import List, Optional

import typer

from pursue_gen.cli.console import guarded
from pursue_gen.diagnostics import usage_error


@guarded
def explain(
    code: Optional[str] = typer.Argument(None, metavar="CODE", help="The code of a message, such as PML110."),
) -> None:
    """Tell what a message means, with an example, and what to do. Without a code: list them all."""
    known = codes()
    if code is None:
        for name in known:
            print(title(name))
        return
    wanted = code.strip().upper()
    if wanted not in known:
        raise usage_error(f"there is no message with the code {code[:40]}", _proposal(wanted, known))
    print((pages_dir() / f"{wanted}.md").read_text(encoding="utf-8"), end="")


def pages_dir() -> Path:
    """The pages on messages: beside the installed generator, or in the checkout it runs from."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "_diagnostics"
    return installed if installed.is_dir() else package.parent / "docs" / "diagnostics"


def codes() -> List[str]:
    """The codes that have a page, in order."""
    return sorted(page.stem for page in pages_dir().glob("*.md"))


def title(code: str) -> str:
    """The first line of a page: the code and what it is about."""
    with open(str(pages_dir() / f"{code}.md"), encoding="utf-8") as page:
        return page.readline().lstrip("# ").rstrip()


def _proposal(wanted: str, known: List[str]) -> str:
    from pursue_gen.language.similar import closest

    digits = wanted[:3] + wanted[3:].translate(str.maketrans("OIL", "011"))  # as the eye takes them
    close = digits if digits in known else closest(wanted, tuple(known))
    return f"did you mean {close}? pursue-gen explain lists all" if close else "pursue-gen explain lists all codes"
