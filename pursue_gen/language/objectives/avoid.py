"""`avoid event`, `avoid condition` and `always condition`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.conditions import Condition, Not, condition_text, condition_words, held_by
from pursue_gen.language.objectives.base import Breaks, Safety
from pursue_gen.language.refs import Ref
from pursue_gen.language.template import Template
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Avoid(Safety):
    """`avoid event`: it never happens."""

    event: Ref
    span: Span = NOWHERE
    optional: int = 0

    template = Template("avoid {event:event or condition=e}")
    note = "or a condition: avoid open is_true"
    own_words = (Word("avoid", "This event must never happen, or this condition must never hold."),)
    forms = (
        Form("never", "avoid {event}"),
        Form("never while …", "avoid {agent} at {POI} and {agent} on_way"),
    )
    wants = "{event} never happens."

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Safety:
        (what,) = cls.template.read(reader, children).values()
        return cls(what, **at) if isinstance(what, Ref) else Always(what, False, **at)

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"{self.event.shown} has happened, which was to be avoided"

    @property
    def breaks(self) -> Breaks:
        return Breaks(event=self.event)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("event", self.event.name):
            yield "must never happen"


@dataclass(frozen=True)
class Always(Safety):
    """`always condition`, or with `holds` False `avoid condition`: it holds at every moment, or at none."""

    condition: Condition
    holds: bool = True
    span: Span = NOWHERE
    optional: int = 0

    template = Template("always {condition=open is_true}")
    own_words = (Word("always", "This condition must hold at every moment.", True),)
    forms = (Form("what always holds", "always any robot at {POI}"),)

    @property
    def text(self) -> str:
        return f"{'always' if self.holds else 'avoid'} {condition_text(self.condition)}"

    def sentence(self, shown: Callable[[str], str]) -> str:
        return f"It {'always' if self.holds else 'never'} holds that {condition_words(self.condition)}."

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"{condition_words(self.broken_if)}, which must never be"

    @property
    def breaks(self) -> Breaks:
        return Breaks(condition=self.broken_if)

    @property
    def broken_if(self) -> Condition:
        """The condition with which it is lost."""
        return Not(self.condition) if self.holds else self.condition

    def kept_by(self, robot: Ref) -> Always:
        return replace(self, condition=held_by(self.condition, robot)) if self.holds else self
