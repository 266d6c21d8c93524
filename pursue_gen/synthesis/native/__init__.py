"""The native engine: C++17 behind pybind11."""

from __future__ import annotations

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Unavailable


def not_built(what: str) -> Unavailable:
    """The error (exit status 6) where a module in C++, such as "solver", is missing: what to do about it."""
    hint = "install a C++17 compiler (Debian: g++ python3-dev), then pursue-gen again; in a checkout: ./run setup"
    return Unavailable([error("SYN011", f"the {what} was not built when pursue-gen was installed", hint=hint)])
