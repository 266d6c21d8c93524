"""`reach_objective: do e`: what is reached once."""

from __future__ import annotations

from typing import Any, ClassVar, Mapping, Tuple

from pursue_gen.language.objectives import Reach
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


class ReachObjective(StatementKind):
    """What is reached once."""

    words: ClassVar[Tuple[Word, ...]] = (
        Word("reach_objective", "What is to be achieved once."),
        Word("do", "The event that is wanted."),
        Word("after", "Later than so many units of time after the start."),
    )
    grammar: ClassVar[str] = """reach: "reach_objective" ":" "do" things ["after" NUMBER] ["within" NUMBER]
things: ref ("and" ref)*"""
    form: ClassVar[str] = "reach_objective: do e1 and e2 after 10 within 60 (or: do e1; after and within are optional)"
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("achieve something once", "reach_objective: do {event}"),
        Form("achieve several things in time", "reach_objective: do {event} and {event} within {=60}"),
    )
    used: ClassVar[Mapping[str, str]] = {"do": "event", "and": "event"}
    among: ClassVar[str] = "OBJECTIVE"

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Reach:
        events, after, within = children
        numbers = reader.number_or_none(after) or 0, at["span"], reader.number_or_none(within)
        return Reach(reader.refs(events), *numbers)
