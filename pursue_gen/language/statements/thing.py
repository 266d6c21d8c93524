"""`thing "box"`: something that agents carry, from an event that takes it to one that gives it, or a tool."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.statements.base import Labelled
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Thing(Labelled):
    """Something that is carried, or a tool: which one of its kind is not told apart. `label`: what people read; None:
    the name.
    """

    name: str
    span: Span = NOWHERE
    label: Optional[str] = None

    listed_in: ClassVar[str] = "things"
    symbol: ClassVar[str] = "Object"
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("thing", "What agents carry, from an event that takes it to one that gives it; or a tool.", True),
    )
    template: ClassVar[Template] = Template('thing {name="box"} [label {label:name}]')
    forms: ClassVar[Tuple[Form, ...]] = (Form("something that robots carry", 'thing "{=box}"'),)
    declares: ClassVar[str] = "thing"
    described: ClassVar[str] = "a thing that is carried"
    shortest: ClassVar[str] = 'thing "{name}"'
