"""`objective: …`: what always holds; its kinds are in `language.objectives`."""

from __future__ import annotations

from typing import Any, ClassVar, Mapping, Tuple, Union

from pursue_gen.language.objectives import KINDS, Safety
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


class Objective(StatementKind):
    """What always holds."""

    words: ClassVar[Tuple[Word, ...]] = (
        Word(
            "objective",
            "What must always hold: an answer in time, an event that never happens, two agents who never meet.",
        ),
        *(word for kind in KINDS.values() for word in kind.own_words),
    )
    grammar: ClassVar[str] = "\n".join(
        (
            f'safety: "objective" ":" ({" | ".join(KINDS)})',
            *(f"{name}: {kind.grammar}" for name, kind in KINDS.items()),
        )
    )
    form: ClassVar[str] = " · ".join(f"objective: {kind.form}" for kind in KINDS.values())
    forms: ClassVar[Tuple[Form, ...]] = tuple(form for kind in KINDS.values() for form in kind.forms)
    used: ClassVar[Mapping[str, str]] = {w: kind for each in KINDS.values() for w, kind in each.used.items()}
    conditions_behind: ClassVar[Tuple[str, ...]] = tuple(w for kind in KINDS.values() for w in kind.conditions_behind)

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Union[Safety, Tuple[Safety, ...]]:
        (tree,) = children
        return KINDS[tree.data].read(reader, *tree.children, **at)
