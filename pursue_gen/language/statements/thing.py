"""`thing "box"`: something that agents carry, from an event that takes it to one that gives it, or a tool."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

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

    listed_in = "things"
    symbol = "Object"
    own_words = (
        Word("thing", "What agents carry, from an event that takes it to one that gives it; or a tool.", True),
    )
    template = Template('thing {name="box"} [label {label:name}]')
    forms = (Form("something that robots carry", 'thing "{=box}"'),)
    declares = "thing"
    described = "a thing that is carried"
    shortest = 'thing "{name}"'
