"""`mission ends after 480 when all is answered`: when a mission ends in which nothing is to be reached."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Optional

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units
from pursue_gen.language.numbers import Number
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class MissionEnd(StatementKind):
    """When a mission ends: `after` so many time units (None: at any time), as soon as all is answered that is due then;
    or, with `answered`, when no answer is due at all.

    It is no part of the game: what is promised is promised for ever, and so up to any end.
    """

    after: Optional[Number] = None
    answered: bool = False
    span: Span = NOWHERE

    listed_in = "ends"
    own_words = (
        Word("mission", "The mission from its start to its end.", True),
        Word("ends", "When a mission ends in which nothing is to be reached: all was kept, and robots stay.", True),
        Word("when", "At such a moment, and not before.", True),
        Word("is", "As in all is answered: nothing that has to be answered waits for it.", True),
        Word("answered", "Nothing that has to be answered waits for it.", True),
    )
    template = Template("mission ends [after {after:time=480}] [when all is answered]")
    note = "or: mission ends when all is answered, or both"
    numbers = {"after": "The mission ends {} of time after the start, as soon as what is due then is answered.".format}
    forms = (
        Form("a mission that ends after a time", "mission ends after {=480}"),
        Form("a mission that ends when all is answered", "mission ends when all is answered"),
    )
    among = "OBJECTIVE"

    @property
    def sentence(self) -> str:
        """When it ends."""
        after = "" if self.after is None else f"{units(self.after)} after the start"
        if not self.answered:
            return f"The mission ends {after}, as soon as what is due then is answered."
        if not after:
            return "The mission ends when an answer has come and no other is due."
        return f"The mission ends {after}, or later, when no answer is due."

    def check(self) -> Iterator[Diagnostic]:
        if self.after is None and not self.answered:
            message = "the mission ends, but it is not said when: expected after or when"
            yield error(
                "PML331", message, self.span, "write mission ends after 480, or mission ends when all is answered"
            )
        if self.after is not None and self.after <= 0:
            message = "the mission ends after 0: expected more than 0"
            yield error("PML331", message, self.span, "write how many time units it goes on")
