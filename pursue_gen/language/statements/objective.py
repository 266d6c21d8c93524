"""`objective: …`: what always holds; its kinds are in `language.objectives`."""

from __future__ import annotations

from typing import ClassVar, Tuple

from pursue_gen.language.objectives import KINDS
from pursue_gen.language.statements.base import Headed, forms_behind
from pursue_gen.language.word import Form, Word


class Objective(Headed):
    """What always holds."""

    kinds = KINDS
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word(
            "objective",
            "What must always hold: an answer in time, an event that never happens, two agents who never meet.",
        ),
        *(word for kind in KINDS.values() for word in kind.own_words),
    )
    forms: ClassVar[Tuple[Form, ...]] = forms_behind("objective", KINDS)
