"""The native engine: C++17 behind pybind11."""

from __future__ import annotations

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import LimitHit, Unavailable


def not_built(what: str) -> Unavailable:
    """The error (exit status 6) where a module in C++, such as "solver", is missing: what to do about it."""
    hint = "install a C++17 compiler (Debian: g++ python3-dev), then pursue-gen again; in a checkout: ./run setup"
    return Unavailable([error("SYN011", f"the {what} was not built when pursue-gen was installed", hint=hint)])


def not_held(what: str) -> LimitHit:
    """The error (exit status 5) where a module in C++, such as "solver", has no room for a game: what to do."""
    hint = "choose a larger unit of time, or times with fewer decimals, so that the numbers become smaller"
    message = f"the {what} cannot hold the game: its times are too large, or it has too many clocks"
    return LimitHit([error("SYN012", message, hint=hint)])
