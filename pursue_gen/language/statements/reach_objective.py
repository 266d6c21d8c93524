"""`reach_objective: do e`: what is reached once."""

from __future__ import annotations

from typing import ClassVar, Mapping, Tuple, Type

from pursue_gen.language.objectives import Reach
from pursue_gen.language.statements.base import Headed, forms_behind
from pursue_gen.language.word import Form, Word


class ReachObjective(Headed):
    """What is reached once."""

    kinds: ClassVar[Mapping[str, Type[Reach]]] = {"reach": Reach}
    own_words: ClassVar[Tuple[Word, ...]] = (Word("reach_objective", "What is to be achieved once."), *Reach.own_words)
    forms: ClassVar[Tuple[Form, ...]] = forms_behind("reach_objective", kinds)
    among: ClassVar[str] = "OBJECTIVE"
