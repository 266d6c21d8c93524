"""Choices that property tests make again and again, as strategies that are made but once."""

from __future__ import annotations

import functools
from typing import Sequence, Tuple, TypeVar

from hypothesis import strategies as st

T = TypeVar("T")


def member_of(some: Sequence[T]) -> st.SearchStrategy[T]:
    """One of these, which can be hashed, as `sampled_from` draws it.

    A strategy that is made anew for each draw takes several times as long as what is drawn: it has to be validated, and
    is garbage in circles then. hypothesis keeps those of `lists`, `integers` and the like, but not `sampled_from`.
    """
    return _made(tuple(map(type, some)), tuple(some))


@functools.lru_cache(maxsize=1_000)
def _made(kinds: Tuple[type, ...], some: Tuple[T, ...]) -> st.SearchStrategy[T]:
    """The strategy for these of these types: 1 is not True."""
    return st.sampled_from(some)
