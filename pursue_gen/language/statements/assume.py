"""`assume: …`: what agents that are not controlled do, or do not do; its kinds are in `language.assumptions`."""

from __future__ import annotations

from typing import ClassVar, Tuple

from pursue_gen.language.assumptions import KINDS
from pursue_gen.language.statements.base import Headed, forms_behind
from pursue_gen.language.word import Form, Word


class Assume(Headed):
    """What is assumed."""

    kinds = KINDS
    listed_in: ClassVar[str] = "assumptions"
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("assume", "What an agent that is not controlled is assumed to do, or not to do. A mission watches it."),
        *(word for kind in KINDS.values() for word in kind.own_words),
    )
    forms: ClassVar[Tuple[Form, ...]] = forms_behind("assume", KINDS)
