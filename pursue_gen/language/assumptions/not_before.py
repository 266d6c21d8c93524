"""`assume: agent does event after T`."""

from __future__ import annotations

from dataclasses import dataclass

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.assumptions.base import NotSooner
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form


@dataclass(frozen=True)
class NotBefore(NotSooner):
    """`assume: agent does event after time`: it begins the event later than so many time units after the start."""

    agent: Ref
    event: Ref
    time: Number
    span: Span = NOWHERE
    template = Template("{agent=guest} does {event=call} after {time:time=60}")
    forms = (Form("from when on somebody does something", template.to_fill_in),)
    numbers = {"after": "It begins that later than {} after the start.".format}
    says = "{agent} does {event} only later than {time} after the start"
    counts_since = "the start"

    def allows(self, event: str, within: Number) -> bool:
        return True
