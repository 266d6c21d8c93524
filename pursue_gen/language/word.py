"""Words of the language, and forms of statements to fill in."""

from __future__ import annotations

import re
from typing import Callable, Mapping, NamedTuple

from pursue_gen.language.numbers import Number


class Word(NamedTuple):
    """A word of the language and what it means, in a sentence.

    `may_be_name`: it is younger than many scenarios, which may have something that is called so; `may_break`: a line
    that is too long may be broken before it.
    """

    text: str
    meaning: str
    may_be_name: bool = False
    may_break: bool = False

    @property
    def token(self) -> str:
        """Its token."""
        return self.text.upper()


HOLE = re.compile(r"\{(=?)([^}]*)\}")
"""A hole in the words of a form: {kind of thing}, or {=an example}."""


class Form(NamedTuple):
    """A way to write a statement. `words`: the statement with holes; a hole is {kind of thing} or {=an example}."""

    title: str
    words: str


Numbers = Mapping[str, Callable[[str, Number], str]]
"""What numbers mean, by the word before each: a sentence from the number as a time, and from the number itself."""
