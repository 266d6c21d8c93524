"""`travel agent from a to b takes 5 to 8`: an agent's own time for a way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Mapping, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.numbers import Number, Window, window_of
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind, window_text
from pursue_gen.language.tree_reader import TreeReader
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

    listed_in: ClassVar[str] = "travels"
    words: ClassVar[Tuple[Word, ...]] = (
        Word(
            "travel",
            "How long an agent takes from a place to the next one, in place of what distance and mobile say.",
            True,
        ),
        Word("from", "Where the agent sets off."),
        Word(
            "takes",
            "How long it takes: more than the first number, and at most the second one (or one unit more).",
            True,
        ),
    )
    grammar: ClassVar[str] = 'travel: TRAVEL (ref | NAME) "from" ref TO ref TAKES window'
    form: ClassVar[str] = "travel bot from a to b takes 5 to 8"
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("an agent's own time for a way", "travel {agent} from {POI} to {POI} takes {=5} to {=8}"),
    )
    refers_to: ClassVar[Mapping[str, str]] = {"agent": "agent", "a": "POI", "b": "POI"}
    used: ClassVar[Mapping[str, str]] = {"travel": "agent", "from": "POI", "to": "POI"}
    second: ClassVar[str] = "from"

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Travel:
        _, agent, a, _to, b, _takes, takes = children
        return cls(reader.agent_ref(agent), reader.ref(a), reader.ref(b), *reader.window(takes), at["span"])

    @property
    def way(self) -> Tuple[str, str]:
        """From where to where."""
        return self.a.name, self.b.name

    @property
    def window(self) -> Window:
        """Between which times the agent arrives."""
        return window_of(self.earliest, self.latest)

    @property
    def text(self) -> str:
        takes = window_text(self.earliest, self.latest)
        return f'travel "{self.agent.name}" from {self.a.name} to {self.b.name} takes {takes}'
