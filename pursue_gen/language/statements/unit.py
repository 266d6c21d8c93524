"""`unit second`: what one unit of time is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.numbers import Number
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.times import SECONDS, TIMES, has_unit
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

_NAMED = {"second": SECONDS["s"], "minute": SECONDS["min"], "hour": SECONDS["h"]}
_LEAST, _MOST = 0.001, 86_400  # seconds


def seconds_in(text: str) -> Optional[Number]:
    """The seconds of `second`, `minute`, `hour` or a time with its unit; None: it is none of these."""
    return _NAMED.get(text) or (TIMES.read(text).value if has_unit(text) else None)


def _read(reader: TreeReader, token: Token) -> Tuple[Number, str]:
    text = " ".join(token.split())
    if token.type == "NUMBER" and not has_unit(token):
        message = f"expected second, minute, hour or a time with its unit behind unit, found {text}"
        reader.findings.append(error("PML014", message, reader.at(token), f"write unit {text} s if it is in seconds"))
        return 1, text
    seconds = _NAMED.get(text) or reader.seconds(token)
    return (1 if seconds is None else seconds), text


@dataclass(frozen=True)
class Unit(StatementKind):
    """What one unit of time is: so many `seconds`. `written`: how that is said."""

    seconds: Number
    written: str
    span: Span = NOWHERE

    listed_in = "units"
    own_words = (
        Word("unit", "What one unit of time is; with it, times may have units: 30 s, 2 min, 8 h.", True),
        Word("second", "One unit of time is one second.", True),
        Word("minute", "One unit of time is one minute.", True),
        Word("hour", "One unit of time is one hour.", True),
    )
    template = Template(
        "unit {seconds,written:length=second}",
        length=Filling("(SECOND | MINUTE | HOUR | NUMBER)", _read, lambda _, written: str(written)),
    )
    note = "or: unit minute, unit hour, unit 10 s"
    forms = (
        Form("what one unit of time is", "unit second"),
        Form("what one unit of time is, by its length", "unit {=10} s"),
    )

    def check(self) -> Iterator[Diagnostic]:
        if not _LEAST <= self.seconds <= _MOST:
            message = f"a unit of time of {self.written}: expected {_LEAST:g} s to 24 h"
            yield error("PML421", message, self.span, "write unit second, and times as 2 min or 8 h where they stand")
