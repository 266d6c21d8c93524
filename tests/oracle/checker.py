"""Which of the two checkers is used: the native one, or its readable twin."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Iterator, Mapping
from unittest import mock

from pursue_gen.proof import simplify
from pursue_gen.proof.closed_loop import ClosedLoop
from pursue_gen.solving import proving
from tests.oracle import search
from tests.oracle.simplify import simplified

_SEARCHES = "everything", "ends", "covered", "latest"
_NATIVE = {name: getattr(ClosedLoop, name) for name in _SEARCHES}
_PYTHON = {name: getattr(search, name) for name in _SEARCHES}
_SIMPLIFIED = simplify.simplified


@contextmanager
def in_python() -> Iterator[None]:
    """The checker in Python."""
    with _making(_PYTHON, simplified):
        yield


@contextmanager
def natively() -> Iterator[None]:
    """The native checker, also within `in_python`."""
    with _making(_NATIVE, _SIMPLIFIED):
        yield


@contextmanager
def _making(searches: Mapping[str, Any], fewer: Any) -> Iterator[None]:
    patches = mock.patch.multiple(ClosedLoop, **searches), mock.patch.object(simplify, "simplified", fewer)
    with patches[0], patches[1], mock.patch.object(proving, "simplified", fewer):
        yield
