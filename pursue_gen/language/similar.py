"""Did you mean …: which of the known words a person probably had in mind."""

from __future__ import annotations

import difflib
import re
from functools import lru_cache
from typing import Dict, Iterable, Iterator, Tuple

_CLOSE = 0.65
_LONGEST = 80
_COMPARED = 4000
"""Pairs of words that are compared letter by letter, for all questions together; after that only single slips count."""


@lru_cache(maxsize=1024)
def closest(word: str, words: Tuple[str, ...]) -> str:
    """The one of a few words that is closest to `word`; the empty string: none is close."""
    plain = {plainly(known): known for known in reversed(words)}
    close = difflib.get_close_matches(plainly(word[:_LONGEST]), list(plain), n=1, cutoff=_CLOSE)
    return plain[close[0]] if close else ""


class Similar:
    """Many known words, arranged so that what a misspelled one means is found quickly."""

    def __init__(self, known: Iterable[str]) -> None:
        self.known: Tuple[str, ...] = tuple(known)
        self._left = _COMPARED
        self._told: Dict[str, str] = {}
        self._plain: Dict[str, str] = {}
        self._shorter: Dict[str, str] = {}

    def to(self, word: str) -> str:
        """The known word that is closest to `word`; the empty string: none is close."""
        if word not in self._told:
            self._told[word] = self._found(word)
        return self._told[word]

    def _found(self, word: str) -> str:
        if not self._plain:
            self._arrange()
        plain = plainly(word[:_LONGEST])
        if plain in self._plain:
            return self._plain[plain]
        near = next((self._shorter[part] for part in _without_one(plain) if part in self._shorter), "")
        if near or len(self.known) > self._left:
            return near
        self._left -= len(self.known)
        return closest(word, self.known)

    def _arrange(self) -> None:
        for name in self.known:
            plain = plainly(name[:_LONGEST])
            self._plain.setdefault(plain, name)
            for part in _without_one(plain):
                self._shorter.setdefault(part, name)


def plainly(word: str) -> str:
    """The word without what people confuse: capitals, `_` and `-`."""
    return re.sub("[-_]", "", word).lower() or word


def _without_one(word: str) -> Iterator[str]:
    """The word, and the word with each of its letters left out: words one slip apart share one of these."""
    if len(word) > 3:  # most short names are one letter apart
        yield word
        yield from (word[:place] + word[place + 1 :] for place in range(len(word)))
