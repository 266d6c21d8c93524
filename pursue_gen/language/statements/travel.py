"""`travel agent from a to b takes 5 to 8`: an agent's own time for a way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.numbers import Number, Window, window_of
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind, check_window
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Travel(StatementKind):
    """How long an agent takes from `a` to `b`, in place of what distance and speed say: more than `earliest` time units
    and at most `latest`; None: one more than that.
    """

    agent: Ref
    a: Ref
    b: Ref
    earliest: Number
    latest: Optional[Number] = None
    span: Span = NOWHERE

    listed_in = "travels"
    own_words = (
        Word(
            "travel",
            "How long an agent takes from a place to the next one, in place of what distance and mobile say.",
            True,
        ),
        Word("from", "Where the agent sets off."),
    )
    template = Template('travel {agent:"agent"=bot} from {a:POI=a} to {b:POI=b} takes {earliest,latest:window=5 to 8}')
    forms = (Form("an agent's own time for a way", template.to_fill_in),)
    second = ("from",)

    @property
    def way(self) -> Tuple[str, str]:
        """From where to where."""
        return self.a.name, self.b.name

    @property
    def window(self) -> Window:
        """Between which times the agent arrives."""
        return window_of(self.earliest, self.latest)

    @property
    def movement(self) -> str:
        """Who goes where, in words."""
        return f"the way of {self.agent.name} from {self.a.name} to {self.b.name}"

    def check(self) -> Iterator[Diagnostic]:
        if self.latest is not None:
            yield from check_window(self.movement, self.earliest, self.latest, "takes", self.span)
        elif self.earliest <= 0:
            hint = "write a number above 0, or takes 0 to 1"
            yield error("PML200", f"{self.movement} takes no time", self.span, hint)
