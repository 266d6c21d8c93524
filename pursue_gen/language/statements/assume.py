"""`assume: …`: what agents that are not controlled do, or do not do; its kinds are in `language.assumptions`."""

from __future__ import annotations

from typing import Any, ClassVar, Mapping, Tuple, cast

from pursue_gen.language.assumptions import KINDS, Assumption
from pursue_gen.language.assumptions.base import NAMES
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

_FIELDS = tuple(found for kind in KINDS.values() for found in kind.fields())
"""The fields of all kinds, each behind the last word before it."""


class Assume(StatementKind):
    """What is assumed."""

    listed_in: ClassVar[str] = "assumptions"
    words: ClassVar[Tuple[Word, ...]] = (
        Word("assume", "What an agent that is not controlled is assumed to do, or not to do. A mission watches it."),
        *(Word(word, meaning, True) for kind in KINDS.values() for word, meaning in kind.meanings.items()),
    )
    grammar: ClassVar[str] = "\n".join(
        (
            f'assumption: "assume" ":" ({" | ".join(KINDS)})',
            *(f"{name}: {kind.rule()}" for name, kind in KINDS.items()),
        )
    )
    form: ClassVar[str] = " · ".join(kind.filled(kind.example.__getitem__) for kind in KINDS.values())
    forms: ClassVar[Tuple[Form, ...]] = tuple(Form(kind.title, kind.form()) for kind in KINDS.values())
    used: ClassVar[Mapping[str, str]] = {word: NAMES[field] for word, field in _FIELDS if field in NAMES}
    conditions_behind: ClassVar[Tuple[str, ...]] = tuple(word for word, field in _FIELDS if field == "condition")

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Assumption:
        (tree,) = children
        kind: Any = KINDS[tree.data]
        fields = zip((field for _, field in kind.fields()), tree.children)
        return cast(Assumption, kind(**{field: _value(reader, field, child) for field, child in fields}, **at))


def _value(reader: TreeReader, field: str, tree: Any) -> Any:
    if field == "condition":
        return reader.condition(tree)
    return reader.ref(tree) if field in NAMES else reader.count(tree) if field == "times" else reader.number(tree)
