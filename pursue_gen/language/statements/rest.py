"""`rest 0.1`: how long agents rest between two steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.numbers import Number
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Rest(StatementKind):
    """Every agent rests so many time units at a place between two steps, in place of one."""

    time: Number
    span: Span = NOWHERE

    listed_in = "rests"
    own_words = (
        Word("rest", "How long every agent rests between two steps at a place, in place of one unit of time.", True),
    )
    template = Template("rest {time:time=0.1}")
    forms = (Form("how long everybody rests between two steps", "rest {=0.1}"),)
    numbers = {"rest": "It sets off, or does something, {} after its last step, or later.".format}

    def check(self) -> Iterator[Diagnostic]:
        if self.time <= 0:
            message = "rest 0: agents could do endlessly many things at once; expected more than 0"
            yield error("PML425", message, self.span, "write a short time, such as rest 0.1, or delete this line")
