"""SVG to PNG, by what the machine has: the program rsvg-convert, or the Python package cairosvg."""

from __future__ import annotations

import importlib
import shutil
import subprocess
from typing import Any

from pursue_gen.diagnostics import error, warning
from pursue_gen.outcomes import Unavailable

_SECONDS = 60
_HINT = "install it (Debian, Ubuntu: sudo apt install librsvg2-bin; or pip install cairosvg)"

NO_PNG = warning("REP003", "the pictures were written as SVG only: rsvg-convert makes PNG, and is missing", hint=_HINT)
"""What to report where PNGs cannot be made."""


def available() -> bool:
    """True if PNGs can be made here."""
    return shutil.which("rsvg-convert") is not None or _cairosvg() is not None


def png(svg: str, zoom: float = 2.0) -> bytes:
    """The picture as PNG, `zoom` pixels for each of its own; `available` must be true.

    Raises Unavailable where the program fails.
    """
    program = shutil.which("rsvg-convert")
    if program is not None:
        return _converted(program, svg, zoom)
    return bytes(_cairosvg().svg2png(bytestring=svg.encode("utf-8"), scale=zoom))


def _cairosvg() -> Any:
    """The package; None where it is missing."""
    try:
        return importlib.import_module("cairosvg")
    except (ImportError, OSError):  # OSError: it is there and the library cairo is not
        return None


def _converted(program: str, svg: str, zoom: float) -> bytes:
    words = [program, "--format", "png", "--zoom", f"{zoom:g}", "--unlimited"]
    try:
        done = subprocess.run(
            words,
            input=svg.encode("utf-8"),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            timeout=_SECONDS,
            check=True,
        )
    except (OSError, subprocess.SubprocessError) as problem:
        output = getattr(problem, "stderr", None) or b""
        reason = output.decode("utf-8", "replace").strip() or str(problem)
        message = f"rsvg-convert could not make a PNG: {reason}"
        raise Unavailable([error("REP004", message, hint=_HINT)]) from None
    return done.stdout
