"""Which of the two checkers is used: the native one, or its readable twin, which the product has for large numbers."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Iterator
from unittest import mock

from pursue_gen.proof import simplify
from pursue_gen.proof.native import search
from pursue_gen.proof.native.tables import NotHeld, tables_of
from tests.oracle.simplify import simplified

_NATIVELY = simplify._natively


@contextmanager
def in_python() -> Iterator[None]:
    """The checker in Python, as for networks that the native one does not hold."""
    with _making(mock.Mock(side_effect=NotHeld), simplified):
        yield


@contextmanager
def natively() -> Iterator[None]:
    """The native checker, also within `in_python`."""
    with _making(tables_of, _NATIVELY):
        yield


@contextmanager
def _making(tables: Any, fewer: Any) -> Iterator[None]:
    with mock.patch.object(search, "tables_of", tables), mock.patch.object(simplify, "_natively", fewer):
        yield
