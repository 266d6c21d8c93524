"""`optional 1 objective: …`: an objective that is given up where it cannot be promised with the rest."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.language.objectives import StatedObjective
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.statements.headed import Objective, ReachObjective
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

_BEHIND = {kind.rule(): kind for kind in (Objective, ReachObjective)}
"""What stands behind the number, by its rule in the grammar."""


def _objectives(reader: TreeReader, tree: Any) -> Tuple[StatedObjective, ...]:
    found: Any = _BEHIND[tree.data].read(reader, *tree.children, span=reader.span(tree))
    return found if isinstance(found, tuple) else (found,)


class Optional(StatementKind):
    """An objective with a number: 1 for what is to be kept longest."""

    own_words = (
        Word(
            "optional",
            "An objective that is given up where it cannot be promised with the rest; 1 is kept longest.",
            True,
        ),
    )
    template = Template(
        "optional {rank:count=1} {objectives:objectives=reach_objective: do e1}",
        objectives=Filling(f"({' | '.join(_BEHIND)})", _objectives),
    )
    note = "or: optional 1 objective: avoid e; 1 is kept longest"
    forms = (
        Form("achieve something if it can be promised", "optional {=1} reach_objective: do {event}"),
        Form("what always holds if it can be promised", "optional {=1} objective: avoid {event}"),
    )
    numbers = {
        "optional": lambda *_: (
            "The first one to be given up is the one with the greatest number; those with one number go together."
        ),
    }
    among = "OBJECTIVE"

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Tuple[StatedObjective, ...]:
        rank, objectives = cls.template.read(reader, children).values()
        if not rank:
            hint = "1 is kept longest, then 2, and so on; without optional it has to be met in any case"
            message = "the number behind optional is 0; expected 1 or more"
            reader.findings.append(error("PML300", message, reader.at(children[0]), hint))
        return tuple(replace(objective, optional=rank or 1, **at) for objective in objectives)
